#include "server/json/effect_bench_json.hpp"

#include <algorithm>
#include <utility>

#include "engine/evaluate.hpp"
#include "server/json/codec.hpp"
#include "server/json/key_json.hpp"
#include "server/json/read_key.hpp"

/// Made by the build from server/bench/*.json.
extern const std::span<const std::pair<std::string_view, std::string_view>> embedded_benches;

namespace repose::server {

namespace {

EffectChange read_change(const Json& json) {
  const auto unit = engine::unit::find(json.at("unit").get<std::string>()).value();
  return {json.at("experiment").get<std::string>(),
          json.at("observable").get<std::string>(),
          unit,
          number_or_nan(json.at("without")) * unit.factor,
          number_or_nan(json.at("with")) * unit.factor,
          number_or_nan(json.at("standard_error")) * unit.factor,
          json.at("failure").get<std::string>()};
}

EffectBench read_effect(const Json& json) {
  EffectBench bench;
  bench.effect = json.at("effect").get<std::string>();
  for (const Json& entry : json.at("parameters")) {
    ProblemList problems;
    Members members(Place(&entry, "", problems));
    const auto named = read_key(members);
    const auto unit = engine::unit::find(entry.at("unit").get<std::string>());
    if (!named || !unit) continue;
    bench.parameters.emplace_back(named->key, number_or_nan(entry.at("value")) * unit->factor);
  }
  for (const Json& change : json.at("changes")) bench.changes.push_back(read_change(change));
  return bench;
}

MeasuredEffects read_measured() {
  const Json json = Json::parse(embedded_benches.front().second);
  MeasuredEffects measured{json.at("command").get<std::string>(),
                           json.at("engine_version").get<std::string>(),
                           json.at("seeds").get<int>(),
                           {}};
  for (const Json& effect : json.at("effects")) measured.effects.push_back(read_effect(effect));
  return measured;
}

Json print_parameters(const EffectBench& effect) {
  Json result = Json::array();
  for (const auto& [key, value] : effect.parameters) {
    const engine::Unit unit = engine::find_parameter(key.field)->field->unit;
    Json entry = print_key(key);
    entry["value"] = in_unit(value, unit);
    entry["unit"] = unit.symbol;
    result.push_back(std::move(entry));
  }
  return result;
}

}  // namespace

Json print_changes(const EffectBench& effect) {
  Json result = Json::array();
  for (const EffectChange& change : effect.changes) {
    result.push_back({{"experiment", change.experiment},
                      {"observable", change.observable},
                      {"unit", change.unit.symbol},
                      {"without", in_unit(change.without, change.unit)},
                      {"with", in_unit(change.with, change.unit)},
                      {"standard_error", in_unit(change.standard_error, change.unit)},
                      {"failure", change.failure}});
  }
  return result;
}

std::string print_effect_bench(std::span<const EffectBench> effects, int seeds) {
  Json list = Json::array();
  for (const EffectBench& effect : effects) {
    list.push_back({{"effect", effect.effect},
                    {"parameters", print_parameters(effect)},
                    {"changes", print_changes(effect)}});
  }
  return to_text(
      Json{{"command", "repose bench effects --seeds " + std::to_string(seeds) + " --json"},
           {"engine_version", engine::version()},
           {"fidelity", "draft"},
           {"seeds", seeds},
           {"effects", std::move(list)}},
      1);
}

const MeasuredEffects& measured_effects() {
  static const MeasuredEffects measured = read_measured();
  return measured;
}

const EffectBench* measured_effect(std::string_view name) {
  const auto& effects = measured_effects().effects;
  const auto found = std::ranges::find(effects, name, &EffectBench::effect);
  return found == effects.end() ? nullptr : &*found;
}

}  // namespace repose::server
