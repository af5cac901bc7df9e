/// EngineBench: how fast the engine is on scenes that other codes can run too, made of the
/// reference grain. A measurement, not a test: machines are shared.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/parameter_set.hpp"

namespace repose::server {

struct BenchOptions {
  int rounds = 3;
  unsigned threads = 1;       ///< that share a run; beyond one, times are wall times
  std::filesystem::path bed;  ///< file; empty: the static scene's grains are not written
};

struct BenchScene {
  std::string scene;
  std::uint64_t grains = 0;                ///< at the end
  double particle_steps_per_second = 0.0;  ///< the median of the rounds
  double slowest = 0.0, fastest = 0.0;     ///< the rounds' extremes, 1/s
  double contacts_per_grain = 0.0;         ///< closed at the end, walls included
  double steps_per_rebuild = 0.0;          ///< of the neighbour list
  double bytes_per_grain = 0.0;
  double wall_seconds = 0.0;  ///< of all rounds
};

/// A settled bed, about eleven grains deep, between periodic sides: `grains` is at most 5,000, or a
/// multiple of it, for which the bed of 5,000 is laid side by side. Settling is not timed. The
/// bed's file has its periods along x and y and 0 in the first line, then each grain's centre, m.
BenchScene bench_static(const engine::ParameterSet& grain,
                        std::uint64_t grains,
                        const BenchOptions& options);

/// A whole virtual experiment at draft fidelity.
BenchScene bench_experiment(std::string_view experiment,
                            const engine::ParameterSet& grain,
                            const BenchOptions& options);

}  // namespace repose::server
