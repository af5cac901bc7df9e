#include "server/bench/calibrator_bench.hpp"

#include <cstdint>
#include <utility>

#include "calibrator/bench/bench_run.hpp"

namespace repose::server {

namespace bench = calibrator::bench;

BenchCase bench_case(std::size_t index, std::span<const calibrator::Method> methods, int seeds) {
  BenchCase result{bench::case_names.at(index), {}};
  for (const calibrator::Method method : methods) {
    std::vector<bench::BenchRun> runs;
    for (int seed = 1; seed <= seeds; ++seed) {
      runs.push_back(
          bench::run(bench::study_of_case(index, method, static_cast<std::uint64_t>(seed))));
    }
    result.methods.push_back({calibrator::method_names.at(static_cast<std::size_t>(method)),
                              bench::quantile(runs, 0.5),
                              bench::quantile(runs, 0.9),
                              bench::share_solved(runs, 40)});
  }
  return result;
}

}  // namespace repose::server
