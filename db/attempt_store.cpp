#include "db/attempt_store.hpp"

#include "db/store_state.hpp"

namespace repose::db {

std::int64_t AttemptStore::begin(const std::string& key,
                                 std::string_view executor,
                                 std::int64_t now) {
  const std::scoped_lock hold(store_.state_->mutex);
  Statement row = store_.state_->connection.prepare(
      "INSERT INTO attempt (key, n, executor, state, started_at) "
      "SELECT ?1, coalesce(max(n) + 1, 0), ?2, 'running', ?3 FROM attempt WHERE key = ?1 "
      "RETURNING n");
  row.bind(std::string_view(key)).bind(executor).bind(now);
  row.step();
  const std::int64_t number = row.integer(0);
  row.step();  // to its end, which commits it
  return number;
}

AttemptStore::Accepted AttemptStore::accept(std::int64_t number,
                                            const EvaluationRecord& answer,
                                            std::int64_t now) {
  const std::scoped_lock hold(store_.state_->mutex);
  Transaction transaction(store_.state_->connection);
  const auto stored = store_.evaluation(answer.key);
  const bool other = stored && stored->answer != answer.answer;
  if (!end(answer.key,
           number,
           other ? "refused" : "answered",
           other ? "answered otherwise than before" : "",
           now)) {
    return Accepted::too_late;
  }
  if (!stored) store_.add_evaluation(answer);
  transaction.commit();
  if (other) return Accepted::other;
  return stored ? Accepted::equal : Accepted::kept;
}

bool AttemptStore::end(const std::string& key,
                       std::int64_t number,
                       std::string_view state,
                       std::string_view account,
                       std::int64_t now) {
  const std::scoped_lock hold(store_.state_->mutex);
  store_.state_->connection
      .prepare(
          "UPDATE attempt SET state = ?, account = ?, finished_at = ? "
          "WHERE key = ? AND n = ? AND state = 'running'")
      .bind(state)
      .bind(account)
      .bind(now)
      .bind(std::string_view(key))
      .bind(number)
      .run();
  return store_.state_->connection.changes() == 1;
}

std::int64_t AttemptStore::lose_all(std::int64_t now) {
  const std::scoped_lock hold(store_.state_->mutex);
  store_.state_->connection
      .prepare(
          "UPDATE attempt SET state = 'lost', account = 'the service ended first', "
          "finished_at = ? WHERE state = 'running'")
      .bind(now)
      .run();
  return store_.state_->connection.changes();
}

std::vector<AttemptRecord> AttemptStore::of(const std::string& key) const {
  const std::scoped_lock hold(store_.state_->mutex);
  Statement row = store_.state_->connection.prepare(
      "SELECT key, n, executor, state, started_at, finished_at, account FROM attempt "
      "WHERE key = ? ORDER BY n");
  row.bind(std::string_view(key));
  std::vector<AttemptRecord> records;
  while (row.step()) {
    records.push_back({row.text(0),
                       row.integer(1),
                       row.text(2),
                       row.text(3),
                       row.integer(4),
                       row.integer_or_null(5),
                       row.text(6)});
  }
  return records;
}

std::map<std::string, std::int64_t> AttemptStore::totals() const {
  const std::scoped_lock hold(store_.state_->mutex);
  Statement row = store_.state_->connection.prepare("SELECT state, attempts FROM attempt_total");
  std::map<std::string, std::int64_t> totals;
  while (row.step()) totals[row.text(0)] = row.integer(1);
  return totals;
}

}  // namespace repose::db
