#include "server/service.hpp"

#include <chrono>
#include <exception>
#include <iostream>
#include <mutex>
#include <set>
#include <utility>

#include "calibrator/probe.hpp"
#include "db/attempt_store.hpp"
#include "db/event_store.hpp"
#include "db/material_store.hpp"
#include "db/store.hpp"
#include "engine/evaluate.hpp"
#include "server/access/secret.hpp"
#include "server/exports/export_fit.hpp"
#include "server/jobs/clock.hpp"
#include "server/jobs/scheduler.hpp"
#include "server/jobs/workers.hpp"
#include "server/json/calibration_json.hpp"
#include "server/json/evaluation_json.hpp"
#include "server/json/event_json.hpp"
#include "server/json/fit_json.hpp"
#include "server/json/job_json.hpp"
#include "server/json/measurement_set_json.hpp"
#include "server/json/missing_effect_request.hpp"
#include "server/json/own_material_json.hpp"
#include "server/lineage.hpp"
#include "server/measurements.hpp"
#include "server/missing_effect.hpp"
#include "server/nightly/continuation.hpp"
#include "server/nightly/night_watch.hpp"
#include "server/nightly/nights.hpp"
#include "server/own_materials.hpp"
#include "server/schedules.hpp"

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
                       .time_limit = options.evaluation_time_limit,
                       .memory_limit = options.evaluation_memory_limit},
        clock(options.clock) {
    if (options.read_only) return;
    store.requeue_all();  // what ran when the last process ended runs no more
    db::AttemptStore(store).lose_all(microseconds_now());
    if (!options.run_jobs) return;
    scheduler = std::make_unique<Scheduler>(
        [this](const Job& job, const std::stop_token& stop) { run_job(job, stop); });
    for (const std::int64_t id : store.in_state("queued")) {
      scheduler->submit({Job::Kind::calibration, id});
    }
    for (const std::int64_t id : store.queued_diagnoses()) {
      scheduler->submit({Job::Kind::diagnosis, id});
    }
    watch = std::make_unique<NightWatch>([this](const std::stop_token& stop) { look(stop); });
  }

  void run_job(const Job& job, const std::stop_token& stop);
  void run_calibration(std::int64_t id, const std::stop_token& stop);
  void run_diagnosis(std::int64_t id, const std::stop_token& stop, const DiagnosisEvents& events);
  void run(std::int64_t id,
           const Calibration& calibration,
           const std::stop_token& stop,
           const CalibrationEvents& events);
  bool refuse_unfelt(std::int64_t id,
                     const Calibration& calibration,
                     Workers& workers,
                     const std::stop_token& stop);
  void conclude(std::int64_t id, const Calibration& calibration, const Fit& fit);
  void look(const std::stop_token& stop);
  /// Takes a job that a user cancels from the queue, or asks it to stop where it runs.
  Schedule::Cancelled cancel(const Job& job);
  bool take_cancel(const Job& job);

  db::Store store;
  WorkerOptions worker_options;
  std::function<std::int64_t()> clock;
  std::mutex mutex;
  std::optional<std::chrono::steady_clock::time_point> probed;  ///< when ready() looked last
  bool writable = false;                                        ///< as it found then
  std::mutex nights;                                            ///< held while nights are ended
  std::set<Job> cancelled;               ///< running ones that a user has cancelled
  std::unique_ptr<Scheduler> scheduler;  // its thread uses all of the above
  std::unique_ptr<NightWatch> watch;     // last: its thread uses the scheduler too
};

/// What the clock asks for. A night that was cut off after its calibration is ended here too.
void Service::State::look(const std::stop_token& stop) {
  try {
    for (const std::int64_t id : begin_nights(store, Begin::due, clock())) {
      scheduler->submit({Job::Kind::calibration, id});
    }
    const std::unique_lock hold(nights, std::try_to_lock);
    if (hold.owns_lock()) end_nights(store, worker_options, stop, clock());
  } catch (const std::exception&) {
    // The store fails (a full disk): the next look may find it well again.
    return;
  }
}

Schedule::Cancelled Service::State::cancel(const Job& job) {
  {
    // Before the job is asked to stop, so that it knows why.
    const std::scoped_lock hold(mutex);
    cancelled.insert(job);
  }
  const auto where = scheduler ? scheduler->cancel(job) : Schedule::Cancelled::unknown;
  if (where != Schedule::Cancelled::running) take_cancel(job);
  return where;
}

