/// evaluate(): the engine's front door.
#pragma once

#include <string>
#include <string_view>

#include "engine/experiment.hpp"

namespace repose::engine {

/// Names the build that produced a result: equal versions give equal bits for equal trials.
std::string_view version();

/// Why a trial cannot be run, seen without running it: an unknown or impossible value, an apparatus
/// that cannot work with such grains. Empty: it can.
std::string refusal(const Trial& trial);

/// Runs one virtual experiment. Pure: equal trials give equal bits (one build, one libm).
/// Never throws for physics: a run that explodes or never rests is an Outcome.
Evaluation evaluate(const Trial& trial, const Run& run = {});

}  // namespace repose::engine
