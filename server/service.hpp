/// Service: the use cases. No HTTP words, no SQL words: documents in, documents (JSON text) out.
/// The command line and the HTTP API call the same functions.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>

#include "calibrator/calibrate.hpp"
#include "calibrator/diagnosis/diagnosis.hpp"
#include "engine/result.hpp"
#include "server/json/problem.hpp"

namespace repose::server {

/// Why a request was not carried out.
struct Refusal {
  enum class Kind { invalid, not_found, wrong_state };
  Kind kind = Kind::invalid;
  std::string message;
  Problems problems;  ///< of an invalid request: all of them
};

template <class T>
using Answer = engine::Result<T, Refusal>;

struct ServiceOptions {
  std::filesystem::path database;  ///< the file; made when missing
  unsigned workers = 0;            ///< evaluations at once; 0: one per core
  /// Program started as `PROGRAM answer` for each evaluation, question on its standard input,
  /// answer on its standard output. Empty: evaluations run in this process (tests).
  std::filesystem::path program;
  double evaluation_time_limit = 3600.0;  ///< s of wall time
  bool read_only = false;                 ///< look only: works while another process writes
  bool run_jobs = false;                  ///< start the queued calibrations in the background
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

class Service {
 public:
  /// Opens or makes the database, takes its lock, migrates it. Throws db::Error with a clear
  /// message.
  explicit Service(const ServiceOptions& options);
  ~Service();
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;

  /// Queues a calibration; the answer is its document (id, state, ...).
  Answer<std::string> submit(std::string_view study);

  /// Runs a calibration here and now (or takes up an unfinished one with the same study); the
  /// answer is its document.
  Answer<std::string> calibrate(std::string_view study,
                                const std::stop_token& stop,
                                const CalibrationEvents& events);

  /// {"id","name","state","created_at","started_at","finished_at","study","progress","fit","error"}
  [[nodiscard]] Answer<std::string> calibration(std::int64_t id) const;
  /// {"items":[...without study and fit...],"next":cursor|null}, newest first
  [[nodiscard]] std::string calibrations(int limit, std::optional<std::int64_t> before) const;
  /// {"items":[{"key","ordinal","question","answer"}...],"next"}, in the order of work
  [[nodiscard]] Answer<std::string> evaluations(std::int64_t calibration,
                                                int limit,
                                                std::optional<std::int64_t> after) const;
  /// {"items":[{"calibration","name","material","misfit","best",...}]}: the best finished fit of
  /// every study name, or of one.
  [[nodiscard]] std::string best_fits(const std::optional<std::string>& name) const;
  Answer<std::string> cancel(std::int64_t id);

  // The missing effect: see server/missing_effect.hpp.
  [[nodiscard]] Answer<std::string> compare(std::int64_t id,
                                            const calibrator::Tolerances& stated) const;
  Answer<std::string> diagnose(std::int64_t id,
                               const calibrator::Tolerances& stated,
                               const std::stop_token& stop,
                               const DiagnosisEvents& events);
  [[nodiscard]] Answer<std::string> diagnosis(std::int64_t id) const;
  [[nodiscard]] Answer<std::string> diagnoses(std::int64_t calibration) const;
  [[nodiscard]] Answer<std::string> extension_study(std::int64_t id,
                                                    const std::string& effect) const;

  /// One virtual experiment, `replicates` seeds from `seed` on; stored like any other evaluation.
  std::vector<engine::Evaluation> evaluate(const engine::Trial& trial, int replicates);

  /// {"status","database","engine_version","jobs":{state: count}}
  [[nodiscard]] std::string health() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace repose::server
