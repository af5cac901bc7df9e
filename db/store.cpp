#include "db/store.hpp"

#include <limits>

#include "db/backup.hpp"
#include "db/migrate.hpp"
#include "db/store_state.hpp"

namespace repose::db {

namespace {

constexpr std::string_view calibration_columns =
    "id, name, state, created_at, started_at, finished_at, request_digest, progress, misfit, error";

CalibrationRecord without_documents(const Statement& row) {
  CalibrationRecord record;
  record.id = row.integer(0);
  record.name = row.text(1);
  record.state = row.text(2);
  record.created_at = row.integer(3);
  record.started_at = row.integer_or_null(4);
  record.finished_at = row.integer_or_null(5);
  record.request_digest = row.text(6);
  record.progress = row.text_or_null(7);
  record.misfit = row.real_or_null(8);
  record.error = row.text_or_null(9);
  return record;
}

CalibrationRecord with_documents(const Statement& row) {
  CalibrationRecord record = without_documents(row);
  record.request = row.text(10);
  record.fit = row.text_or_null(11);
  return record;
}

std::string select_calibration(bool documents, std::string_view rest) {
  return "SELECT " + std::string(calibration_columns) + (documents ? ", request, fit" : "") +
         " FROM calibration " + std::string(rest);
}

/// A damaged file is not written to.
void quick_check(Connection& connection) {
  Statement row = connection.prepare("PRAGMA quick_check(1)");
  if (row.step() && row.text(0) == "ok") return;
  throw Error(0,
              "database " + connection.file().string() + " is damaged (" + row.text(0) +
                  "): `repose doctor` tells how, `repose restore` puts a backup in its place");
}

void set_up(Connection& connection, Access access) {
  connection.run("PRAGMA foreign_keys = ON");
  connection.run("PRAGMA trusted_schema = OFF");
  connection.run("PRAGMA cell_size_check = ON");
  if (access == Access::read) {
    connection.run("PRAGMA query_only = ON");
    check_current(connection);
    return;
  }
  check_schema(connection);  // before anything is written to a file that may not be ours
  connection.run("PRAGMA journal_mode = WAL");
  connection.run("PRAGMA synchronous = FULL");
  quick_check(connection);
  if (is_older(connection)) keep_copy(connection.file());  // the older program reads that one
  migrate(connection);
}

}  // namespace

void check_file(const std::filesystem::path& database) {
  Connection connection(database, Connection::Mode::read);
  check_schema(connection);
}

Store::State::State(const std::filesystem::path& file, Access access)
    : lock(access == Access::write ? std::make_unique<FileLock>(file) : nullptr),
      connection(file, access == Access::write ? Connection::Mode::write : Connection::Mode::read) {
  set_up(connection, access);
}

Store::Store(const std::filesystem::path& file, Access access)
    : state_(std::make_unique<State>(file, access)) {}
Store::~Store() = default;
Store::Store(Store&&) noexcept = default;
Store& Store::operator=(Store&&) noexcept = default;

const std::filesystem::path& Store::file() const { return state_->connection.file(); }

std::int64_t Store::add_calibration(const std::string& name,
                                    const std::string& request,
                                    const std::string& digest,
                                    std::int64_t now) {
  const std::scoped_lock hold(state_->mutex);
  state_->connection
      .prepare(
          "INSERT INTO calibration (name, state, created_at, request, request_digest, parent_id) "
          "VALUES (?1, 'queued', ?2, ?3, ?4, CASE WHEN json_valid(?3) THEN "
          "json_extract(?3, '$.extends.calibration') END)")
      .bind(std::string_view(name))
      .bind(now)
      .bind(std::string_view(request))
      .bind(std::string_view(digest))
      .run();
  return state_->connection.last_id();
}

std::optional<CalibrationRecord> Store::calibration(std::int64_t id) const {
  const std::scoped_lock hold(state_->mutex);
  Statement row = state_->connection.prepare(select_calibration(true, "WHERE id = ?"));
  row.bind(id);
  if (!row.step()) return std::nullopt;
  return with_documents(row);
}

std::vector<CalibrationRecord> Store::calibrations(int limit,
                                                   std::optional<std::int64_t> before) const {
  const std::scoped_lock hold(state_->mutex);
  Statement row = state_->connection.prepare(
      select_calibration(false, "WHERE id < ?1 ORDER BY id DESC LIMIT ?2"));
  row.bind(before.value_or(std::numeric_limits<std::int64_t>::max()))
      .bind(static_cast<std::int64_t>(limit));
  std::vector<CalibrationRecord> records;
  while (row.step()) records.push_back(without_documents(row));
  return records;
}

std::optional<CalibrationRecord> Store::unfinished(const std::string& digest) const {
  const std::scoped_lock hold(state_->mutex);
  Statement row = state_->connection.prepare(
      select_calibration(true,
                         "WHERE request_digest = ? AND state IN ('queued', 'running') "
                         "ORDER BY id LIMIT 1"));
  row.bind(std::string_view(digest));
  if (!row.step()) return std::nullopt;
  return with_documents(row);
}

std::vector<std::int64_t> Store::in_state(std::string_view state) const {
  return state_->in_state("calibration", state);
}

std::vector<CalibrationRecord> Store::children(std::int64_t calibration) const {
  const std::scoped_lock hold(state_->mutex);
  Statement row =
      state_->connection.prepare(select_calibration(true, "WHERE parent_id = ? ORDER BY id"));
  row.bind(calibration);
  std::vector<CalibrationRecord> records;
  while (row.step()) records.push_back(with_documents(row));
  return records;
}

std::map<std::string, std::int64_t> Store::count_by_state() const {
  const std::scoped_lock hold(state_->mutex);
  Statement row =
      state_->connection.prepare("SELECT state, count(*) FROM calibration GROUP BY state");
  std::map<std::string, std::int64_t> counts;
  while (row.step()) counts[row.text(0)] = row.integer(1);
  return counts;
}

bool Store::start(std::int64_t id, std::int64_t now) {
  const std::scoped_lock hold(state_->mutex);
  state_->connection
      .prepare(
          "UPDATE calibration SET state = 'running', started_at = coalesce(started_at, ?) "
          "WHERE id = ? AND state = 'queued'")
      .bind(now)
      .bind(id)
      .run();
  return state_->connection.changes() == 1;
}

bool Store::requeue(std::int64_t id) { return state_->requeue("calibration", id); }

void Store::requeue_all() {
  const std::scoped_lock hold(state_->mutex);
  state_->connection.run("UPDATE calibration SET state = 'queued' WHERE state = 'running'");
  state_->connection.run("UPDATE diagnosis SET state = 'queued' WHERE state = 'running'");
}

void Store::set_progress(std::int64_t id, const std::string& progress) {
  state_->set_progress("calibration", id, progress);
}

bool Store::finish(std::int64_t id,
                   std::string_view state,
                   const std::optional<std::string>& fit,
                   const std::optional<double>& misfit,
                   const std::optional<std::string>& error,
                   std::int64_t now) {
  const std::scoped_lock hold(state_->mutex);
  state_->connection
      .prepare(
          "UPDATE calibration SET state = ?, fit = ?, misfit = ?, error = ?, finished_at = ? "
          "WHERE id = ? AND state IN ('queued', 'running')")
      .bind(state)
      .bind(fit)
      .bind(misfit)
      .bind(error)
      .bind(now)
      .bind(id)
      .run();
  return state_->connection.changes() == 1;
}

std::optional<EvaluationRecord> Store::evaluation(const std::string& key) const {
  const std::scoped_lock hold(state_->mutex);
  Statement row = state_->connection.prepare(
      "SELECT key, question, answer, seconds, engine_version, created_at FROM evaluation "
      "WHERE key = ?");
  row.bind(std::string_view(key));
  if (!row.step()) return std::nullopt;
  return evaluation_of(row, 0);
}

bool Store::add_evaluation(const EvaluationRecord& evaluation) {
  const std::scoped_lock hold(state_->mutex);
  state_->connection
      .prepare(
          "INSERT INTO evaluation (key, question, answer, seconds, engine_version, created_at) "
          "VALUES (?, ?, ?, ?, ?, ?) ON CONFLICT DO NOTHING")
      .bind(std::string_view(evaluation.key))
      .bind(std::string_view(evaluation.question))
      .bind(std::string_view(evaluation.answer))
      .bind(evaluation.seconds)
      .bind(std::string_view(evaluation.engine_version))
      .bind(evaluation.created_at)
      .run();
  return state_->connection.changes() == 1;
}

std::vector<EvaluationRecord> Store::evaluations_before(const std::string& engine_version,
                                                        std::int64_t time) const {
  const std::scoped_lock hold(state_->mutex);
  Statement row = state_->connection.prepare(
      "SELECT key, question, answer, seconds, engine_version, created_at FROM evaluation "
      "WHERE engine_version = ?1 AND created_at < ?2 ORDER BY created_at, key");
  row.bind(std::string_view(engine_version)).bind(time);
  std::vector<EvaluationRecord> result;
  while (row.step()) result.push_back(evaluation_of(row, 0));
  return result;
}

void Store::note_used(std::int64_t calibration,
                      std::int64_t first_ordinal,
                      const std::vector<std::string>& keys) {
  state_->note_used("calibration", calibration, first_ordinal, keys);
}

std::vector<UsedEvaluation> Store::used(std::int64_t calibration,
                                        int limit,
                                        std::optional<std::int64_t> after) const {
  return state_->used("calibration", calibration, limit, after.value_or(-1));
}

}  // namespace repose::db
