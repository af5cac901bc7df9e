#include "server/nightly/continuation.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "calibrator/known_runs.hpp"
#include "db/schedule_store.hpp"
#include "engine/evaluate.hpp"
#include "server/json/calibration_json.hpp"
#include "server/json/evaluation_json.hpp"
#include "server/json/fit_json.hpp"
#include "server/json/schedule_json.hpp"
#include "server/missing_effect.hpp"

namespace repose::server {

using calibrator::Calibration;
using calibrator::KnownRun;
using calibrator::Published;
using calibrator::Recheck;

namespace {

constexpr std::size_t most_of_one_set = 8;  // replicates say little more

/// The latest runs, in their order: of one set not more than say something new, and not more sets
/// than an emulator of so many parameters is worth its time.
std::vector<KnownRun> thinned(std::vector<KnownRun> runs, std::size_t most_sets) {
  std::vector<std::pair<engine::ParameterSet, std::size_t>> counts;
  std::vector<KnownRun> kept;
  for (auto run = runs.rbegin(); run != runs.rend(); ++run) {
    auto count = std::ranges::find(
        counts, run->parameters, &std::pair<engine::ParameterSet, std::size_t>::first);
    if (count == counts.end()) {
      if (counts.size() >= most_sets) continue;
      count = counts.insert(count, {run->parameters, 0});
    }
    if (count->second++ < most_of_one_set) kept.push_back(std::move(*run));
  }
  std::ranges::reverse(kept);
  return kept;
}

std::vector<KnownRun> runs_known(const db::Store& store,
                                 const Calibration& calibration,
                                 const Continuation& continuation) {
  std::vector<engine::Evaluation> evaluations;
  for (const std::int64_t id : continuation.runs_of) {
    for (const auto& used : store.used(id, std::numeric_limits<int>::max(), std::nullopt)) {
      if (used.evaluation.engine_version != engine::version()) continue;
      const auto trial = parse_trial(used.evaluation.question);
      if (trial) evaluations.push_back(parse_answer(*trial, used.evaluation.answer));
    }
  }
  return thinned(calibrator::known_runs(calibration, evaluations),
                 10 * (calibration.free.size() + 1));
}

}  // namespace

std::optional<Continuation> continuation_of(const db::Store& store, std::int64_t calibration) {
  const auto night = db::ScheduleStore(store).night_of(calibration);
  if (!night || !night->incumbent) return std::nullopt;
  return Continuation{*night->incumbent, parse_ids(night->continues.value_or("[]"))};
}

std::optional<Published> published(const db::Store& store, std::int64_t calibration) {
  const auto record = store.calibration(calibration);
  if (!record || record->state != "done" || !record->fit) return std::nullopt;
  auto question = parse_calibration(record->request);
  if (!question) return std::nullopt;
  auto fit = parse_fit(*question, *record->fit);
  if (!fit) return std::nullopt;
  return Published{*std::move(question), *std::move(fit)};
}

std::optional<Recheck> recheck_published(const db::Store& store,
                                         const Calibration& calibration,
                                         const Continuation& continuation,
                                         const calibrator::Evaluator& evaluator) {
  const auto incumbent = published(store, continuation.calibration);
  if (!incumbent) return std::nullopt;
  const calibrator::SearchSpace space(calibration);
  if (!calibrator::has_set(space, incumbent->fit.best)) return std::nullopt;
  return calibrator::recheck(
      calibration, *incumbent, evaluator, runs_known(store, calibration, continuation));
}

calibrator::Fit calibrate_from_store(const db::Store& store,
                                     std::int64_t id,
                                     const Calibration& calibration,
                                     const calibrator::Evaluator& evaluator,
                                     calibrator::CalibrateOptions options) {
  const auto continuation = continuation_of(store, id);
  if (!continuation) {
    const auto known = inherited_runs(store, calibration, store.calibration(id)->created_at);
    options.known = known;
    return calibrator::calibrate(calibration, evaluator, options);
  }
  const auto check = recheck_published(store, calibration, *continuation, evaluator);
  if (check && check->passed) return check->fit;
  auto known = runs_known(store, calibration, *continuation);
  if (check) known.insert(known.end(), check->runs.begin(), check->runs.end());
  options.known = known;
  auto fit = calibrator::calibrate(calibration, evaluator, options);
  if (check) fit.evaluations += check->fit.evaluations;
  return fit;
}

}  // namespace repose::server
