/// Service: the use cases. No HTTP words, no SQL words: documents in, documents (JSON text) out.
/// The command line and the HTTP API call the same functions.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "calibrator/calibrate.hpp"
#include "calibrator/diagnosis/diagnosis.hpp"
#include "db/figures.hpp"
#include "db/measurement_store.hpp"
#include "db/reply_store.hpp"
#include "db/webhook_store.hpp"
#include "engine/result.hpp"
#include "server/jobs/clock.hpp"
#include "server/json/page.hpp"
#include "server/json/problem.hpp"

namespace repose::server {

/// Why a request was not carried out.
struct Refusal {
  /// unconditional: it would replace something that the request does not name
  enum class Kind { invalid, not_found, wrong_state, unconditional };
  Kind kind = Kind::invalid;
  std::string message;
  Problems problems;  ///< of an invalid request: all of them
};

/// `what` has problems.
Refusal invalid(std::string_view what, Problems problems);
/// There is no `what` of that number.
Refusal not_found(std::string_view what, std::int64_t id);

template <class T>
using Answer = engine::Result<T, Refusal>;

struct ServiceOptions {
  std::filesystem::path database;  ///< the file; made when missing
  unsigned workers = 0;            ///< evaluations at once; 0: one per core
  /// Program started as `PROGRAM answer` for each evaluation, question on its standard input,
  /// answer on its standard output. Empty: evaluations run in this process (tests).
  std::filesystem::path program;
  double evaluation_time_limit = 3600.0;  ///< s of wall time
  /// Bytes that the process of one evaluation may have; 0: any.
  std::uint64_t evaluation_memory_limit = std::uint64_t{8} << 30U;
  bool read_only = false;  ///< look only: works while another process writes
  bool run_jobs = false;   ///< start the queued calibrations in the background, and tell webhooks
  std::vector<std::string> webhook_hosts =
      {};  ///< that are not public, and may be told all the same
  /// Microseconds since 1970 UTC, for what the clock starts.
  std::function<std::int64_t()> clock = microseconds_now;
};

/// What happens while a calibration runs in the foreground.
struct CalibrationEvents {
  calibrator::ProgressObserver progress;
  /// After each trial of a batch: done and all of the batch, and whether the store had it.
  std::function<void(std::size_t done, std::size_t all, bool stored)> trial;
};

/// What happens while a diagnosis runs in the foreground.
struct DiagnosisEvents {
  calibrator::DiagnosisObserver progress;
  /// After each trial of a batch: done and all of the batch, and whether the store had it.
  std::function<void(std::size_t done, std::size_t all, bool stored)> trial;
};

/// Where the control chart of a quantity stands after its schedule's last night.
struct DriftFigure {
  std::int64_t schedule = 0;
  std::string quantity;
  double level = 0.0;  ///< see server/nightly/drift.hpp
  double limit = 0.0;
};

/// For those who watch the service.
struct ServiceFigures {
  std::string engine_version;
  std::map<std::string, std::int64_t> jobs;      ///< calibrations by state
  std::map<std::string, std::int64_t> attempts;  ///< at evaluations, by how they ended
  db::Figures store;
  db::WebhookFigures webhooks;
  std::int64_t drift_alarms = 0;
  std::vector<DriftFigure> drift;
};

class Service {
 public:
  /// Opens or makes the database, takes its lock, migrates it. Throws db::Error with a clear
  /// message.
  explicit Service(const ServiceOptions& options);
  ~Service();
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;

  /// Queues a calibration; the answer is its document (id, state, ...). Beside its own members a
  /// study may have "material" and "measurement_set": {"name", "version"} in place of measurements.
  Answer<std::string> submit(std::string_view study);

  /// What submit() would calibrate: the study with the grain and the measurements that it names.
  [[nodiscard]] Answer<std::string> study(std::string_view submission) const;

  /// Runs a calibration here and now (or takes up an unfinished one with the same study, which may
  /// name what submit() takes); the answer is its document.
  Answer<std::string> calibrate(std::string_view study,
                                const std::stop_token& stop,
                                const CalibrationEvents& events);

  /// {"id","name","state","created_at","started_at","finished_at","study","progress","fit","error"}
  [[nodiscard]] Answer<std::string> calibration(std::int64_t id) const;
  /// {"items":[...without study and fit...],"next":cursor|null}, newest first
  [[nodiscard]] Page calibrations(int limit, std::optional<std::int64_t> before) const;
  /// {"items":[{"key","ordinal","question","answer"}...],"next"}, in the order of work
  [[nodiscard]] Answer<Page> evaluations(std::int64_t calibration,
                                         int limit,
                                         std::optional<std::int64_t> after) const;
  /// {"items":[{"calibration","name","material","misfit","best",...}]}: the best finished fit of
  /// every study's name and material.
  [[nodiscard]] std::string best_fits(const db::FitFilter& filter) const;
  Answer<std::string> cancel(std::int64_t id);

