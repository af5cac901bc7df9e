#include "server/api/reply.hpp"

#include "server/api/problem.hpp"
#include "server/json/text.hpp"

namespace repose::server {

Reply reply_of(const Answer<std::string>& answer, int status) {
  if (!answer) return problem_reply(answer.error());
  return {.status = status, .body = *answer};
}

Reply reply_of(const Answer<Page>& answer) {
  if (!answer) return problem_reply(answer.error());
  return {.body = answer->document, .next = answer->next};
}

namespace {

Reply with_address(const Answer<std::string>& answer, int status, std::string_view collection) {
  Reply reply = reply_of(answer, status);
  if (!answer) return reply;
  if (const auto id = whole_member(*answer, "id")) {
    reply.headers.emplace_back("Location", std::string(collection) + "/" + std::to_string(*id));
  }
  return reply;
}

}  // namespace

Reply created(const Answer<std::string>& answer, std::string_view collection) {
  return with_address(answer, 201, collection);
}

Reply accepted(const Answer<std::string>& answer, std::string_view collection) {
  return with_address(answer, 202, collection);
}

}  // namespace repose::server
