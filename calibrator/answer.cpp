#include "calibrator/answer.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "calibrator/misfit.hpp"
#include "calibrator/next_measurement.hpp"
#include "calibrator/posterior.hpp"
#include "calibrator/uncertainty.hpp"

namespace repose::calibrator {

bool promise_kept(const Outlook& outlook, const Confirmation& confirmation) {
  const Scatter scatter = outlook.ledger.scatter(Level::confirm);
  for (const Target& target : outlook.targets) {
    const std::size_t j = target.measurement;
    const RunMean runs = mean_of(confirmation.runs, j);
    if (runs.count == 0) return false;
    const Belief& promised = confirmation.promised[j];
    const double variance =
        promised.variance + run_variance(runs, scatter.variance[j]) / runs.count;
    const double gap = runs.mean - promised.mean;
    if (gap * gap > 9.0 * variance) return false;  // three standard deviations
  }
  return true;
}

void fill_predictions(const Outlook& outlook, const Confirmation& confirmation, Fit& fit) {
  const auto& measurements = outlook.ledger.calibration().measurements;
  const Scatter scatter = outlook.ledger.scatter(Level::confirm);
  fit.misfit = 0.0;
  for (std::size_t j = 0; j < measurements.size(); ++j) {
    const Measurement& measurement = measurements[j];
    const RunMean runs = mean_of(confirmation.runs, j);
    const Belief& promised = confirmation.promised[j];
    Prediction p;
    p.measurement = j;
    p.replicates = runs.count;
    p.emulated = promised.mean;
    p.emulated_deviation = std::sqrt(promised.variance);
    p.scatter = std::sqrt(run_variance(runs, scatter.variance[j]));
    // Without a confirming run the emulator's word is all there is.
    p.predicted = runs.count > 0 ? runs.mean : promised.mean;
    p.standard_error = runs.count > 0 ? p.scatter / std::sqrt(runs.count) : p.emulated_deviation;
    p.z = (p.predicted - measurement.value) /
          std::hypot(standard_uncertainty(measurement), p.standard_error);
    if (measurement.role == Role::fit) fit.misfit += p.z * p.z;
    fit.predictions.push_back(p);
  }
}

void fill_parameters(const Outlook& outlook, const UnitPoint& best, Fit& fit) {
  const Calibration& calibration = outlook.ledger.calibration();
  const std::vector<Interval> intervals = profile_intervals(outlook, best);
  Learnt learnt = learnt_directions(outlook, best);
  for (std::size_t k = 0; k < best.size(); ++k) {
    const SearchSpace& space = outlook.ledger.space();
    const Interval& interval = intervals[k];
    fit.parameters.push_back({calibration.free[k].key,
                              space.value(k, best[k]),
                              space.value(k, interval.lower),
                              space.value(k, interval.upper),
                              interval.lower_at_bound,
                              interval.upper_at_bound,
                              learnt.share[k],
                              !interval.lower_at_bound && !interval.upper_at_bound});
  }
  fit.directions = std::move(learnt.directions);
  fit.posterior = sample_posterior(outlook, best);
  fit.next = next_measurements(outlook, best);
}

Fit failure(Ledger& ledger, std::string remark) {
  Fit fit;
  fit.evaluations = ledger.spent();
  fit.failed = ledger.failed();
  fit.stop = StopReason::failed;
  fit.history = ledger.history();
  fit.misfit = std::numeric_limits<double>::quiet_NaN();
  fit.remarks.push_back(std::move(remark));
  return fit;
}

}  // namespace repose::calibrator
