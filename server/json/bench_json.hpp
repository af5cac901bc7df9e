/// What `repose bench` prints with --json.
#pragma once

#include <span>
#include <string>

#include "server/bench/engine_bench.hpp"

namespace repose::server {

std::string print_bench(std::span<const BenchScene> scenes);

}  // namespace repose::server
