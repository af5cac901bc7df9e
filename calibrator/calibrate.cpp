#include "calibrator/calibrate.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "calibrator/answer.hpp"
#include "calibrator/baselines/baseline.hpp"
#include "calibrator/design.hpp"
#include "calibrator/draft_help.hpp"
#include "calibrator/known_runs.hpp"
#include "calibrator/ledger.hpp"
#include "calibrator/misfit.hpp"
#include "calibrator/offset.hpp"
#include "calibrator/plan.hpp"
#include "calibrator/proposal.hpp"
#include "calibrator/remarks.hpp"
#include "calibrator/stopping.hpp"
#include "calibrator/surrogate.hpp"

namespace repose::calibrator {
namespace {

constexpr int least_rounds = 2;  // of a search, before it is judged

class Search {
 public:
  Search(const Calibration& calibration,
         const Evaluator& evaluator,
         const CalibrateOptions& options)
      : calibration_(calibration),
        plan_(make_plan(calibration)),
        stop_(options.stop),
        observer_(options.observer),
        ledger_(calibration, evaluator, options.known, options.meter) {}

  Fit run();

 private:
  using Requests = std::vector<Ledger::Request>;

  Fit run_baseline();
  bool start();
  void draft();
  void replicate();
  void pair();
  void learn();
  void search(int count);
  bool confirm();
  StopReason close();
  [[nodiscard]] std::optional<StopReason> verdict();
  [[nodiscard]] int reserve() const;
  [[nodiscard]] int kept_back() const;
  Confirmation& confirmation_of(const UnitPoint& point);
  [[nodiscard]] Outlook outlook() const { return {ledger_, *surrogate_, targets_}; }
  [[nodiscard]] std::vector<Belief> predict(const UnitPoint& point) const;
  [[nodiscard]] const Confirmation* best_confirmed() const;
  void complete_history();
  void report(std::string_view stage) const;
  void report_baseline(const BaselineSearch& search);
  [[nodiscard]] bool by_baseline() const;
  Fit finish(StopReason reason);

