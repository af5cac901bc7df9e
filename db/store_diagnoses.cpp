#include <limits>

#include "db/store_state.hpp"

namespace repose::db {

namespace {

constexpr std::string_view diagnosis_columns =
    "id, calibration_id, state, created_at, finished_at, request, progress, result, error";

DiagnosisRecord diagnosis_of(const Statement& row) {
  return {row.integer(0),
          row.integer(1),
          row.text(2),
          row.integer(3),
          row.integer_or_null(4),
          row.text(5),
          row.text_or_null(6),
          row.text_or_null(7),
          row.text_or_null(8)};
}

}  // namespace

std::int64_t Store::add_diagnosis(std::int64_t calibration,
                                  const std::string& request,
                                  std::int64_t now) {
  const std::scoped_lock hold(state_->mutex);
  state_->connection
      .prepare(
          "INSERT INTO diagnosis (calibration_id, state, created_at, request) "
          "VALUES (?, 'queued', ?, ?)")
      .bind(calibration)
      .bind(now)
      .bind(std::string_view(request))
      .run();
  return state_->connection.last_id();
}

std::optional<DiagnosisRecord> Store::diagnosis(std::int64_t id) const {
  const std::scoped_lock hold(state_->mutex);
  Statement row = state_->connection.prepare("SELECT " + std::string(diagnosis_columns) +
                                             " FROM diagnosis WHERE id = ?");
  row.bind(id);
  if (!row.step()) return std::nullopt;
  return diagnosis_of(row);
}

std::vector<DiagnosisRecord> Store::diagnoses(std::int64_t calibration) const {
  const std::scoped_lock hold(state_->mutex);
  Statement row =
      state_->connection.prepare("SELECT " + std::string(diagnosis_columns) +
                                 " FROM diagnosis WHERE calibration_id = ? ORDER BY id DESC");
  row.bind(calibration);
  std::vector<DiagnosisRecord> records;
  while (row.step()) records.push_back(diagnosis_of(row));
  return records;
}

std::optional<DiagnosisRecord> Store::unfinished_diagnosis(std::int64_t calibration,
                                                           const std::string& request) const {
  const std::scoped_lock hold(state_->mutex);
  Statement row =
      state_->connection.prepare("SELECT " + std::string(diagnosis_columns) +
                                 " FROM diagnosis WHERE calibration_id = ? AND request = ? "
                                 "AND state IN ('queued', 'running') ORDER BY id LIMIT 1");
  row.bind(calibration).bind(std::string_view(request));
  if (!row.step()) return std::nullopt;
  return diagnosis_of(row);
}

std::vector<std::int64_t> Store::queued_diagnoses() const {
  return state_->in_state("diagnosis", "queued");
}

bool Store::start_diagnosis(std::int64_t id) {
  const std::scoped_lock hold(state_->mutex);
  state_->connection
      .prepare("UPDATE diagnosis SET state = 'running' WHERE id = ? AND state = 'queued'")
      .bind(id)
      .run();
  return state_->connection.changes() == 1;
}

bool Store::requeue_diagnosis(std::int64_t id) { return state_->requeue("diagnosis", id); }

void Store::set_diagnosis_progress(std::int64_t id, const std::string& progress) {
  state_->set_progress("diagnosis", id, progress);
}

bool Store::finish_diagnosis(std::int64_t id,
                             std::string_view state,
                             const std::optional<std::string>& result,
                             const std::optional<std::string>& error,
                             std::int64_t now) {
  const std::scoped_lock hold(state_->mutex);
  state_->connection
      .prepare(
          "UPDATE diagnosis SET state = ?, result = ?, error = ?, finished_at = ? "
          "WHERE id = ? AND state IN ('queued', 'running')")
      .bind(state)
      .bind(result)
      .bind(error)
      .bind(now)
      .bind(id)
      .run();
  return state_->connection.changes() == 1;
}

void Store::note_used_by_diagnosis(std::int64_t diagnosis,
                                   std::int64_t first_ordinal,
                                   const std::vector<std::string>& keys) {
  state_->note_used("diagnosis", diagnosis, first_ordinal, keys);
}

std::vector<UsedEvaluation> Store::used_by_diagnosis(std::int64_t diagnosis) const {
  return state_->used("diagnosis", diagnosis, std::numeric_limits<int>::max(), -1);
}

}  // namespace repose::db
