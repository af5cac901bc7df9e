#include <algorithm>
#include <cmath>
#include <utility>

#include "calibrator/baselines/baseline.hpp"
#include "calibrator/design.hpp"
#include "calibrator/optimiser.hpp"

namespace repose::calibrator {
namespace {

constexpr std::size_t further_starts = 32;

Algorithm algorithm_of(Method method) {
  switch (method) {
    case Method::cobyla:
      return Algorithm::cobyla;
    case Method::sbplx:
      return Algorithm::sbplx;
    case Method::crs2:
      return Algorithm::crs2;
    case Method::isres:
      return Algorithm::isres;
    case Method::direct_l:
      return Algorithm::direct_l;
    case Method::mlsl:
      return Algorithm::mlsl;
    default:
      return Algorithm::bobyqa;
  }
}

}  // namespace

/// Minimises the misfit of single runs: one call of NLopt's, one evaluation. A run that failed
/// counts as twice the worst misfit seen, which a quadratic model survives. From the centre, and
/// from another start whenever the algorithm has converged.
bool search_by_nlopt(BaselineSearch& search, Method method) {
  double worst = 1.0;
  const Objective objective = [&](std::span<const double> at) {
    if (search.left() == 0) return 2.0 * worst;
    const std::vector<UnitPoint> point{{at.begin(), at.end()}};
    const double found = search.evaluate(point).front();
    search.recommend(search.best_seen());
    if (!std::isfinite(found)) return 2.0 * worst;
    worst = std::max(worst, found);
    return found;
  };
  const std::vector<UnitPoint> starts =
      latin_hypercube(further_starts, search.dimensions(), search.seed());
  UnitPoint start(search.dimensions(), 0.5);
  for (std::size_t next = 0; search.left() > 0; start = starts[next++ % further_starts]) {
    minimise_by(algorithm_of(method),
                objective,
                unit_box(search.dimensions()),
                start,
                {.evaluations = search.left(), .seed = search.seed(), .done = [&] {
                   return search.left() == 0;
                 }});
  }
  return false;
}

}  // namespace repose::calibrator
