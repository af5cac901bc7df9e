/// The inside of the service: its store, and what runs in the background.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <vector>

#include "calibrator/calibration.hpp"
#include "calibrator/fit.hpp"
#include "db/store.hpp"
#include "server/fit_qualities.hpp"
#include "server/jobs/failure_log.hpp"
#include "server/jobs/scheduler.hpp"
#include "server/jobs/watch.hpp"
#include "server/jobs/workers.hpp"
#include "server/json/fit_list_json.hpp"
#include "server/service.hpp"
#include "server/webhooks/post.hpp"

namespace repose::server {

/// Whether the store could be written at the last look.
struct Readiness {
  std::mutex mutex;  ///< as State's: never held while the store works
  std::optional<std::chrono::steady_clock::time_point> looked;
  bool writable = true;  ///< it has been opened
};

struct Service::State {
  explicit State(const ServiceOptions& options);

  void run_job(const Job& job, const std::stop_token& stop);
  void run_calibration(std::int64_t id, const std::stop_token& stop);
  void run_diagnosis(std::int64_t id, const std::stop_token& stop, const DiagnosisEvents& events);
  void run(std::int64_t id,
           const calibrator::Calibration& calibration,
           const std::stop_token& stop,
           const CalibrationEvents& events);
  bool refuse_unfelt(std::int64_t id,
                     const calibrator::Calibration& calibration,
                     Workers& workers,
                     const std::stop_token& stop);
  void conclude(std::int64_t id,
                const calibrator::Calibration& calibration,
                const calibrator::Fit& fit);
  void look_for_nights(const std::stop_token& stop);
  void end_nights(const std::stop_token& stop);
  void take_up_stranded();
  /// Takes a job that a user cancels from the queue, or asks it to stop where it runs.
  JobQueue::Cancelled cancel(const Job& job);
  bool take_cancel(const Job& job);
  void strand(const Job& job);
  /// With what is known of each beside its row.
  std::vector<ListedFit> listed(std::vector<db::FitRecord> records);

  db::Store store;
  WorkerOptions worker_options;
  std::function<std::int64_t()> clock;
  std::vector<std::string> webhook_hosts;
  Post post;
  Readiness readiness;
  FailureLog failures;
  FitQualities fit_qualities;
  std::mutex nights;  ///< held while nights are ended
  /// Of the two sets, and held for nothing but a look or a change: a request may hold the store's
  /// when it comes here, so who holds this one must not wait for the store.
  std::mutex mutex;
  std::set<Job> cancelled;               ///< running ones that a user has cancelled
  std::set<Job> stranded;                ///< that store or host failed in the middle of
  std::unique_ptr<Scheduler> scheduler;  // its thread uses all of the above
  std::optional<Watch> night_watch;      // their threads use the scheduler too
  std::optional<Watch> stranded_watch;
  std::optional<Watch> webhook_watch;
};

}  // namespace repose::server
