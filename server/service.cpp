#include "server/service.hpp"

#include <chrono>
#include <exception>
#include <iostream>
#include <mutex>
#include <set>
#include <utility>

#include "db/event_store.hpp"
#include "db/material_store.hpp"
#include "db/store.hpp"
#include "engine/evaluate.hpp"
#include "server/access/secret.hpp"
#include "server/jobs/clock.hpp"
#include "server/jobs/scheduler.hpp"
#include "server/jobs/workers.hpp"
#include "server/json/calibration_json.hpp"
#include "server/json/evaluation_json.hpp"
#include "server/json/event_json.hpp"
#include "server/json/fit_json.hpp"
#include "server/json/job_json.hpp"
#include "server/json/measurement_set_json.hpp"
#include "server/json/own_material_json.hpp"
#include "server/measurements.hpp"
#include "server/missing_effect.hpp"
#include "server/own_materials.hpp"

namespace repose::server {

using calibrator::Calibration;
using calibrator::Fit;
using engine::Unexpected;

namespace {

db::Store open_store(const ServiceOptions& options) {
  const auto folder = options.database.parent_path();
  if (!options.read_only && !folder.empty()) {
    std::error_code problem;
    std::filesystem::create_directories(folder, problem);
    if (problem) {
      throw db::Error(0, "cannot make the folder " + folder.string() + ": " + problem.message());
    }
  }
  return {options.database, options.read_only ? db::Access::read : db::Access::write};
}

Refusal not_found(std::int64_t id) {
  return {Refusal::Kind::not_found, "there is no calibration " + std::to_string(id), {}};
}

/// Lets a progress document through about once a second.
class Pace {
 public:
  bool due() {
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < std::chrono::seconds(1)) return false;
    last_ = now;
    return true;
  }

 private:
  std::chrono::steady_clock::time_point last_{};
};

}  // namespace

struct Service::State {
  explicit State(const ServiceOptions& options)
      : store(open_store(options)),
        worker_options{.workers = options.workers,
                       .program = options.program,
                       .time_limit = options.evaluation_time_limit} {
    if (options.read_only) return;
    store.requeue_all();  // what ran when the last process ended runs no more
    if (!options.run_jobs) return;
    scheduler = std::make_unique<Scheduler>(
        [this](std::int64_t id, const std::stop_token& stop) { run_job(id, stop); });
    for (const std::int64_t id : store.in_state("queued")) scheduler->submit(id);
  }

  void run_job(std::int64_t id, const std::stop_token& stop);
  void run(std::int64_t id,
           const Calibration& calibration,
           const std::stop_token& stop,
           const CalibrationEvents& events);
  void conclude(std::int64_t id, const Calibration& calibration, const Fit& fit);
  bool take_cancel(std::int64_t id);

  db::Store store;
  WorkerOptions worker_options;
  std::mutex mutex;
  std::optional<std::chrono::steady_clock::time_point> probed;  ///< when ready() looked last
  bool writable = false;                                        ///< as it found then
  std::set<std::int64_t> cancelled;      ///< running ones that a user has cancelled
  std::unique_ptr<Scheduler> scheduler;  // last: its thread uses all of the above
};

bool Service::State::take_cancel(std::int64_t id) {
  const std::scoped_lock hold(mutex);
  return cancelled.erase(id) > 0;
}

void Service::State::conclude(std::int64_t id, const Calibration& calibration, const Fit& fit) {
  const bool failed = fit.stop == calibrator::StopReason::failed;
  std::optional<std::string> error;
  if (failed) error = fit.remarks.empty() ? "the calibration failed" : fit.remarks.front();
  store.finish(id,
               failed ? "failed" : "done",
               print_fit(calibration, fit),
               failed ? std::nullopt : std::optional(fit.misfit),
               error,
               microseconds_now());
}

/// Runs a calibration that is in the state running, and leaves it in the state it has come to.
void Service::State::run(std::int64_t id,
                         const Calibration& calibration,
                         const std::stop_token& stop,
                         const CalibrationEvents& events) {
  Workers workers(store, worker_options);
  std::int64_t ordinal = 0;
  bool interrupted = false;
  Pace pace;
  const calibrator::Evaluator evaluator = [&](std::span<const engine::Trial> trials) {
    auto evaluations = workers.run(trials, stop, events.trial);
    // An interrupted batch has gaps; it is noted when it has been run to its end.
    if (!workers.interrupted()) store.note_used(id, ordinal, workers.used());
    ordinal += static_cast<std::int64_t>(workers.used().size());
    interrupted |= workers.interrupted();
    return evaluations;
  };
  std::optional<calibrator::Progress> last;
  const auto observer = [&](const calibrator::Progress& progress) {
    last = progress;
    if (pace.due()) store.set_progress(id, print_progress(calibration, progress));
    if (events.progress) events.progress(progress);
  };
  try {
    const auto known = inherited_runs(store, calibration);
    const Fit fit = calibrator::calibrate(calibration, evaluator, stop, observer, known);
    if (last) store.set_progress(id, print_progress(calibration, *last));
    // A fit that lacks evaluations because of a stop is no fit.
    interrupted |= stop.stop_requested() || fit.stop == calibrator::StopReason::cancelled;
    if (!interrupted) conclude(id, calibration, fit);
  } catch (const std::exception& problem) {
    take_cancel(id);
    store.finish(id, "failed", {}, {}, problem.what(), microseconds_now());
    return;
  }
  if (!interrupted) return;
  if (take_cancel(id)) {
    store.finish(id, "cancelled", {}, {}, {}, microseconds_now());
  } else {
    store.requeue(id);  // the process ends, not the question
  }
}