  // The missing effect: see server/missing_effect.hpp.
  [[nodiscard]] Answer<std::string> compare(std::int64_t id,
                                            const calibrator::Tolerances& stated) const;
  Answer<std::string> diagnose(std::int64_t id,
                               const calibrator::Tolerances& stated,
                               const std::stop_token& stop,
                               const DiagnosisEvents& events);
  /// Queues a diagnosis of a finished calibration; the answer is its document. `request`:
  /// {"tolerances"}.
  Answer<std::string> submit_diagnosis(std::int64_t calibration, std::string_view request);
  [[nodiscard]] Answer<std::string> diagnosis(std::int64_t id) const;
  [[nodiscard]] Answer<std::string> diagnoses(std::int64_t calibration) const;
  Answer<std::string> cancel_diagnosis(std::int64_t id);
  [[nodiscard]] Answer<std::string> extension_study(
      std::int64_t id,
      const std::string& effect,
      std::optional<std::int64_t> diagnosis = std::nullopt) const;
  /// Queues the calibration that adds an effect to that one's model; the answer is its document.
  /// `request`: {"effect", "diagnosis"}.
  Answer<std::string> extend(std::int64_t id, std::string_view request);
  /// {"asked","items":[...]}: the calibrations that come from the same one, parents first.
  [[nodiscard]] Answer<std::string> lineage(std::int64_t id) const;

  // Materials, published and of users: see server/own_materials.hpp.
  [[nodiscard]] std::string materials() const;
  [[nodiscard]] Answer<std::string> material(const std::string& name) const;
  Answer<std::string> put_material(const std::string& name,
                                   std::string_view content,
                                   bool may_replace);
  Answer<std::string> remove_material(const std::string& name);

  // Measurements that users keep, and the fits of a material: see server/measurements.hpp.
  Answer<std::string> put_measurement_set(const std::string& name,
                                          std::string_view content,
                                          const std::optional<std::string>& table_of);
  [[nodiscard]] Answer<std::string> measurement_set(const std::string& name,
                                                    const std::optional<std::int64_t>& version,
                                                    bool as_table) const;
  /// {"items":[{"name","version","material","created_at"}],"next"}, the newest versions by name
  [[nodiscard]] Page measurement_sets(int limit, const std::optional<std::string>& after) const;
  /// {"items":[{"calibration","quality","in_force","parameters","not_determined","best",
  /// "provenance",...}],"next"}, newest first
  [[nodiscard]] Page fits(const db::FitFilter& filter, int limit) const;

  // Events: what happened to a calibration, or to all, in order.
  /// {"items":[{"id","created_at","kind","data"}],"next"}, oldest first
  [[nodiscard]] Answer<Page> events(const std::optional<std::int64_t>& calibration,
                                    int limit,
                                    std::int64_t after) const;
  /// A source of server-sent events from that number on, the latest where none is given; it lives
  /// as long as the service.
  [[nodiscard]] Answer<std::function<std::string()>> event_stream(
      const std::optional<std::int64_t>& calibration,
      const std::optional<std::int64_t>& after) const;

  /// The fit of a finished calibration for other programs; `format` is one of export_format_names.
  [[nodiscard]] Answer<std::string> export_fit(std::int64_t id, std::string_view format) const;

  // Addresses that are told of events: see server/webhooks.hpp.
  Answer<std::string> add_webhook(std::string_view content);
  Answer<std::string> replace_webhook(std::int64_t id, std::string_view content);
  Answer<std::string> remove_webhook(std::int64_t id);
  [[nodiscard]] Answer<std::string> webhook(std::int64_t id) const;
  [[nodiscard]] std::string webhooks() const;

  // Schedules: see server/schedules.hpp, and server/nightly/ for what a night does.
  Answer<std::string> add_schedule(std::string_view document);
  Answer<std::string> replace_schedule(std::int64_t id, std::string_view document);
  Answer<std::string> remove_schedule(std::int64_t id);
  [[nodiscard]] Answer<std::string> schedule(std::int64_t id) const;
  [[nodiscard]] std::string schedules() const;
  [[nodiscard]] Answer<Page> nights(std::int64_t schedule,
                                    int limit,
                                    std::optional<std::int64_t> before) const;
  [[nodiscard]] Answer<std::string> promotions(std::int64_t schedule) const;
  Answer<std::string> promote(std::int64_t schedule, std::string_view document);
  /// Runs the nights that are due (or one of every schedule) here and now.
  void run_nights(bool all, const std::stop_token& stop, const CalibrationEvents& events);

  /// One virtual experiment, `replicates` seeds from `seed` on; stored like any other evaluation.
  std::vector<engine::Evaluation> evaluate(const engine::Trial& trial, int replicates);

  /// Does something once for each key: see db/reply_store.hpp.
  std::optional<db::KeptReply> once(const std::string& key,
                                    const std::string& request_digest,
                                    const std::function<std::optional<std::string>()>& work);

  /// Whether the store can be written: looks at most once a second.
  bool ready();
  [[nodiscard]] ServiceFigures figures() const;

  /// {"status","database","engine_version","jobs":{state: count}}
  [[nodiscard]] std::string health() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace repose::server
