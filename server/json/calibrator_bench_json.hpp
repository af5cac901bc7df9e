/// What `repose bench calibrator` prints with --json.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "calibrator/bench/honesty.hpp"
#include "server/bench/calibrator_bench.hpp"

namespace repose::server {

/// One case is an object, several are a list of them. Null where too few seeds were solved.
std::string print_calibrator_bench(std::span<const BenchCase> cases);

struct HonestyOfCase {
  std::string_view name;
  calibrator::bench::Honesty honesty;
};
std::string print_honesty(std::span<const HonestyOfCase> cases);

struct WarmStartOfCase {
  std::string_view name;
  int stored = 0;
  std::optional<int> median;  ///< new evaluations until solved; nothing where it was not reached
  std::optional<int> p90;
};
std::string print_warm_start(std::span<const WarmStartOfCase> cases);

}  // namespace repose::server
