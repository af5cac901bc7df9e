/// Store: the verbs. Every verb is one transaction: it happens wholly or, with a db::Error, not at
/// all. Safe to call from several threads.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "db/record.hpp"

namespace repose::db {

/// Something the store could not do; the text says what, where and what to do.
class Error : public std::runtime_error {
 public:
  Error(int code, const std::string& text) : std::runtime_error(text), code_(code) {}
  [[nodiscard]] int code() const {
    return code_;
  }  ///< SQLite's extended code; 0 where it is not its

 private:
  int code_;
};

enum class Access {
  write,  ///< makes, locks and migrates the file: one process at a time
  read,   ///< looks only; the file must be there
};

/// Throws db::Error where the file is of another program, or of a newer one of this. What is older,
/// or empty, becomes a database when it is opened to be written.
void check_file(const std::filesystem::path& database);

class Store {
 public:
  Store(const std::filesystem::path& file, Access access);
  ~Store();
  Store(Store&&) noexcept;
  Store& operator=(Store&&) noexcept;

  [[nodiscard]] const std::filesystem::path& file() const;

  // Calibrations. `now` is microseconds since 1970 UTC.
  std::int64_t add_calibration(const std::string& name,
                               const std::string& request,
                               const std::string& digest,
                               std::int64_t now);
  [[nodiscard]] std::optional<CalibrationRecord> calibration(std::int64_t id) const;
  /// Newest first, ids below `before` where given; without request and fit.
  [[nodiscard]] std::vector<CalibrationRecord> calibrations(
      int limit, std::optional<std::int64_t> before) const;
  /// The oldest queued or running one with that request, if any.
  [[nodiscard]] std::optional<CalibrationRecord> unfinished(const std::string& digest) const;
  [[nodiscard]] std::vector<std::int64_t> in_state(std::string_view state) const;  ///< oldest first
  [[nodiscard]] std::map<std::string, std::int64_t> count_by_state() const;

  /// queued -> running; false where it is not queued.
  bool start(std::int64_t id, std::int64_t now);
  /// running -> queued.
  bool requeue(std::int64_t id);
  /// Every running one -> queued: after a restart nothing runs.
  void requeue_all();
  void set_progress(std::int64_t id, const std::string& progress);
  /// queued or running -> done, failed or cancelled; false where it was final already.
  bool finish(std::int64_t id,
              std::string_view state,
              const std::optional<std::string>& fit,
              const std::optional<double>& misfit,
              const std::optional<std::string>& error,
              std::int64_t now);

  /// The calibrations that add an effect to that one, oldest first.
  [[nodiscard]] std::vector<CalibrationRecord> children(std::int64_t calibration) const;

  // Diagnoses of finished calibrations.
  std::int64_t add_diagnosis(std::int64_t calibration,
                             const std::string& request,
                             std::int64_t now);
  [[nodiscard]] std::optional<DiagnosisRecord> diagnosis(std::int64_t id) const;
  /// All of a calibration, newest first.
  [[nodiscard]] std::vector<DiagnosisRecord> diagnoses(std::int64_t calibration) const;
  /// The oldest queued or running one of that calibration with that request, if any.
  [[nodiscard]] std::optional<DiagnosisRecord> unfinished_diagnosis(
      std::int64_t calibration, const std::string& request) const;
  [[nodiscard]] std::vector<std::int64_t> queued_diagnoses() const;  ///< oldest first
  bool start_diagnosis(std::int64_t id);                             ///< as start()
  bool requeue_diagnosis(std::int64_t id);                           ///< as requeue()
  void set_diagnosis_progress(std::int64_t id, const std::string& progress);
  /// queued or running -> done, failed or cancelled; false where it was final already.
  bool finish_diagnosis(std::int64_t id,
                        std::string_view state,
                        const std::optional<std::string>& result,
                        const std::optional<std::string>& error,
                        std::int64_t now);
  void note_used_by_diagnosis(std::int64_t diagnosis,
                              std::int64_t first_ordinal,
                              const std::vector<std::string>& keys);
  [[nodiscard]] std::vector<UsedEvaluation> used_by_diagnosis(std::int64_t diagnosis) const;

  // Evaluations.
  [[nodiscard]] std::optional<EvaluationRecord> evaluation(const std::string& key) const;
  /// Keeps an answer; one that is there already stays. True where it was new.
  bool add_evaluation(const EvaluationRecord& evaluation);
  /// All of an engine that were kept before a time, in the order of keeping.
  [[nodiscard]] std::vector<EvaluationRecord> evaluations_before(const std::string& engine_version,
                                                                 std::int64_t time) const;
  /// Notes which evaluations a calibration used, in order, in place of any noted from there on.
  void note_used(std::int64_t calibration,
                 std::int64_t first_ordinal,
                 const std::vector<std::string>& keys);
  [[nodiscard]] std::vector<UsedEvaluation> used(std::int64_t calibration,
                                                 int limit,
                                                 std::optional<std::int64_t> after) const;

 private:
  friend class AttemptStore;      // db/attempt_store.hpp
  friend class EventStore;        // db/event_store.hpp
  friend class MaterialStore;     // db/material_store.hpp
  friend class MeasurementStore;  // db/measurement_store.hpp
  friend class ReplyStore;        // db/reply_store.hpp
  friend struct Inspection;       // db/figures.cpp
  friend class ScheduleStore;     // db/schedule_store.hpp
  friend class WebhookStore;      // db/webhook_store.hpp
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace repose::db
