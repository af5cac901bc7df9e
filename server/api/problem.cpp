#include "server/api/problem.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "server/json/problem_json.hpp"
#include "server/service.hpp"

namespace repose::server {

namespace {

struct ProblemType {
  int status;
  std::string_view type;
  std::string_view title;
};

constexpr std::array<ProblemType, 20> problem_types{{
    {400, "urn:repose:problem:bad-request", "The request is malformed"},
    {401, "urn:repose:problem:who", "The request does not say who asks"},
    {403, "urn:repose:problem:not-allowed", "The token does not allow this"},
    {404, "urn:repose:problem:not-found", "There is no such thing"},
    {405, "urn:repose:problem:method-not-allowed", "This cannot be done here"},
    {408, "urn:repose:problem:too-slow", "The request came too slowly"},
    {409, "urn:repose:problem:wrong-state", "This cannot be done now"},
    {411, "urn:repose:problem:length-required", "The length of the body is missing"},
    {412, "urn:repose:problem:changed", "It has changed since it was read"},
    {413, "urn:repose:problem:too-large", "The body is too large"},
    {414, "urn:repose:problem:address-too-long", "The address is too long"},
    {415, "urn:repose:problem:media-type", "The body has a form that is not read here"},
    {416, "urn:repose:problem:ranges", "These ranges are not served"},
    {417, "urn:repose:problem:expectation", "This expectation is not met"},
    {421, "urn:repose:problem:misdirected", "This server does not answer for that host"},
    {422, "urn:repose:problem:invalid", "The document has problems"},
    {428, "urn:repose:problem:unconditional", "A change names what it changes"},
    {431, "urn:repose:problem:headers", "There are too many headers"},
    {500, "urn:repose:problem:internal", "The service failed"},
    {503, "urn:repose:problem:unavailable", "The service cannot answer now"},
}};

int status_of(Refusal::Kind kind) {
  switch (kind) {
    case Refusal::Kind::invalid:
      return 422;
    case Refusal::Kind::not_found:
      return 404;
    case Refusal::Kind::wrong_state:
      return 409;
    case Refusal::Kind::unconditional:
      return 428;
  }
  return 500;
}

}  // namespace

Reply problem_reply(int status, std::string detail, Problems errors) {
  const auto known = std::ranges::find(problem_types, status, &ProblemType::status);
  const ProblemType other{status, "about:blank", "The request failed"};
  const ProblemType& type = known == problem_types.end() ? other : *known;
  Reply reply;
  reply.status = status;
  reply.content_type = "application/problem+json";
  reply.body = print_problem({type.type, type.title, status, std::move(detail), std::move(errors)});
  return reply;
}

Reply problem_reply(const Refusal& refusal) {
  return problem_reply(status_of(refusal.kind), refusal.message, refusal.problems);
}

}  // namespace repose::server
