#include "calibrator/ledger.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "engine/random.hpp"

namespace repose::calibrator {
namespace {

/// The seed of one evaluation: a function of the question alone, so that a replay asks the same. 53
/// bits, so that it survives as a JSON number.
std::uint64_t trial_seed(std::uint64_t seed, std::size_t site, int replicate) {
  using engine::Purpose;
  using engine::Random;
  const std::uint64_t of_site = Random(seed, Purpose::trial, site).bits();
  return Random(of_site, Purpose::trial, static_cast<std::uint64_t>(replicate)).bits() >> 11U;
}

std::string describe(const engine::Trial& trial, engine::FailureKind kind) {
  return trial.experiment.name + ": " +
         std::string(engine::failure_kind_names[static_cast<std::size_t>(kind)]);
}

}  // namespace

Ledger::Ledger(const Calibration& calibration,
               const Evaluator& evaluator,
               std::span<const KnownRun> known,
               Meter meter)
    : calibration_(calibration),
      evaluator_(evaluator),
      meter_(std::move(meter)),
      space_(calibration),
      suite_(calibration.measurements) {
  for (const KnownRun& run : known) {
    const std::size_t site = site_at(space_.coordinates(run.parameters));
    SiteRun made{fresh_replicate(site), run.values, true, run.grain_steps};
    for (std::size_t j = 0; j < made.values.size(); ++j) {
      const bool fitted = calibration.measurements[j].role == Role::fit;
      if (fitted && !std::isfinite(made.values[j])) made.succeeded = false;
    }
    runs(site, run.level).push_back(std::move(made));
  }
}

int Ledger::remaining() const {
  const Budget& budget = calibration_.budget;
  int left = budget.evaluations - spent();
  if (meter_ && spent() > 0) {
    const Spent so_far = meter_();
    const auto limit = [&](const std::optional<double>& allowed, double used) {
      if (!allowed || used <= 0.0) return;
      const double more = std::floor((*allowed - used) / (used / spent()));
      left = static_cast<int>(std::min<double>(left, more));
    };
    limit(budget.core_seconds, so_far.core_seconds);
    limit(budget.wall_seconds, so_far.wall_seconds);
  }
  return std::max(left, 0);
}

bool Ledger::two_levels() const {
  return calibration_.budget.fidelity != calibration_.budget.confirm_fidelity;
}

engine::Fidelity Ledger::fidelity_of(Level level) const {
  const Budget& budget = calibration_.budget;
  if (level == Level::draft) return engine::Fidelity::draft;
  return level == Level::search ? budget.fidelity : budget.confirm_fidelity;
}

std::vector<SiteRun>& Ledger::runs(std::size_t site, Level level) {
  if (level == Level::draft) return sites_[site].drafted;
  const bool apart = level == Level::confirm && two_levels();
  return apart ? sites_[site].confirmed : sites_[site].searched;
}

std::size_t Ledger::site_at(const UnitPoint& point) {
  const auto found = std::ranges::find(sites_, point, &Site::at);
  if (found != sites_.end()) return static_cast<std::size_t>(found - sites_.begin());
  sites_.push_back({point, {}, {}});
  return sites_.size() - 1;
}

int Ledger::fresh_replicate(std::size_t site) const {
  int next = 0;
  for (const SiteRun& run : sites_[site].searched) next = std::max(next, run.replicate + 1);
  for (const SiteRun& run : sites_[site].confirmed) next = std::max(next, run.replicate + 1);
  return next;
}

std::vector<SiteRun> Ledger::run(std::string_view stage, std::span<const Request> requests) {
  std::vector<engine::Trial> trials;
  for (const Request& request : requests) {
    suite_.append_trials(space_.at(sites_[request.site].at),
                         fidelity_of(request.level),
                         trial_seed(calibration_.seed, request.site, request.replicate),
                         trials);
  }
  const std::vector<engine::Evaluation> evaluations = evaluator_(trials);
  assert(evaluations.size() == trials.size());
  std::vector<SiteRun> made;
  for (std::size_t i = 0; i < requests.size(); ++i) {
    made.push_back(
        note(requests[i], stage, std::span(evaluations).subspan(i * suite_.size(), suite_.size())));
  }
  return made;
}

SiteRun Ledger::note(const Request& request,
                     std::string_view stage,
                     std::span<const engine::Evaluation> evaluations) {
  const bool counted = request.level != Level::draft;
  SiteRun run{
      request.replicate, suite_.read(evaluations), true, 0.0, suite_.read_unmeasured(evaluations)};
  bool complete = true;
  for (const engine::Evaluation& evaluation : evaluations) {
    run.grain_steps += static_cast<double>(evaluation.effort.grain_steps);
    if (const auto* failure = std::get_if<engine::Failure>(&evaluation.outcome)) {
      complete = false;
      if (!counted) continue;
      FailureCount& count = failures_[describe(evaluation.trial, failure->kind)];
      if (count.times++ == 0) count.message = failure->message;
    }
  }
  for (std::size_t j = 0; j < run.values.size(); ++j) {
    if (std::isfinite(run.values[j])) continue;
    complete = false;
    if (calibration_.measurements[j].role == Role::fit) run.succeeded = false;
  }
  runs(request.site, request.level).push_back(run);
  if (!counted) return run;
  if (!complete) ++failed_;

  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  history_.push_back({spent() + 1,
                      stage,
                      space_.at(sites_[request.site].at),
                      run.values,
                      misfit(calibration_.measurements, run.values),
                      unknown});
  return run;
}

std::string Ledger::commonest_failure() const {
  std::string text;
  int most = 0;
  for (const auto& [kind, count] : failures_) {
    if (count.times <= most) continue;
    most = count.times;
    text = count.message.empty() ? kind : kind + " (" + count.message + ")";
  }
  return text;
}

Scatter Ledger::scatter(Level level) const {
  const std::size_t count = calibration_.measurements.size();
  const bool apart = level == Level::confirm && two_levels();
  Scatter result{std::vector<double>(count, 0.0), std::vector<int>(count, 0)};
  for (std::size_t j = 0; j < count; ++j) {
    for (const Site& site : sites_) {
      const RunMean runs = mean_of(apart ? site.confirmed : site.searched, j);
      if (runs.count < 2) continue;
      result.variance[j] += runs.squares;
      result.freedom[j] += runs.count - 1;
    }
    const double sigma = standard_uncertainty(calibration_.measurements[j]);
    if (result.freedom[j] == 0) {
      result.variance[j] = sigma * sigma;
    } else {
      result.variance[j] /= result.freedom[j];
    }
    // A simulation without scatter is still no better known than a hundredth of the measurement.
    result.variance[j] = std::max(result.variance[j], 1e-4 * sigma * sigma);
  }
  return result;
}

RunMean mean_of(std::span<const SiteRun> runs,
                std::size_t measurement,
                std::vector<double> SiteRun::*values) {
  RunMean result;
  for (const SiteRun& run : runs) {
    if (measurement >= (run.*values).size()) continue;
    const double value = (run.*values)[measurement];
    if (!std::isfinite(value)) continue;
    ++result.count;  // Welford 1962, Technometrics 4, 419-420
    const double deviation = value - result.mean;
    result.mean += deviation / result.count;
    result.squares += deviation * (value - result.mean);
  }
  return result;
}

double run_variance(const RunMean& runs, double pooled) {
  constexpr double prior_freedom = 4.0;  // nu0 of calibration.md 7.3
  const int freedom = std::max(runs.count - 1, 0);
  return (prior_freedom * pooled + runs.squares) / (prior_freedom + freedom);
}

}  // namespace repose::calibrator
