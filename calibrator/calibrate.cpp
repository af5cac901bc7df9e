#include "calibrator/calibrate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "calibrator/design.hpp"
#include "calibrator/ledger.hpp"
#include "calibrator/misfit.hpp"
#include "calibrator/offset.hpp"
#include "calibrator/proposal.hpp"
#include "calibrator/remarks.hpp"
#include "calibrator/stopping.hpp"
#include "calibrator/surrogate.hpp"
#include "calibrator/uncertainty.hpp"

namespace repose::calibrator {
namespace {

/// How the budget is split before anything is known.
struct Plan {
  int start = 0;       ///< space-filling points
  int least = 0;       ///< of these that must succeed
  int replicates = 4;  ///< at the best of them
  int pairs = 0;       ///< of these repeated at the confirming fidelity
  int confirm = 4;     ///< fresh replicates of the recommended point, at the least
  bool affordable = true;

  [[nodiscard]] int total() const { return start + replicates + pairs + confirm; }
};

Plan make_plan(const Calibration& calibration) {
  const int d = static_cast<int>(calibration.free.size());
  const Budget& budget = calibration.budget;
  Plan plan;
  plan.least = d == 0 ? 1 : d + 2;
  plan.start = d == 0 ? 1 : std::max({2 * d, budget.batch, plan.least});
  plan.pairs = budget.fidelity == budget.confirm_fidelity ? 0 : plan.replicates;
  // What is given up first when the budget is short: points of the start, then repetitions.
  plan.start = std::max(plan.least, plan.start - std::max(0, plan.total() - budget.evaluations));
  if (plan.total() > budget.evaluations) {
    plan.replicates = plan.confirm = 2;
    plan.pairs = std::min(plan.pairs, 2);
  }
  plan.affordable = plan.total() <= budget.evaluations;
  return plan;
}

/// The recommended point as fresh replicates found it, and what had been promised.
struct Confirmation {
  std::size_t site = 0;
  std::vector<SiteRun> runs;
  std::vector<Belief> promised;  ///< SI, at the confirming fidelity
};

class Search {
 public:
  Search(const Calibration& calibration,
         const Evaluator& evaluator,
         const std::stop_token& stop,
         const ProgressObserver& observer)
      : calibration_(calibration),
        plan_(make_plan(calibration)),
        stop_(stop),
        observer_(observer),
        ledger_(calibration, evaluator) {}

  Fit run();

 private:
  using Requests = std::vector<Ledger::Request>;

  bool start();
  void replicate();
  void pair();
  void learn();
  void search(int count);
  bool confirm();
  [[nodiscard]] std::optional<StopReason> verdict();
  [[nodiscard]] bool promise_kept() const;
  [[nodiscard]] int reserve() const;
  [[nodiscard]] Outlook outlook() const { return {ledger_, *surrogate_, targets_}; }
  [[nodiscard]] std::vector<Belief> predict(const UnitPoint& point) const;
  void complete_history();
  void report(std::string_view stage) const;
  Fit finish(StopReason reason);
  Fit fail(std::string remark);
  void fill_predictions(Fit& fit) const;
  void fill_parameters(Fit& fit, const UnitPoint& best) const;

