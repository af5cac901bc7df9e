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
  const std::function<bool()>* done = nullptr;
};

std::vector<double> clip(std::vector<double> point, const Box& box) {
  for (std::size_t k = 0; k < point.size(); ++k) {
    point[k] = std::clamp(point[k], box.lower[k], box.upper[k]);
  }
  return point;
}

bool keeps_relations(const std::vector<double>& point, const Box& box) {
  return std::ranges::all_of(box.excesses, [&](const Objective& f) { return f(point) <= 0.0; });
}

/// NLopt may step out of the box by a rounding error, so the point is clipped before it is used.
double watch_value(unsigned n, const double* x, double* /*gradient*/, void* data) noexcept {
  Watch& watch = *static_cast<Watch*>(data);
  try {
    watch.clipped.assign(x, x + n);
    watch.clipped = clip(std::move(watch.clipped), watch.box);
    const double value = watch.objective(watch.clipped);
    const bool better = value < watch.best.value || watch.best.at.empty();
    if (better && keeps_relations(watch.clipped, watch.box)) {
      watch.best = {watch.clipped, value};
    }
    if (watch.done != nullptr && *watch.done && (*watch.done)()) nlopt_force_stop(watch.handle);
    return std::isfinite(value) ? std::min(value, very_large) : very_large;
  } catch (...) {
    watch.thrown = std::current_exception();
    nlopt_force_stop(watch.handle);
    return very_large;
  }
}

/// A relation as NLopt asks for it; it throws nothing.
double relation_value(unsigned n, const double* x, double* /*gradient*/, void* data) noexcept {
  return (*static_cast<const Objective*>(data))(std::span(x, n));
}

using Handle = std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)>;

Handle create(nlopt_algorithm algorithm, std::size_t dimensions) {
  return {nlopt_create(algorithm, static_cast<unsigned>(dimensions)), &nlopt_destroy};
}

/// One run of one algorithm. Its return code is of no interest: whether it converged, ran out of
/// evaluations or hit its rounding limit, the best point seen is the answer.
Minimum run(const Handle& handle,
            const Objective& objective,
            const Box& box,
            std::vector<double> start,
            const DirectSearch& options) {
  Watch watch{objective,
              box,
              handle.get(),
              {{}, std::numeric_limits<double>::infinity()},
              {},
              {},
              &options.done};
  nlopt_srand(options.seed);  // the state is the thread's own: without this, equal searches differ
  nlopt_set_lower_bounds(handle.get(), box.lower.data());
  nlopt_set_upper_bounds(handle.get(), box.upper.data());
  nlopt_set_min_objective(handle.get(), &watch_value, &watch);
  nlopt_set_maxeval(handle.get(), options.evaluations);
  if (options.tolerance > 0.0) nlopt_set_xtol_abs1(handle.get(), options.tolerance);
  if (options.step > 0.0) nlopt_set_initial_step1(handle.get(), options.step);
  for (const Objective& excess : box.excesses) {
    // NLopt only hands the pointer back.
    auto* data = const_cast<Objective*>(&excess);  // NOLINT(cppcoreguidelines-pro-type-const-cast)
    nlopt_add_inequality_constraint(handle.get(), &relation_value, data, 0.0);
  }
  double value = 0.0;
  nlopt_optimize(handle.get(), start.data(), &value);
  if (watch.thrown) std::rethrow_exception(watch.thrown);
  if (watch.best.at.empty()) {
    watch.best.at = clip(std::move(start), box);
    if (keeps_relations(watch.best.at, box)) watch.best.value = objective(watch.best.at);
  }
  return watch.best;
}

/// BOBYQA needs two dimensions, and knows no relations.
nlopt_algorithm quadratic_model(std::size_t dimensions, bool restricted = false) {
  if (restricted) return NLOPT_LN_COBYLA;
  return dimensions == 1 ? NLOPT_LN_SBPLX : NLOPT_LN_BOBYQA;
}

nlopt_algorithm algorithm_of(Algorithm algorithm, std::size_t dimensions) {
  switch (algorithm) {
    case Algorithm::bobyqa:
      return quadratic_model(dimensions);
    case Algorithm::cobyla:
      return NLOPT_LN_COBYLA;
    case Algorithm::sbplx:
      return NLOPT_LN_SBPLX;
    case Algorithm::crs2:
      return NLOPT_GN_CRS2_LM;
    case Algorithm::isres:
      return NLOPT_GN_ISRES;
    case Algorithm::direct_l:
      return NLOPT_GN_DIRECT_L;
    case Algorithm::mlsl:
      return NLOPT_G_MLSL_LDS;
  }
  return NLOPT_LN_SBPLX;
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
  const bool restricted = !box.excesses.empty();
  const Handle handle = create(quadratic_model(start.size(), restricted), start.size());
  return run(handle,
             objective,
             box,
             std::move(start),
             {.evaluations = options.evaluations,
              .step = options.step,
              .tolerance = options.tolerance,
              .done = {}});
}

Minimum minimise_globally(const Objective& objective, const Box& box, int evaluations) {
  std::vector<double> centre(box.lower.size());
  for (std::size_t k = 0; k < centre.size(); ++k) centre[k] = 0.5 * (box.lower[k] + box.upper[k]);
  if (centre.empty()) return {centre, objective(centre)};
  // Only the authors' own DIRECT-L knows relations.
  const auto algorithm = box.excesses.empty() ? NLOPT_GN_DIRECT_L : NLOPT_GN_ORIG_DIRECT_L;
  const Handle handle = create(algorithm, centre.size());
  return run(handle,
             objective,
             box,
             std::move(centre),
             {.evaluations = evaluations, .step = 0.0, .tolerance = 0.0, .done = {}});
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

Minimum minimise_by(Algorithm algorithm,
                    const Objective& objective,
                    const Box& box,
                    std::vector<double> start,
                    const DirectSearch& options) {
  const std::size_t n = start.size();
  const Handle handle = create(algorithm_of(algorithm, n), n);
  if (algorithm == Algorithm::mlsl) {
    const Handle local = create(quadratic_model(n), n);
    nlopt_set_xtol_abs1(local.get(), 10.0 * options.tolerance);
    nlopt_set_initial_step1(local.get(), options.step);
    nlopt_set_local_optimizer(handle.get(), local.get());
  }
  const bool global = algorithm >= Algorithm::crs2;
  DirectSearch here = options;
  if (global) here.step = here.tolerance = 0.0;  // they go on until the budget is spent
  return run(handle, objective, box, clip(std::move(start), box), here);
}

}  // namespace repose::calibrator
