#include "server/service_state.hpp"

#include <exception>
#include <system_error>
#include <utility>

#include "calibrator/probe.hpp"
#include "db/attempt_store.hpp"
#include "db/schedule_store.hpp"
#include "server/jobs/clock.hpp"
#include "server/json/calibration_json.hpp"
#include "server/json/fit_json.hpp"
#include "server/missing_effect.hpp"
#include "server/nightly/continuation.hpp"
#include "server/nightly/nights.hpp"
#include "server/webhooks/deliver.hpp"

namespace repose::server {

using calibrator::Calibration;
using calibrator::Fit;

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

Service::State::State(const ServiceOptions& options)
    : store(open_store(options)),
      worker_options{.workers = options.workers,
                     .program = options.program,
                     .time_limit = options.evaluation_time_limit,
                     .memory_limit = options.evaluation_memory_limit},
      clock(options.clock),
      webhook_hosts(options.webhook_hosts) {
  if (options.read_only) return;
  // What ran when the last process ended runs no more.
  store.requeue_all();
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
  night_watch.emplace(std::chrono::seconds(15),
                      [this](const std::stop_token& stop) { look_for_nights(stop); });
  post = post_to_public(webhook_hosts);
  stranded_watch.emplace(std::chrono::seconds(1), [this](const std::stop_token&) {
    failures.run("the look for jobs that wait", [this] { take_up_stranded(); });
  });
  webhook_watch.emplace(std::chrono::seconds(1), [this](const std::stop_token& stop) {
    failures.run("the look for webhooks",
                 [&] { deliver_due(store, post, microseconds_now, stop, failures); });
  });
}

/// What the clock asks for. A night that was cut off after its calibration is ended here too.
void Service::State::look_for_nights(const std::stop_token& stop) {
  // Where the store fails (a full disk) the next look may find it well again.
  failures.run("the look for nights", [&] {
    for (const std::int64_t id : begin_nights(store, Begin::due, clock(), failures)) {
      scheduler->submit({Job::Kind::calibration, id});
    }
    const std::unique_lock hold(nights, std::try_to_lock);
    if (hold.owns_lock()) end_nights(stop);
  });
}

/// The diagnoses that nights wait for are jobs as any other: they wait their turn, and can be
/// cancelled.
void Service::State::end_nights(const std::stop_token& stop) {
  for (const std::int64_t id : server::end_nights(store, worker_options, stop, clock(), failures)) {
    scheduler->submit({Job::Kind::diagnosis, id});
  }
}

/// Takes up jobs that a failing store or host has cut off.
void Service::State::take_up_stranded() {
  std::set<Job> found;
  {
    const std::scoped_lock hold(mutex);
    found = stranded;
  }
  for (const Job& job : found) {
    if (job.kind == Job::Kind::calibration) {
      store.requeue(job.id);
    } else {
      store.requeue_diagnosis(job.id);
    }
    {
      // Before it runs: then it may strand again.
      const std::scoped_lock hold(mutex);
      stranded.erase(job);
    }
    if (!scheduler->submit(job)) strand(job);  // it is still on its way out: then the next time
  }
}

void Service::State::strand(const Job& job) {
  const std::scoped_lock hold(mutex);
  stranded.insert(job);
}

JobQueue::Cancelled Service::State::cancel(const Job& job) {
  {
    // Before the job is asked to stop, so that it knows why.
    const std::scoped_lock hold(mutex);
    cancelled.insert(job);
  }
  const auto where = scheduler ? scheduler->cancel(job) : JobQueue::Cancelled::unknown;
  if (where != JobQueue::Cancelled::running) take_cancel(job);
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
  const auto leave = [&] {
    if (take_cancel({Job::Kind::calibration, id})) {
      store.finish(id, "cancelled", {}, {}, {}, microseconds_now());
    } else {
      store.requeue(id);  // the process ends, or the host fails, not the question
    }
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
  } catch (const db::Error&) {
    throw;  // the store fails, not the calibration
  } catch (const HostFailure&) {
    leave();
    throw;
  } catch (const std::exception& problem) {
    take_cancel({Job::Kind::calibration, id});
    store.finish(id, "failed", {}, {}, problem.what(), microseconds_now());
    return;
  }
  if (interrupted) leave();
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
  const bool calibrates = job.kind == Job::Kind::calibration;
  const std::string name = (calibrates ? "calibration " : "diagnosis ") + std::to_string(job.id);
  const bool ran = failures.run(name, [&] {
    if (calibrates) {
      run_calibration(job.id, stop);
    } else {
      run_diagnosis(job.id, stop, {});
    }
    const std::scoped_lock hold(nights);
    end_nights(stop);
  });
  // The store itself fails (a full disk), or the host: the row stays as it is, and is taken up when
  // it can be.
  if (!ran) strand(job);
}

std::vector<ListedFit> Service::State::listed(std::vector<db::FitRecord> records) {
  const auto in_force = db::ScheduleStore(store).in_force();
  std::vector<ListedFit> fits;
  for (db::FitRecord& record : records) {
    const std::int64_t id = record.calibration.id;
    const auto schedules = in_force.find(id);
    fits.push_back({std::move(record),
                    fit_qualities.of(store, id),
                    schedules == in_force.end() ? std::vector<std::int64_t>{} : schedules->second});
  }
  return fits;
}

}  // namespace repose::server