bool Service::State::take_cancel(const Job& job) {
  const std::scoped_lock hold(mutex);
  return cancelled.erase(job) > 0;
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

/// Fails a calibration whose free parameters no measurement feels. True if it did.
bool Service::State::refuse_unfelt(std::int64_t id,
                                   const Calibration& calibration,
                                   Workers& workers,
                                   const std::stop_token& stop) {
  const auto unfelt = calibrator::unfelt_parameters(
      calibration,
      [&](std::span<const engine::Trial> trials) { return workers.run(trials, stop, {}); });
  if (unfelt.empty() || stop.stop_requested()) return false;
  std::string names;
  for (const std::size_t k : unfelt) {
    names += (names.empty() ? "" : ", ") + engine::to_string(calibration.free[k].key);
  }
  take_cancel({Job::Kind::calibration, id});
  store.finish(id,
               "failed",
               {},
               {},
               "no measurement feels " + names +
                   ": from bound to bound the experiments come out equal to the last bit; fix " +
                   (unfelt.size() == 1 ? "it" : "them") + " or add a measurement that does",
               microseconds_now());
  return true;
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
    if (refuse_unfelt(id, calibration, workers, stop)) return;
    const Fit fit = calibrate_from_store(
        store, id, calibration, evaluator, {.stop = stop, .observer = observer, .meter = [&] {
                                              return workers.spent();
                                            }});
    if (last) store.set_progress(id, print_progress(calibration, *last));
    // A fit that lacks evaluations because of a stop is no fit.
    interrupted |= stop.stop_requested() || fit.stop == calibrator::StopReason::cancelled;
    if (!interrupted) conclude(id, calibration, fit);
  } catch (const std::exception& problem) {
    take_cancel({Job::Kind::calibration, id});
    store.finish(id, "failed", {}, {}, problem.what(), microseconds_now());
    return;
  }
  if (!interrupted) return;
  if (take_cancel({Job::Kind::calibration, id})) {
    store.finish(id, "cancelled", {}, {}, {}, microseconds_now());
  } else {
    store.requeue(id);  // the process ends, not the question
  }
}

void Service::State::run_calibration(std::int64_t id, const std::stop_token& stop) {
  const auto record = store.calibration(id);
  if (!record || !store.start(id, microseconds_now())) return;
  const auto calibration = parse_calibration(record->request);
  if (!calibration) {
    store.finish(id, "failed", {}, {}, calibration.error().front().message, microseconds_now());
    return;
  }
  run(id, *calibration, stop, {});
}

/// Runs a diagnosis that is queued, and leaves it in the state it has come to.
void Service::State::run_diagnosis(std::int64_t id,
                                   const std::stop_token& stop,
                                   const DiagnosisEvents& events) {
  if (!store.start_diagnosis(id)) return;
  const bool ended = server::run_diagnosis(store, worker_options, id, stop, events);
  const bool unwanted = take_cancel({Job::Kind::diagnosis, id});
  if (ended) return;
  if (unwanted) {
    store.finish_diagnosis(id, "cancelled", {}, {}, microseconds_now());
  } else {
    store.requeue_diagnosis(id);  // the process ends, not the question
  }
}

void Service::State::run_job(const Job& job, const std::stop_token& stop) {
  try {
    if (job.kind == Job::Kind::calibration) {
      run_calibration(job.id, stop);
    } else {
      run_diagnosis(job.id, stop, {});
    }
    const std::scoped_lock hold(nights);
    end_nights(store, worker_options, stop, clock());
  } catch (const std::exception&) {
    // The store itself fails (a full disk): the row stays as it is, and the next start takes it up.
    return;
  }
}

Service::Service(const ServiceOptions& options) : state_(std::make_unique<State>(options)) {}
Service::~Service() = default;

