#include "calibrator/optimiser.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include <utility>

#include <nlopt.h>

namespace repose::calibrator {
namespace {

constexpr double very_large = 1e30;  // in place of NaN and infinity, which upset quadratic models

/// What the callback sees: the function, and the best it has met so far.
struct Watch {
  const Objective& objective;
  const Box& box;
  nlopt_opt handle = nullptr;
  Minimum best;
  std::vector<double> clipped;
  std::exception_ptr thrown;
};

std::vector<double> clip(std::vector<double> point, const Box& box) {
  for (std::size_t k = 0; k < point.size(); ++k) {
    point[k] = std::clamp(point[k], box.lower[k], box.upper[k]);
  }
  return point;
}

/// NLopt may step out of the box by a rounding error, so the point is clipped before it is used.
double watch_value(unsigned n, const double* x, double* /*gradient*/, void* data) noexcept {
  Watch& watch = *static_cast<Watch*>(data);
  try {
    watch.clipped.assign(x, x + n);
    watch.clipped = clip(std::move(watch.clipped), watch.box);
    const double value = watch.objective(watch.clipped);
    if (value < watch.best.value || watch.best.at.empty()) {
      watch.best = {watch.clipped, value};
    }
    return std::isfinite(value) ? std::min(value, very_large) : very_large;
  } catch (...) {
    watch.thrown = std::current_exception();
    nlopt_force_stop(watch.handle);
    return very_large;
  }
}

/// One run of one algorithm. Its return code is of no interest: whether it converged, ran out of
/// evaluations or hit its rounding limit, the best point seen is the answer.
Minimum run(nlopt_algorithm algorithm,
            const Objective& objective,
            const Box& box,
            std::vector<double> start,
            int evaluations,
            double step,
            double tolerance) {
  const std::size_t n = start.size();
  const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> handle(
      nlopt_create(algorithm, static_cast<unsigned>(n)), &nlopt_destroy);
  Watch watch{objective, box, handle.get(), {{}, std::numeric_limits<double>::infinity()}, {}, {}};
  nlopt_srand(1);  // the state is the thread's own: without this, equal searches differ
  nlopt_set_lower_bounds(handle.get(), box.lower.data());
  nlopt_set_upper_bounds(handle.get(), box.upper.data());
  nlopt_set_min_objective(handle.get(), &watch_value, &watch);
  nlopt_set_maxeval(handle.get(), evaluations);
  if (tolerance > 0.0) nlopt_set_xtol_abs1(handle.get(), tolerance);
  if (step > 0.0) nlopt_set_initial_step1(handle.get(), step);
  double value = 0.0;
  nlopt_optimize(handle.get(), start.data(), &value);
  if (watch.thrown) std::rethrow_exception(watch.thrown);
  if (watch.best.at.empty()) {
    watch.best.at = clip(std::move(start), box);
    watch.best.value = objective(watch.best.at);
  }
  return watch.best;
}

}  // namespace

Box unit_box(std::size_t dimensions) {
  return {std::vector<double>(dimensions, 0.0), std::vector<double>(dimensions, 1.0)};
}

Minimum minimise_locally(const Objective& objective,
                         const Box& box,
                         std::vector<double> start,
                         const LocalSearch& options) {
  assert(start.size() == box.lower.size());
  start = clip(std::move(start), box);
  if (start.empty()) return {start, objective(start)};
  const nlopt_algorithm algorithm = start.size() == 1 ? NLOPT_LN_SBPLX : NLOPT_LN_BOBYQA;
  return run(algorithm,
             objective,
             box,
             std::move(start),
             options.evaluations,
             options.step,
             options.tolerance);
}

Minimum minimise_globally(const Objective& objective, const Box& box, int evaluations) {
  std::vector<double> centre(box.lower.size());
  for (std::size_t k = 0; k < centre.size(); ++k) centre[k] = 0.5 * (box.lower[k] + box.upper[k]);
  if (centre.empty()) return {centre, objective(centre)};
  return run(NLOPT_GN_DIRECT_L, objective, box, std::move(centre), evaluations, 0.0, 0.0);
}

Minimum minimise(const Objective& objective,
                 const Box& box,
                 std::span<const std::vector<double>> starts,
                 int global_evaluations,
                 const LocalSearch& options) {
  Minimum best = minimise_globally(objective, box, global_evaluations);
  if (best.at.empty()) return best;
  const Minimum polished = minimise_locally(objective, box, best.at, options);
  if (polished.value < best.value) best = polished;
  for (const std::vector<double>& start : starts) {
    Minimum found = minimise_locally(objective, box, start, options);
    if (found.value < best.value) best = std::move(found);
  }
  return best;
}

}  // namespace repose::calibrator
