/// Assignments of the command line, FIELD:grain-grain=VALUE and NAME=VALUE, checked against the
/// catalogue and converted to SI. Errors say what was wrong and what to write instead.
#pragma once

#include <string>
#include <string_view>

#include "engine/experiment.hpp"
#include "engine/result.hpp"

namespace repose::server {

struct ParameterAssignment {
  engine::ParameterKey key;
  double value;  ///< SI
};

struct SettingAssignment {
  std::string name;
  double value;  ///< SI
};

/// "sliding_friction.coefficient:grain-wall=0.3", "material.shear_modulus:grain=41.7MPa"
engine::Result<ParameterAssignment, std::string> parse_parameter(std::string_view text);

/// "speed=15 rpm", "source=stream"
engine::Result<SettingAssignment, std::string> parse_setting(const engine::ExperimentInfo& info,
                                                             std::string_view text);

}  // namespace repose::server