  const Calibration& calibration_;
  Plan plan_;
  std::stop_token stop_;
  const ProgressObserver& observer_;
  Ledger ledger_;
  std::optional<Surrogate> surrogate_;
  Offset offset_;
  std::vector<Target> targets_;
  UnitPoint recommended_;
  std::size_t base_ = 0;                     ///< the site last run at the confirming fidelity
  std::vector<Confirmation> confirmations_;  ///< one a site, the latest at the end
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
    return failure(ledger_, "There is no measurement to fit.");
  }
  if (!plan_.affordable) return failure(ledger_, budget_too_small(calibration_, plan_.total()));
  if (by_baseline()) return run_baseline();
  if (!start()) {
    if (stop_.stop_requested()) return finish(StopReason::cancelled);
    return failure(ledger_, too_few_succeeded(ledger_, succeeded(ledger_), plan_.least));
  }
  if (!stop_.stop_requested()) draft();
  if (!stop_.stop_requested()) replicate();
  if (!stop_.stop_requested()) pair();
  learn();
  report("search");
  while (!stop_.stop_requested()) {
    if (const auto reason = verdict()) {
      if (confirm()) return finish(StopReason::hit);
      if (*reason != StopReason::hit && promise_kept(outlook(), confirmations_.back()))
        return finish(*reason);
      learn();  // what was confirmed is evidence like any other
    }
    const int room = ledger_.remaining() - kept_back();
    if (room <= 0) return finish(close());
    search(std::min(std::max(calibration_.budget.batch, 1), room));
    learn();
    report("search");
  }
  return finish(StopReason::cancelled);
}

/// A study of fixed parameters has nothing to search, whatever the method.
bool Search::by_baseline() const {
  return calibration_.budget.method != Method::repose && !calibration_.free.empty();
}

/// What the baseline recommends is confirmed by fresh replicates; the emulator then learns from all
/// its runs what the answer says beyond the best set.
Fit Search::run_baseline() {
  BaselineSearch search(
      ledger_, plan_.confirm, stop_, [this](const BaselineSearch& now) { report_baseline(now); });
  const bool converged = search_by_baseline(search, calibration_.budget.method);
  recommended_ = search.recommended();
  if (stop_.stop_requested()) {
    Fit fit = finish(StopReason::cancelled);
    fit.best = ledger_.space().at(recommended_);
    return fit;
  }
  if (succeeded(ledger_) < plan_.least) {
    return failure(ledger_, too_few_succeeded(ledger_, succeeded(ledger_), plan_.least));
  }
  base_ = ledger_.site_at(recommended_);
  learn();
  if (confirm()) return finish(StopReason::hit);
  return finish(converged ? StopReason::converged : StopReason::budget);
}

/// Space-filling points; a second set where too many of the first failed. False if still too few.
bool Search::start() {
  if (know_enough(ledger_, plan_.least)) return true;
  for (std::uint64_t attempt = 0; attempt < 2 && !stop_.stop_requested(); ++attempt) {
    if (plan_.total() - plan_.start > ledger_.remaining() - plan_.start) break;
    Requests requests;
    for (const UnitPoint& point : spread_design(
             ledger_.space(), static_cast<std::size_t>(plan_.start), calibration_.seed, attempt)) {
      requests.push_back({ledger_.site_at(point), 0, Level::search});
    }
    ledger_.run("start", requests);
    report("start");
    if (succeeded(ledger_) >= plan_.least) return true;
  }
  return false;
}

/// Draft runs at the points and with the seeds of the start, and elsewhere where these prove that
/// they help.
void Search::draft() {
  constexpr std::uint64_t draft_design = 10;  // apart from the start's
  if (calibration_.budget.draft_runs == 0) return;
  Requests requests;
  for (std::size_t i = 0; i < ledger_.sites().size(); ++i) {
    const Site& site = ledger_.sites()[i];
    if (site.searched.empty() || static_cast<int>(requests.size()) >= plan_.start) continue;
    requests.push_back({i, site.searched.front().replicate, Level::draft});
  }
  ledger_.run("draft", requests);
  if (std::ranges::none_of(learn_draft_help(ledger_), &DraftHelp::proven)) return;
  requests.clear();
  for (const UnitPoint& point :
       spread_design(ledger_.space(),
                     static_cast<std::size_t>(calibration_.budget.draft_runs),
                     calibration_.seed,
                     draft_design)) {
    requests.push_back({ledger_.site_at(point), 0, Level::draft});
  }
  ledger_.run("draft", requests);
}

/// Fresh seeds at the point whose single run came closest, for the scatter.
void Search::replicate() {
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < ledger_.sites().size(); ++i) {
    const Site& site = ledger_.sites()[i];
    if (site.searched.empty() || !site.searched.front().succeeded) continue;
    if (!ledger_.space().allows(site.at)) continue;
    const double q = misfit(calibration_.measurements, site.searched.front().values);
    if (q < smallest) {
      smallest = q;
      base_ = i;
    }
  }
  Requests requests;
  const std::vector<int> freedom = ledger_.scatter(Level::search).freedom;
  if (*std::ranges::min_element(freedom) >= plan_.replicates) return;  // the scatter is known
  const int first = ledger_.fresh_replicate(base_);
  const int count = std::min(plan_.replicates, ledger_.remaining());
  for (int r = 0; r < count; ++r) requests.push_back({base_, first + r, Level::search});
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
  targets_ = targets_of(calibration_, offset_);
  if (!by_baseline()) {
    std::vector<UnitPoint> starts;
    if (!recommended_.empty()) starts.push_back(recommended_);
    recommended_ = recommend(outlook(), starts);
  }
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
  if (by_baseline()) return plan_.confirm;
  return std::max(plan_.confirm, plan_.confirm < 4 ? 0 : confirming_replicates(ledger_));
}

/// Runs that a search does not spend: once it has had two rounds, those of a second confirmation
/// too, should the first belie what was recommended. Not while nothing seems to fit: whether that is
/// so takes another round.
int Search::kept_back() const {
  const int twice = 2 * plan_.confirm;
  const bool second =
      rounds_ >= least_rounds && implausible_rounds_ == 0 && ledger_.remaining() >= twice;
  return second ? std::max(reserve(), twice) : reserve();
}

/// The one of a point's site, moved to the end; a new one has no runs.
Confirmation& Search::confirmation_of(const UnitPoint& point) {
  const std::size_t site = ledger_.site_at(point);
  const auto found = std::ranges::find(confirmations_, site, &Confirmation::site);
  if (found == confirmations_.end()) {
    confirmations_.push_back({site, {}, predict(point)});
  } else {
    std::rotate(found, found + 1, confirmations_.end());
  }
  return confirmations_.back();
}