void Service::State::run_job(std::int64_t id, const std::stop_token& stop) {
  try {
    const auto record = store.calibration(id);
    if (!record || !store.start(id, microseconds_now())) return;
    const auto calibration = parse_calibration(record->request);
    if (!calibration) {
      store.finish(id, "failed", {}, {}, calibration.error().front().message, microseconds_now());
      return;
    }
    run(id, *calibration, stop, {});
  } catch (const std::exception&) {
    // The store itself fails (a full disk): the row stays as it is, and the next start takes it up.
    return;
  }
}

Service::Service(const ServiceOptions& options) : state_(std::make_unique<State>(options)) {}
Service::~Service() = default;

namespace {

/// The study's canonical document, or what is wrong with it.
Answer<Calibration> read_study(std::string_view study) {
  auto parsed = parse_calibration(study);
  if (parsed) return std::move(parsed).value();
  return Unexpected{Refusal{Refusal::Kind::invalid,
                            "the study has " + std::to_string(parsed.error().size()) +
                                (parsed.error().size() == 1 ? " problem" : " problems"),
                            parsed.error()}};
}

}  // namespace

Answer<std::string> Service::submit(std::string_view study) {
  const auto submission = resolve_submission(state_->store, study);
  if (!submission) return Unexpected{submission.error()};
  const auto calibration = read_study(submission->study);
  if (!calibration) return Unexpected{calibration.error()};
  const std::string request = print_calibration(*calibration);
  const std::int64_t id =
      db::MeasurementStore(state_->store)
          .add_calibration(
              calibration->name, request, digest(request), submission->source, microseconds_now());
  if (state_->scheduler) state_->scheduler->submit(id);
  return this->calibration(id);
}

Answer<std::string> Service::calibrate(std::string_view study,
                                       const std::stop_token& stop,
                                       const CalibrationEvents& events) {
  const auto calibration = read_study(study);
  if (!calibration) return Unexpected{calibration.error()};
  const std::string request = print_calibration(*calibration);
  const auto unfinished = state_->store.unfinished(digest(request));
  const std::int64_t id =
      unfinished ? unfinished->id
                 : state_->store.add_calibration(
                       calibration->name, request, digest(request), microseconds_now());
  if (!state_->store.start(id, microseconds_now())) {
    return Unexpected{Refusal{Refusal::Kind::wrong_state,
                              "calibration " + std::to_string(id) + " is running already",
                              {}}};
  }
  state_->run(id, *calibration, stop, events);
  return this->calibration(id);
}

Answer<std::string> Service::calibration(std::int64_t id) const {
  const auto record = state_->store.calibration(id);
  if (!record) return Unexpected{not_found(id)};
  return print_job(*record);
}

std::string Service::calibrations(int limit, std::optional<std::int64_t> before) const {
  return print_jobs(state_->store.calibrations(limit, before), limit);
}

Answer<std::string> Service::evaluations(std::int64_t calibration,
                                         int limit,
                                         std::optional<std::int64_t> after) const {
  if (!state_->store.calibration(calibration)) return Unexpected{not_found(calibration)};
  return print_used(state_->store.used(calibration, limit, after), limit);
}

std::string Service::best_fits(const std::optional<std::string>& name) const {
  return print_best_fits(state_->store.best_fits(name));
}

Answer<std::string> Service::cancel(std::int64_t id) {
  const auto record = state_->store.calibration(id);
  if (!record) return Unexpected{not_found(id)};
  const auto final = [&]() -> Answer<std::string> {
    return Unexpected{Refusal{Refusal::Kind::wrong_state,
                              "calibration " + std::to_string(id) + " has ended: it is " +
                                  state_->store.calibration(id)->state,
                              {}}};
  };
  if (record->finished_at) return final();
  {
    // Before the job is asked to stop, so that it knows why.
    const std::scoped_lock hold(state_->mutex);
    state_->cancelled.insert(id);
  }
  const auto where =
      state_->scheduler ? state_->scheduler->cancel(id) : Schedule::Cancelled::unknown;
  if (where == Schedule::Cancelled::running) return calibration(id);
  state_->take_cancel(id);
  if (!state_->store.finish(id, "cancelled", {}, {}, {}, microseconds_now())) return final();
  return calibration(id);
}

