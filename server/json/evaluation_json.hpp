/// Trials and evaluations as documents: on the wire, in the database, and between the service and
/// its workers.
#pragma once

#include <string>
#include <string_view>

#include "engine/experiment.hpp"
#include "engine/result.hpp"
#include "server/json/problem.hpp"

namespace repose::server {

/// The canonical question: one line, settings resolved, SI values printed so that they read back
/// exactly.
std::string print_trial(const engine::Trial& trial);
engine::Result<engine::Trial, Problems> parse_trial(std::string_view text);

/// SHA-256 (hexadecimal) of the engine's version and the canonical question: the evaluation's name
/// in the store.
std::string evaluation_key(const engine::Trial& trial);

/// The answer: outcome and effort, without the question.
std::string print_answer(const engine::Evaluation& evaluation);

/// Puts an answer beside its question. A text that is no answer is an evaluation that failed
/// (FailureKind::crashed).
engine::Evaluation parse_answer(const engine::Trial& trial, std::string_view text);

}  // namespace repose::server
