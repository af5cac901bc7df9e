/// What goes between the service and whoever answers: a question and an answer with the number of
/// the attempt, so that no answer is taken for another's.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "engine/experiment.hpp"
#include "engine/result.hpp"
#include "server/json/problem.hpp"

namespace repose::server {

struct Question {
  std::string key;  ///< evaluation_key() of the trial
  std::int64_t attempt = 0;
  engine::Trial trial;
};

/// {"key","attempt","trial"}, one line.
std::string print_question(const Question& question);
/// The question, or all problems of the text.
engine::Result<Question, Problems> parse_question(std::string_view text);

struct AttemptAnswer {
  std::string key;
  std::int64_t attempt = 0;
  std::string engine_version;
  std::string answer;  ///< print_answer()'s
};

/// {"key","attempt","engine_version","answer"}, of this engine, one line.
std::string print_answer_to(const Question& question, const std::string& answer);
/// Nothing where the text is no such document.
std::optional<AttemptAnswer> parse_attempt_answer(std::string_view text);

}  // namespace repose::server
