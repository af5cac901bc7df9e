#include "server/json/problem_json.hpp"

#include <utility>

#include "server/json/text.hpp"

namespace repose::server {

std::string print_problem(const ProblemDocument& problem) {
  Json document{{"type", problem.type},
                {"title", problem.title},
                {"status", problem.status},
                {"detail", problem.detail}};
  Json errors = Json::array();
  for (const Problem& error : problem.errors) {
    errors.push_back({{"pointer", error.pointer},
                      {"message", error.message},
                      {"found", error.found},
                      {"allowed", error.allowed}});
  }
  if (!errors.empty()) document["errors"] = std::move(errors);
  return to_text(document);
}

}  // namespace repose::server
