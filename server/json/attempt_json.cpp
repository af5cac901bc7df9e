#include "server/json/attempt_json.hpp"

#include <limits>
#include <utility>

#include "engine/evaluate.hpp"
#include "server/json/evaluation_json.hpp"
#include "server/json/place.hpp"
#include "server/json/text.hpp"

namespace repose::server {

std::string print_question(const Question& question) {
  return to_text(Json{{"key", question.key},
                      {"attempt", question.attempt},
                      {"trial", Json::parse(print_trial(question.trial))}});
}

engine::Result<Question, Problems> parse_question(std::string_view text) {
  ProblemList problems;
  const auto json = parse_text(text, {}, problems);
  if (!json) return engine::Unexpected{problems.all()};
  constexpr std::size_t longest_key = 200;
  Members members(Place(&*json, "", problems));
  const auto key = members.required("key", "the digest of the question").text(longest_key);
  const auto attempt = members.required("attempt", "the number of the attempt, from 0")
                           .whole(0, std::numeric_limits<std::int64_t>::max());
  const Place trial = members.required("trial", "a trial");
  members.no_others();
  if (!problems.empty()) return engine::Unexpected{problems.all()};
  auto parsed = parse_trial(to_text(trial.json()));
  if (!parsed) return engine::Unexpected{parsed.error()};
  return Question{*key, *attempt, *std::move(parsed)};
}

std::string print_answer_to(const Question& question, const std::string& answer) {
  return to_text(Json{{"key", question.key},
                      {"attempt", question.attempt},
                      {"engine_version", engine::version()},
                      {"answer", Json::parse(answer)}});
}

std::optional<AttemptAnswer> parse_attempt_answer(std::string_view text) {
  ProblemList problems;
  const auto json = parse_text(text, own_text(text), problems);
  if (!json || !problems.empty() || !json->is_object()) return std::nullopt;
  const auto member = [&](const char* name) {
    return json->contains(name) ? json->at(name) : Json();
  };
  const Json key = member("key"), attempt = member("attempt"), version = member("engine_version");
  const Json answer = member("answer");
  if (!key.is_string() || !attempt.is_number_integer() || !version.is_string()) return std::nullopt;
  return AttemptAnswer{key.get<std::string>(),
                       attempt.get<std::int64_t>(),
                       version.get<std::string>(),
                       to_text(answer)};
}

}  // namespace repose::server
