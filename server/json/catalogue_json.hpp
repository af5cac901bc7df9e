/// The catalogue -> document: what there is, in the units that people use.
#pragma once

#include <string>

namespace repose::server {

/// Effects, experiments, material properties and units, with bounds, nulls, defaults and citations.
std::string print_catalogue();

}  // namespace repose::server
