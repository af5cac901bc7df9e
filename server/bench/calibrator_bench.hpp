/// CalibratorBench: how many evaluations the calibrator needs on studies whose truth is known,
/// beside the baselines. Analytic, so the figures are the same on every machine.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "calibrator/calibration.hpp"

namespace repose::server {

struct BenchMethod {
  std::string_view name;
  std::optional<int> median;  ///< evaluations to solve; nothing where it was not reached
  std::optional<int> p90;     ///< likewise, of nine seeds in ten
  double share_within_40 = 0.0;
};

struct BenchCase {
  std::string_view name;
  std::vector<BenchMethod> methods;
};

/// One case, an index into calibrator::bench::case_names, over seeds 1 to `seeds`.
BenchCase bench_case(std::size_t index, std::span<const calibrator::Method> methods, int seeds);

}  // namespace repose::server
