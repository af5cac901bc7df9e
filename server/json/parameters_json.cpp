#include "server/json/parameters_json.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "engine/catalogue.hpp"
#include "server/json/codec.hpp"
#include "server/json/key_json.hpp"
#include "server/json/read_key.hpp"

namespace repose::server {

using calibrator::Calibration;
using calibrator::FreeParameter;
using engine::Unit;

Unit unit_of(const Calibration& calibration, const engine::ParameterKey& key) {
  const auto free = std::ranges::find(calibration.free, key, &FreeParameter::key);
  if (free != calibration.free.end()) return free->unit;
  const engine::ParameterInfo* info = engine::find_parameter(key.field);
  return info != nullptr ? info->field->unit : Unit{};
}

Json print_values(const Calibration& calibration, const std::vector<double>& values) {
  Json result = Json::array();
  for (std::size_t i = 0; i < values.size(); ++i) {
    result.push_back(in_unit(values[i], calibration.measurements.at(i).unit));
  }
  return result;
}

Json print_parameter_set(const Calibration& calibration, const engine::ParameterSet& set) {
  Json result = Json::array();
  for (const auto& [key, value] : set) {
    const Unit unit = unit_of(calibration, key);
    Json entry = print_key(key);
    entry["value"] = in_unit(value, unit);
    entry["unit"] = unit.symbol;
    result.push_back(std::move(entry));
  }
  return result;
}

engine::ParameterSet read_parameter_set(const Json& json) {
  engine::ParameterSet set;
  for (const Json& entry : json) {
    ProblemList problems;
    Members members(Place(&entry, "", problems));
    const auto named = read_key(members);
    const auto unit = engine::unit::find(entry.at("unit").get<std::string>());
    if (!named || !unit) throw std::invalid_argument("an unknown parameter or unit");
    set.set(named->key, number_or_nan(entry.at("value")) * unit->factor);
  }
  return set;
}

}  // namespace repose::server
