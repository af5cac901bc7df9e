/// What `repose bench effects` prints with --json, and what the catalogue quotes of it.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/bench/effect_bench.hpp"
#include "server/json/text.hpp"

namespace repose::server {

/// {"command","engine_version","fidelity","seeds","effects":[{"effect","parameters","changes"}]}
std::string print_effect_bench(std::span<const EffectBench> effects, int seeds);

/// [{"experiment","observable","unit","without","with","standard_error","failure"}]
Json print_changes(const EffectBench& effect);

/// The runs that the program carries: server/bench/effects.json.
struct MeasuredEffects {
  std::string command;  ///< that made them
  std::string engine_version;
  int seeds = 0;
  std::vector<EffectBench> effects;
};
const MeasuredEffects& measured_effects();

/// Nothing where it was not measured.
const EffectBench* measured_effect(std::string_view name);

}  // namespace repose::server
