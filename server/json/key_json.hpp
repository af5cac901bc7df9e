/// Parameter keys and experiment settings as JSON: the parts that every document shares.
#pragma once

#include "engine/experiment.hpp"
#include "server/json/text.hpp"

namespace repose::server {

/// {"field", "between"}; without "between" where the parameter belongs to no material.
Json print_key(const engine::ParameterKey& key);

/// The settings that an experiment gives: {"height": {"value", "unit"}, "source": "stream"}.
Json print_settings(const engine::Experiment& experiment);

}  // namespace repose::server
