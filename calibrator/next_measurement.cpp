#include "calibrator/next_measurement.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include <Eigen/LU>

#include "calibrator/diagnosis/tolerance.hpp"
#include "calibrator/uncertainty.hpp"

namespace repose::calibrator {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t shown = 3;
constexpr double least_gain = 0.01;

/// Standard errors over sizes of the fitted measurements, their median.
double typical_relative_error(const std::vector<Measurement>& measurements) {
  std::vector<double> relative;
  for (const Measurement& m : measurements) {
    if (m.role == Role::fit && size_of(m) > 0.0) relative.push_back(m.standard_error / size_of(m));
  }
  if (relative.empty()) return 0.0;
  const auto middle = relative.begin() + static_cast<std::ptrdiff_t>(relative.size() / 2);
  std::ranges::nth_element(relative, middle);
  return *middle;
}

/// The emulator of an observable that nobody measured, of the runs at the search level.
std::optional<GaussianProcess> emulator_of(const Ledger& ledger, std::size_t unmeasured) {
  std::vector<Sample> samples;
  double squares = 0.0;
  int freedom = 0;
  std::vector<int> counts;
  for (const Site& site : ledger.sites()) {
    const RunMean runs = mean_of(site.searched, unmeasured, &SiteRun::unmeasured);
    if (runs.count == 0) continue;
    samples.push_back({site.at, runs.mean, 0.0});
    counts.push_back(runs.count);
    squares += runs.squares;
    freedom += runs.count - 1;
  }
  if (samples.size() < ledger.space().dimensions() + 2 || freedom == 0) return std::nullopt;
  const double variance = std::max(squares / freedom, 1e-300);
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i].variance = variance / counts[i];
  const std::vector<Hyperparameters> starts{prior_mode(ledger.space().dimensions())};
  return GaussianProcess::fit(std::move(samples), starts);
}

/// Fills in what the measurement would teach, `added` being J_c' J_c / v_c.
void judge(const MatrixXd& precision,
           const VectorXd& prior,
           const MatrixXd& added,
           NextMeasurement& next) {
  const VectorXd variance_before = precision.inverse().diagonal();
  const VectorXd variance_after = (precision + added).inverse().diagonal();
  const VectorXd taken_away = prior.cwiseProduct(variance_before - variance_after);
  next.gain = taken_away.sum();
  Index most = 0;
  taken_away.maxCoeff(&most);
  next.parameter = static_cast<std::size_t>(most);
  next.learnt = 1.0 - prior(most) * variance_after(most);
}

}  // namespace

std::vector<NextMeasurement> next_measurements(const Outlook& outlook, const UnitPoint& best) {
  std::vector<NextMeasurement> all;
  if (best.empty()) return all;
  const Ledger& ledger = outlook.ledger;
  const auto& measurements = ledger.calibration().measurements;
  const VectorXd prior = prior_precision(outlook, best);
  const MatrixXd precision = information(outlook, best) + MatrixXd(prior.asDiagonal());
  const auto consider = [&](NextMeasurement next, const VectorXd& slope, double weight) {
    judge(precision, prior, weight * slope * slope.transpose(), next);
    if (next.gain >= least_gain) all.push_back(std::move(next));
  };
  for (const Target& target : outlook.targets) {
    const Measurement& m = measurements[target.measurement];
    const auto& process = outlook.surrogate.process(target.measurement);
    const Belief belief = process->at(best);
    const double half = 0.5 * m.standard_error;
    const double before = belief.variance + target.variance;
    const double after = before - 0.75 * m.standard_error * m.standard_error;
    consider({m.experiment, m.observable, true, belief.mean, half},
             process->gradient(best),
             1.0 / after - 1.0 / before);
  }
  const double relative = typical_relative_error(measurements);
  const auto unmeasured = ledger.suite().unmeasured();
  for (std::size_t c = 0; c < unmeasured.size(); ++c) {
    const auto process = emulator_of(ledger, c);
    if (!process) continue;
    const Belief belief = process->at(best);
    Measurement imagined;
    imagined.value = belief.mean;
    imagined.unit = unmeasured[c].info.unit;
    const double error = relative * size_of(imagined);
    consider(
        {unmeasured[c].experiment, std::string(unmeasured[c].info.name), false, belief.mean, error},
        process->gradient(best),
        1.0 / (belief.variance + error * error));
  }
  std::ranges::stable_sort(all, std::greater{}, &NextMeasurement::gain);
  if (all.size() > shown) all.resize(shown);
  return all;
}

}  // namespace repose::calibrator
