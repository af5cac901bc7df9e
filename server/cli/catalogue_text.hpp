/// The catalogue for people: Markdown tables, and an experiment on a screen.
#pragma once

#include <string>

#include "engine/experiment.hpp"

namespace repose::server {

std::string catalogue_markdown();

/// What an experiment does, reads and can be set to, with its drawing.
std::string explanation(const engine::ExperimentInfo& info);

}  // namespace repose::server
