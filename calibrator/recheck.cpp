#include "calibrator/recheck.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "calibrator/answer.hpp"
#include "calibrator/known_runs.hpp"
#include "calibrator/offset.hpp"
#include "calibrator/plan.hpp"
#include "calibrator/proposal.hpp"
#include "calibrator/stopping.hpp"
#include "calibrator/surrogate.hpp"

namespace repose::calibrator {
namespace {

constexpr double same_as_published = 0.5;  // standard errors

/// The site of a set that was printed and read again, rounding and all.
std::size_t site_of(Ledger& ledger, const UnitPoint& point) {
  constexpr double rounding = 1e-9;
  for (std::size_t i = 0; i < ledger.sites().size(); ++i) {
    if (distance(ledger.sites()[i].at, point) < rounding) return i;
  }
  return ledger.site_at(point);
}

/// The incumbent's measurement of the same quantity; nothing where tonight's is new.
std::optional<std::size_t> published(const Measurement& measurement, const Published& incumbent) {
  const auto& before = incumbent.calibration.measurements;
  const auto found = std::ranges::find_if(before, [&](const Measurement& other) {
    return is_same_quantity(measurement, other) && measurement.role == other.role;
  });
  if (found == before.end()) return std::nullopt;
  return static_cast<std::size_t>(found - before.begin());
}

/// z when the set was published.
std::optional<double> published_z(const Measurement& measurement, const Published& incumbent) {
  const auto before = published(measurement, incumbent);
  const auto& predictions = incumbent.fit.predictions;
  const auto found = std::ranges::find(predictions, before, [](const Prediction& prediction) {
    return std::optional(prediction.measurement);
  });
  if (!before || found == predictions.end()) return std::nullopt;
  return found->z;
}

bool still_holds(const Calibration& calibration,
                 const Published& incumbent,
                 const std::vector<Prediction>& predictions) {
  for (const Prediction& prediction : predictions) {
    const Measurement& measurement = calibration.measurements[prediction.measurement];
    if (measurement.role != Role::fit) continue;
    if (prediction.replicates < 2 || !std::isfinite(prediction.z)) return false;
    const double reach = std::abs(prediction.predicted - measurement.value);
    if (reach + prediction.standard_error <= standard_uncertainty(measurement)) continue;
    const auto z0 = published_z(measurement, incumbent);
    if (!z0 || !(std::abs(prediction.z - *z0) < same_as_published)) return false;
  }
  return true;
}

/// What the emulator of the known runs adds: what it had promised, intervals, and the best set now.
void learn(const Ledger& ledger, Confirmation& confirmation, Recheck& result) {
  const Surrogate surrogate(ledger, nullptr);
  const Offset offset = learn_offset(ledger, surrogate, confirmation.site);
  const std::vector<Target> targets = targets_of(ledger.calibration(), offset);
  const Outlook outlook{ledger, surrogate, targets};
  const UnitPoint& point = ledger.sites()[confirmation.site].at;
  for (std::size_t j = 0; j < surrogate.size(); ++j) {
    const Belief belief = surrogate.at(j, point);
    confirmation.promised.push_back(
        {belief.mean + offset.value[j], belief.variance + offset.variance[j]});
  }
  fill_predictions(outlook, confirmation, result.fit);
  fill_parameters(outlook, point, result.fit);
  result.fit.offset = offset.value;
  for (const double variance : offset.variance) {
    result.fit.offset_error.push_back(std::sqrt(variance));
  }
  const std::vector<UnitPoint> starts{point};
  Fit now;
  fill_parameters(outlook, recommend(outlook, starts), now);
  result.estimate = std::move(now.parameters);
}

/// The same without an emulator: the replicates are all there is.
void take_over(const Ledger& ledger,
               const Published& incumbent,
               Confirmation& confirmation,
               Recheck& result) {
  const std::size_t count = ledger.calibration().measurements.size();
  for (std::size_t j = 0; j < count; ++j) {
    const RunMean runs = mean_of(confirmation.runs, j);
    confirmation.promised.push_back({runs.mean, runs.count > 1 ? runs.squares / runs.count : 0.0});
  }
  const Surrogate none(std::vector<std::optional<GaussianProcess>>{count});
  fill_predictions({ledger, none, {}}, confirmation, result.fit);
  result.fit.parameters = incumbent.fit.parameters;
  result.fit.directions = incumbent.fit.directions;
  for (const Measurement& measurement : ledger.calibration().measurements) {
    const auto before = published(measurement, incumbent);
    const bool known = before && *before < incumbent.fit.offset.size();
    result.fit.offset.push_back(known ? incumbent.fit.offset[*before] : 0.0);
    result.fit.offset_error.push_back(known ? incumbent.fit.offset_error[*before] : 0.0);
  }
  result.fit.remarks.emplace_back(
      "The intervals are those of the calibration that is continued: too few of its runs are of "
      "use now to judge them anew.");
}

}  // namespace

Recheck recheck(const Calibration& calibration,
                const Published& incumbent,
                const Evaluator& evaluator,
                std::span<const KnownRun> known) {
  Ledger ledger(calibration, evaluator, known);
  const Plan plan = make_plan(calibration);
  Confirmation confirmation;
  confirmation.site = site_of(ledger, ledger.space().coordinates(incumbent.fit.best));
  const bool emulated = know_enough(ledger, plan.least);
  const int count = std::max(plan.confirm, confirming_replicates(ledger));
  const int first = ledger.fresh_replicate(confirmation.site);
  std::vector<Ledger::Request> requests;
  requests.reserve(static_cast<std::size_t>(count));
  for (int r = 0; r < count; ++r)
    requests.push_back({confirmation.site, first + r, Level::confirm});
  confirmation.runs = ledger.run("confirm", requests);

  Recheck result;
  Fit& fit = result.fit;
  fit.best = ledger.space().at(ledger.sites()[confirmation.site].at);
  if (emulated) {
    learn(ledger, confirmation, result);
  } else {
    take_over(ledger, incumbent, confirmation, result);
  }
  result.passed = still_holds(calibration, incumbent, fit.predictions);
  fit.stop = is_hit(ledger, confirmation.runs) ? StopReason::hit : incumbent.fit.stop;
  fit.evaluations = ledger.spent();
  fit.failed = ledger.failed();
  for (HistoryPoint& point : ledger.history()) point.best = fit.misfit;
  fit.history = ledger.history();
  for (const SiteRun& run : confirmation.runs) {
    result.runs.push_back({fit.best, Level::confirm, run.values, run.grain_steps});
  }
  return result;
}

}  // namespace repose::calibrator