/// Fresh replicates of the recommended point, no more of them once they cannot be a hit. True if
/// they are one, together with those that the point had before.
bool Search::confirm() {
  const UnitPoint point = by_baseline() ? recommended_ : settle(outlook(), recommended_);
  Confirmation& confirmation = confirmation_of(point);
  base_ = confirmation.site;
  const int at_a_time = std::max(plan_.confirm, calibration_.budget.batch);
  int left = std::min(reserve(), ledger_.remaining());
  while (left > 0 && !stop_.stop_requested()) {
    Requests requests;
    const int first = ledger_.fresh_replicate(confirmation.site);
    for (int r = 0; r < std::min(at_a_time, left); ++r) {
      requests.push_back({confirmation.site, first + r, Level::confirm});
    }
    std::ranges::move(ledger_.run("confirm", requests), std::back_inserter(confirmation.runs));
    if (!may_be_hit(ledger_, confirmation.runs)) break;
    left -= at_a_time;
  }
  report("confirm");
  return is_hit(ledger_, confirmation.runs);
}

/// The last of the budget: what is recommended is confirmed, and what the emulator recommends having
/// learnt from that.
StopReason Search::close() {
  while (confirmations_.empty() || ledger_.remaining() >= plan_.confirm) {
    if (confirm()) return StopReason::hit;
    if (stop_.stop_requested()) break;
    learn();
  }
  return StopReason::budget;
}

/// Of the points confirmed, the one whose runs came closest; null if there is none.
const Confirmation* Search::best_confirmed() const {
  const auto shown = [this](const Confirmation& each) {
    Fit fit;
    fill_predictions(outlook(), each, fit);
    return fit.misfit;
  };
  const auto best = std::ranges::min_element(confirmations_, {}, shown);
  return best == confirmations_.end() ? nullptr : &*best;
}

/// A reason to stop searching, if the emulator sees one; it is to be confirmed.
std::optional<StopReason> Search::verdict() {
  if (ledger_.remaining() < reserve()) return std::nullopt;
  const UnitPoint point = settle(outlook(), recommended_);
  if (probability_of_hit(outlook(), point, reserve()) > 0.5) return StopReason::hit;
  if (rounds_ < least_rounds && !calibration_.free.empty()) return std::nullopt;
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
  const double best = expected_misfit(outlook(), recommended_);
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
    progress.misfit = expected_misfit(outlook(), recommended_);
    for (const Belief& belief : predict(recommended_)) progress.predicted.push_back(belief.mean);
    progress.z = standardised_residuals(calibration_.measurements, progress.predicted);
    progress.best = ledger_.space().at(recommended_);
  }
  observer_(progress);
}

/// Without an emulator: the smallest misfit of a single run.
void Search::report_baseline(const BaselineSearch& search) {
  for (HistoryPoint& point : ledger_.history()) {
    if (std::isnan(point.best)) point.best = search.smallest();
  }
  if (!observer_) return;
  observer_({"search",
             ledger_.spent(),
             calibration_.budget.evaluations,
             search.smallest(),
             {},
             {},
             ledger_.space().at(search.recommended())});
}

Fit Search::finish(StopReason reason) {
  // Whatever was about to be concluded, runs that were cut short are no evidence of it.
  if (stop_.stop_requested() && reason != StopReason::hit) reason = StopReason::cancelled;
  if (!surrogate_) {
    Fit fit = failure(ledger_, "The search was cancelled before anything was learnt.");
    fit.stop = reason;
    return fit;
  }
  learn();  // the confirming runs too
  if (reason == StopReason::cancelled) confirmations_.clear();
  const Confirmation* confirmed =
      reason == StopReason::hit ? &confirmations_.back() : best_confirmed();
  const UnitPoint best = confirmed ? ledger_.sites()[confirmed->site].at : recommended_;
  Fit fit;
  fit.best = ledger_.space().at(best);
  fit.stop = reason;
  fit.evaluations = ledger_.spent();
  fit.failed = ledger_.failed();
  fit.offset = offset_.value;
  for (const double variance : offset_.variance) fit.offset_error.push_back(std::sqrt(variance));
  fill_predictions(outlook(), confirmed ? *confirmed : Confirmation{0, {}, predict(best)}, fit);
  fill_parameters(outlook(), best, fit);
  fit.history = ledger_.history();
  fit.remarks = remarks(outlook(), fit);
  report("confirm");
  return fit;
}

}  // namespace

Fit calibrate(const Calibration& calibration,
              const Evaluator& evaluator,
              const CalibrateOptions& options) {
  return Search(calibration, evaluator, options).run();
}

}  // namespace repose::calibrator
