/// What `repose bench calibrator` prints with --json.
#pragma once

#include <span>
#include <string>

#include "server/bench/calibrator_bench.hpp"

namespace repose::server {

/// One case is an object, several are a list of them. Null where too few seeds were solved.
std::string print_calibrator_bench(std::span<const BenchCase> cases);

}  // namespace repose::server