namespace {

Refusal invalid(const std::string& what, const Problems& problems) {
  return {Refusal::Kind::invalid,
          what + " has " + std::to_string(problems.size()) +
              (problems.size() == 1 ? " problem" : " problems"),
          problems};
}

/// The study's canonical document, or what is wrong with it.
Answer<Calibration> read_study(std::string_view study) {
  auto parsed = parse_calibration(study);
  if (parsed) return std::move(parsed).value();
  return Unexpected{invalid("the study", parsed.error())};
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
  if (state_->scheduler) state_->scheduler->submit({Job::Kind::calibration, id});
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
  const auto where = state_->cancel({Job::Kind::calibration, id});
  if (where == Schedule::Cancelled::running) return calibration(id);
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
  const auto diagnosis_id = queue_diagnosis(state_->store, id, stated);
  if (!diagnosis_id) return Unexpected{diagnosis_id.error()};
  state_->run_diagnosis(*diagnosis_id, stop, events);
  return diagnosis(*diagnosis_id);
}

Answer<std::string> Service::submit_diagnosis(std::int64_t calibration, std::string_view request) {
  const auto stated = parse_diagnosis_request(request);
  if (!stated) return Unexpected{invalid("the request", stated.error())};
  const auto id = queue_diagnosis(state_->store, calibration, *stated);
  if (!id) return Unexpected{id.error()};
  if (state_->scheduler) state_->scheduler->submit({Job::Kind::diagnosis, *id});
  return diagnosis(*id);
}

Answer<std::string> Service::cancel_diagnosis(std::int64_t id) {
  const auto record = state_->store.diagnosis(id);
  if (!record) return diagnosis(id);
  const auto ended = [&](const std::string& state) -> Answer<std::string> {
    return Unexpected{Refusal{Refusal::Kind::wrong_state,
                              "diagnosis " + std::to_string(id) + " has ended: it is " + state,
                              {}}};
  };
  if (record->finished_at) return ended(record->state);
  const auto where = state_->cancel({Job::Kind::diagnosis, id});
  if (where != Schedule::Cancelled::running &&
      !state_->store.finish_diagnosis(id, "cancelled", {}, {}, microseconds_now())) {
    return ended(state_->store.diagnosis(id)->state);
  }
  return diagnosis(id);
}

Answer<std::string> Service::diagnosis(std::int64_t id) const {
  return server::diagnosis(state_->store, id);
}

Answer<std::string> Service::diagnoses(std::int64_t calibration) const {
  return server::diagnoses(state_->store, calibration);
}

Answer<std::string> Service::extension_study(std::int64_t id,
                                             const std::string& effect,
                                             std::optional<std::int64_t> diagnosis) const {
  return server::extension_study(state_->store, id, effect, diagnosis);
}

Answer<std::string> Service::extend(std::int64_t id, std::string_view request) {
  const auto wanted = parse_extension_request(request);
  if (!wanted) return Unexpected{invalid("the request", wanted.error())};
  const auto study = extension_study(id, wanted->effect, wanted->diagnosis);
  return study ? submit(*study) : study;
}

Answer<std::string> Service::lineage(std::int64_t id) const {
  return server::lineage(state_->store, id);
}

Answer<std::string> Service::export_fit(std::int64_t id, std::string_view format) const {
  return server::export_fit(state_->store, id, format);
}

Answer<std::string> Service::add_schedule(std::string_view document) {
  return server::add_schedule(state_->store, document, state_->clock());
}

Answer<std::string> Service::replace_schedule(std::int64_t id, std::string_view document) {
  return server::replace_schedule(state_->store, id, document, state_->clock());
}

Answer<std::string> Service::remove_schedule(std::int64_t id) {
  return server::remove_schedule(state_->store, id, state_->clock());
}

Answer<std::string> Service::schedule(std::int64_t id) const {
  return server::schedule(state_->store, id, state_->clock());
}

std::string Service::schedules() const { return server::schedules(state_->store, state_->clock()); }

Answer<std::string> Service::nights(std::int64_t schedule,
                                    int limit,
                                    std::optional<std::int64_t> before) const {
  return server::nights(state_->store, schedule, limit, before);
}

Answer<std::string> Service::promotions(std::int64_t schedule) const {
  return server::promotions(state_->store, schedule);
}

Answer<std::string> Service::promote(std::int64_t schedule, std::string_view document) {
  return server::promote(state_->store, schedule, document, state_->clock());
}

void Service::run_nights(bool all, const std::stop_token& stop, const CalibrationEvents& events) {
  const Begin which = all ? Begin::all : Begin::due;
  for (const std::int64_t id : begin_nights(state_->store, which, state_->clock())) {
    const auto record = state_->store.calibration(id);
    const auto calibration = parse_calibration(record->request);
    if (!calibration || !state_->store.start(id, microseconds_now())) continue;
    state_->run(id, *calibration, stop, events);
    if (stop.stop_requested()) return;
  }
  end_nights(state_->store, state_->worker_options, stop, state_->clock());
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
          .attempts = db::AttemptStore(state_->store).totals(),
          .store = db::figures(state_->store)};
}

std::string Service::health() const {
  return print_health(state_->store.file().string(), state_->store.count_by_state());
}

}  // namespace repose::server