Answer<std::string> Service::compare(std::int64_t id, const calibrator::Tolerances& stated) const {
  return server::compare(state_->store, id, stated);
}

Answer<std::string> Service::diagnose(std::int64_t id,
                                      const calibrator::Tolerances& stated,
                                      const std::stop_token& stop,
                                      const DiagnosisEvents& events) {
  return server::diagnose(state_->store, state_->worker_options, id, stated, stop, events);
}

Answer<std::string> Service::diagnosis(std::int64_t id) const {
  return server::diagnosis(state_->store, id);
}

Answer<std::string> Service::diagnoses(std::int64_t calibration) const {
  return server::diagnoses(state_->store, calibration);
}

Answer<std::string> Service::extension_study(std::int64_t id, const std::string& effect) const {
  return server::extension_study(state_->store, id, effect);
}

std::vector<engine::Evaluation> Service::evaluate(const engine::Trial& trial, int replicates) {
  std::vector<engine::Trial> trials(static_cast<std::size_t>(replicates), trial);
  for (std::size_t i = 0; i < trials.size(); ++i) trials[i].seed = trial.seed + i;
  Workers workers(state_->store, state_->worker_options);
  return workers.run(trials, {}, {});
}

std::string Service::materials() const {
  return print_all_materials(db::MaterialStore(state_->store).list());
}

Answer<std::string> Service::material(const std::string& name) const {
  return server::material(state_->store, name);
}

Answer<std::string> Service::put_material(const std::string& name,
                                          std::string_view content,
                                          bool may_replace) {
  return server::put_material(state_->store, name, content, may_replace);
}

Answer<std::string> Service::remove_material(const std::string& name) {
  return server::remove_material(state_->store, name);
}

Answer<std::string> Service::put_measurement_set(const std::string& name,
                                                 std::string_view content,
                                                 const std::optional<std::string>& table_of) {
  return server::put_measurement_set(state_->store, name, content, table_of);
}

Answer<std::string> Service::measurement_set(const std::string& name,
                                             const std::optional<std::int64_t>& version,
                                             bool as_table) const {
  return server::measurement_set(state_->store, name, version, as_table);
}

std::string Service::measurement_sets(int limit, const std::optional<std::string>& after) const {
  return print_measurement_sets(db::MeasurementStore(state_->store).list(limit, after), limit);
}

std::string Service::fits(const db::FitFilter& filter, int limit) const {
  return print_fits(db::MeasurementStore(state_->store).fits(filter, limit), limit);
}

Answer<std::string> Service::events(const std::optional<std::int64_t>& calibration,
                                    int limit,
                                    std::int64_t after) const {
  if (calibration && !state_->store.calibration(*calibration)) {
    return Unexpected{not_found(*calibration)};
  }
  return print_events(db::EventStore(state_->store).events(calibration, after, limit), limit);
}

Answer<std::function<std::string()>> Service::event_stream(
    const std::optional<std::int64_t>& calibration,
    const std::optional<std::int64_t>& after) const {
  if (calibration && !state_->store.calibration(*calibration)) {
    return Unexpected{not_found(*calibration)};
  }
  const db::EventStore store(state_->store);
  const std::int64_t start = after ? *after : store.newest();
  return std::function([store, calibration, last = start]() mutable -> std::string {
    constexpr int page = 100;
    if (store.newest() <= last) return {};
    const auto events = store.events(calibration, last, page);
    if (!events.empty()) last = events.back().id;
    return print_event_stream(events);
  });
}

std::optional<db::KeptReply> Service::once(
    const std::string& key,
    const std::string& request_digest,
    const std::function<std::optional<std::string>()>& work) {
  constexpr std::int64_t day = 24LL * 3600 * 1'000'000;  // microseconds
  const std::int64_t now = microseconds_now();
  db::ReplyStore replies(state_->store);
  replies.forget(now - day);
  return replies.once(key, request_digest, now, work);
}

bool Service::ready() {
  const std::scoped_lock hold(state_->mutex);
  const auto now = std::chrono::steady_clock::now();
  if (state_->probed && now - *state_->probed < std::chrono::seconds(1)) return state_->writable;
  state_->probed = now;
  try {
    db::probe(state_->store);
    state_->writable = true;
  } catch (const db::Error& error) {
    std::clog << std::string("repose: not ready: ") + error.what() + "\n";
    state_->writable = false;
  }
  return state_->writable;
}

ServiceFigures Service::figures() const {
  return {.engine_version = std::string(engine::version()),
          .jobs = state_->store.count_by_state(),
          .store = db::figures(state_->store)};
}

std::string Service::health() const {
  return print_health(state_->store.file().string(), state_->store.count_by_state());
}

}  // namespace repose::server