  const Calibration& calibration_;
  Plan plan_;
  std::stop_token stop_;
  const ProgressObserver& observer_;
  Ledger ledger_;
  std::optional<Surrogate> surrogate_;
  Offset offset_;
  std::vector<Target> targets_;
  UnitPoint recommended_;
  std::size_t base_ = 0;  ///< the site last run at the confirming fidelity
  std::optional<Confirmation> confirmation_;
  int rounds_ = 0;
  int implausible_rounds_ = 0;  ///< in a row
};

int succeeded(const Ledger& ledger) {
  int count = 0;
  for (const Site& site : ledger.sites()) {
    if (std::ranges::any_of(site.searched, &SiteRun::succeeded)) ++count;
  }
  return count;
}

Fit Search::run() {
  if (std::ranges::count(calibration_.measurements, Role::fit, &Measurement::role) == 0) {
    return fail("There is no measurement to fit.");
  }
  if (!plan_.affordable) return fail(budget_too_small(calibration_, plan_.total()));
  if (!start()) {
    if (stop_.stop_requested()) return finish(StopReason::cancelled);
    return fail(too_few_succeeded(ledger_, succeeded(ledger_), plan_.least));
  }
  if (!stop_.stop_requested()) replicate();
  if (!stop_.stop_requested()) pair();
  learn();
  report("search");
  while (!stop_.stop_requested()) {
    if (const auto reason = verdict()) {
      if (confirm()) return finish(StopReason::hit);
      if (*reason != StopReason::hit && promise_kept()) return finish(*reason);
      if (ledger_.remaining() <= reserve()) return finish(StopReason::budget);
      learn();  // what was confirmed is evidence like any other
    }
    const int room = ledger_.remaining() - reserve();
    if (room <= 0) return finish(confirm() ? StopReason::hit : StopReason::budget);
    search(std::min(std::max(calibration_.budget.batch, 1), room));
    learn();
    report("search");
  }
  return finish(StopReason::cancelled);
}

/// Space-filling points; a second set where too many of the first failed. False if still too few.
bool Search::start() {
  for (std::uint64_t attempt = 0; attempt < 2 && !stop_.stop_requested(); ++attempt) {
    if (plan_.total() - plan_.start > ledger_.remaining() - plan_.start) break;
    Requests requests;
    for (const UnitPoint& point : spread_design(static_cast<std::size_t>(plan_.start),
                                                calibration_.free.size(),
                                                calibration_.seed,
                                                attempt)) {
      requests.push_back({ledger_.site_at(point), 0, Level::search});
    }
    ledger_.run("start", requests);
    report("start");
    if (succeeded(ledger_) >= plan_.least) return true;
  }
  return false;
}

/// Fresh seeds at the point whose single run came closest, for the scatter.
void Search::replicate() {
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < ledger_.sites().size(); ++i) {
    const Site& site = ledger_.sites()[i];
    if (site.searched.empty() || !site.searched.front().succeeded) continue;
    const double q = misfit(calibration_.measurements, site.searched.front().values);
    if (q < smallest) {
      smallest = q;
      base_ = i;
    }
  }
  Requests requests;
  const int first = ledger_.fresh_replicate(base_);
  for (int r = 0; r < plan_.replicates; ++r) requests.push_back({base_, first + r, Level::search});
  ledger_.run("replicate", requests);
  report("replicate");
}

/// The same seeds at the confirming fidelity. The run that made the point the best is left out: it
/// is the lucky one.
void Search::pair() {
  if (plan_.pairs == 0) return;
  Requests requests;
  for (int r = 0; r < plan_.pairs; ++r) requests.push_back({base_, 1 + r, Level::confirm});
  ledger_.run("pair", requests);
  report("pair");
}

/// Emulator, offset, targets and recommendation from all that is known.
void Search::learn() {
  surrogate_.emplace(Surrogate(ledger_, surrogate_ ? &*surrogate_ : nullptr));
  offset_ = learn_offset(ledger_, *surrogate_, base_);
  targets_.clear();
  for (std::size_t j = 0; j < calibration_.measurements.size(); ++j) {
    const Measurement& measurement = calibration_.measurements[j];
    if (measurement.role != Role::fit) continue;
    const double sigma = standard_uncertainty(measurement);
    targets_.push_back(
        {j, measurement.value - offset_.value[j], sigma * sigma + offset_.variance[j]});
  }
  std::vector<UnitPoint> starts;
  if (!recommended_.empty()) starts.push_back(recommended_);
  recommended_ = recommend(outlook(), starts);
  complete_history();
}

void Search::search(int count) {
  Requests requests;
  std::vector<int> next;  // replicate numbers already promised to this batch, per site
  for (const UnitPoint& point : propose(outlook(), recommended_, count, rounds_)) {
    const std::size_t site = ledger_.site_at(point);
    next.resize(ledger_.sites().size(), -1);
    if (next[site] < 0) next[site] = ledger_.fresh_replicate(site);
    requests.push_back({site, next[site]++, Level::search});
  }
  ledger_.run("search", requests);
  ++rounds_;
}

/// Runs kept back for the confirmation.
int Search::reserve() const {
  return std::max(plan_.confirm, plan_.confirm < 4 ? 0 : confirming_replicates(ledger_));
}

/// Fresh replicates of the recommended point. True if they are a hit.
bool Search::confirm() {
  const UnitPoint point = settle(outlook(), recommended_);
  Confirmation confirmation{ledger_.site_at(point), {}, predict(point)};
  Requests requests;
  const int first = ledger_.fresh_replicate(confirmation.site);
  const int count = std::min(reserve(), ledger_.remaining());
  for (int r = 0; r < count; ++r) {
    requests.push_back({confirmation.site, first + r, Level::confirm});
  }
  confirmation.runs = ledger_.run("confirm", requests);
  base_ = confirmation.site;
  confirmation_ = std::move(confirmation);
  report("confirm");
  return is_hit(ledger_, confirmation_->runs);
}

/// Whether the fresh replicates are what the emulator had led to expect.
bool Search::promise_kept() const {
  const Scatter scatter = ledger_.scatter(Level::confirm);
  for (const Target& target : targets_) {
    const std::size_t j = target.measurement;
    const RunMean runs = mean_of(confirmation_->runs, j);
    if (runs.count == 0) return false;
    const Belief& promised = confirmation_->promised[j];
    const double variance =
        promised.variance + run_variance(runs, scatter.variance[j]) / runs.count;
    const double gap = runs.mean - promised.mean;
    if (gap * gap > 9.0 * variance) return false;  // three standard deviations
  }
  return true;
}

/// A reason to stop searching, if the emulator sees one; it is to be confirmed.
std::optional<StopReason> Search::verdict() {
  if (ledger_.remaining() < reserve()) return std::nullopt;
  const UnitPoint point = settle(outlook(), recommended_);
  if (probability_of_hit(outlook(), point, reserve()) > 0.5) return StopReason::hit;
  if (rounds_ < 2 && !calibration_.free.empty()) return std::nullopt;
  const bool far = least_implausibility(outlook(), recommended_) > 3.0;
  implausible_rounds_ = far ? implausible_rounds_ + 1 : 0;
  if (implausible_rounds_ >= 2) return StopReason::implausible;
  if (far) return std::nullopt;
  if (probability_of_better(outlook(), point) <= 0.05) return StopReason::no_better;
  return std::nullopt;
}

/// The emulator's predictions at the confirming fidelity.
std::vector<Belief> Search::predict(const UnitPoint& point) const {
  std::vector<Belief> beliefs;
  for (std::size_t j = 0; j < surrogate_->size(); ++j) {
    Belief belief = surrogate_->at(j, point);
    belief.mean += offset_.value[j];
    belief.variance += offset_.variance[j];
    beliefs.push_back(belief);
  }
  return beliefs;
}

/// What the emulator adds to the evaluations made since it learnt last.
void Search::complete_history() {
  const double best = expected_misfit(*surrogate_, targets_, recommended_);
  for (HistoryPoint& point : ledger_.history()) {
    if (!std::isnan(point.best)) continue;
    point.best = best;
    const bool cheap =
        point.stage == "start" || point.stage == "replicate" || point.stage == "search";
    if (!cheap) continue;
    std::vector<double> corrected = point.values;
    for (std::size_t j = 0; j < corrected.size(); ++j) corrected[j] += offset_.value[j];
    point.misfit = misfit(calibration_.measurements, corrected);
  }
}

void Search::report(std::string_view stage) const {
  if (!observer_) return;
  Progress progress{stage,
                    ledger_.spent(),
                    calibration_.budget.evaluations,
                    std::numeric_limits<double>::quiet_NaN(),
                    {},
                    {},
                    {}};
  if (surrogate_) {
    progress.misfit = expected_misfit(*surrogate_, targets_, recommended_);
    for (const Belief& belief : predict(recommended_)) progress.predicted.push_back(belief.mean);
    progress.z = standardised_residuals(calibration_.measurements, progress.predicted);
    progress.best = ledger_.space().at(recommended_);
  }
  observer_(progress);
}

Fit Search::fail(std::string remark) {
  Fit fit;
  fit.evaluations = ledger_.spent();
  fit.failed = ledger_.failed();
  fit.stop = StopReason::failed;
  fit.history = ledger_.history();
  fit.misfit = std::numeric_limits<double>::quiet_NaN();
  fit.remarks.push_back(std::move(remark));
  return fit;
}

Fit Search::finish(StopReason reason) {
  // Whatever was about to be concluded, runs that were cut short are no evidence of it.
  if (stop_.stop_requested() && reason != StopReason::hit) reason = StopReason::cancelled;
  if (!surrogate_) {
    Fit fit = fail("The search was cancelled before anything was learnt.");
    fit.stop = reason;
    return fit;
  }
  learn();  // the confirming runs too
  const bool confirmed = confirmation_ && reason != StopReason::cancelled;
  if (!confirmed) confirmation_.reset();
  const UnitPoint best = confirmed ? ledger_.sites()[confirmation_->site].at : recommended_;
  Fit fit;
  fit.best = ledger_.space().at(best);
  fit.stop = reason;
  fit.evaluations = ledger_.spent();
  fit.failed = ledger_.failed();
  fit.offset = offset_.value;
  for (const double variance : offset_.variance) fit.offset_error.push_back(std::sqrt(variance));
  if (!confirmation_) confirmation_ = Confirmation{0, {}, predict(best)};
  fill_predictions(fit);
  fill_parameters(fit, best);
  fit.history = ledger_.history();
  fit.remarks = remarks(outlook(), fit);
  report("confirm");
  return fit;
}

void Search::fill_predictions(Fit& fit) const {
  const Scatter scatter = ledger_.scatter(Level::confirm);
  fit.misfit = 0.0;
  for (std::size_t j = 0; j < calibration_.measurements.size(); ++j) {
    const Measurement& measurement = calibration_.measurements[j];
    const RunMean runs = mean_of(confirmation_->runs, j);
    const Belief& promised = confirmation_->promised[j];
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

void Search::fill_parameters(Fit& fit, const UnitPoint& best) const {
  const std::vector<Interval> intervals = profile_intervals(outlook(), best);
  Learnt learnt = learnt_directions(outlook(), best);
  for (std::size_t k = 0; k < best.size(); ++k) {
    const SearchSpace& space = ledger_.space();
    const Interval& interval = intervals[k];
    fit.parameters.push_back({calibration_.free[k].key,
                              space.value(k, best[k]),
                              space.value(k, interval.lower),
                              space.value(k, interval.upper),
                              interval.lower_at_bound,
                              interval.upper_at_bound,
                              learnt.share[k],
                              !interval.lower_at_bound && !interval.upper_at_bound});
  }
  fit.directions = std::move(learnt.directions);
}

}  // namespace

Fit calibrate(const Calibration& calibration,
              const Evaluator& evaluator,
              std::stop_token stop,  // NOLINT(performance-unnecessary-value-param): as declared
              const ProgressObserver& observer) {
  return Search(calibration, evaluator, stop, observer).run();
}

}  // namespace repose::calibrator
