#include "db/store_state.hpp"

namespace repose::db {

EvaluationRecord evaluation_of(const Statement& row, int first) {
  return {row.text(first),
          row.text(first + 1),
          row.text(first + 2),
          row.real(first + 3),
          row.text(first + 4),
          row.integer(first + 5)};
}

std::vector<std::int64_t> Store::State::in_state(const std::string& table, std::string_view state) {
  const std::scoped_lock hold(mutex);
  Statement row = connection.prepare("SELECT id FROM " + table + " WHERE state = ? ORDER BY id");
  row.bind(state);
  std::vector<std::int64_t> ids;
  while (row.step()) ids.push_back(row.integer(0));
  return ids;
}

bool Store::State::requeue(const std::string& table, std::int64_t id) {
  const std::scoped_lock hold(mutex);
  connection.prepare("UPDATE " + table + " SET state = 'queued' WHERE id = ? AND state = 'running'")
      .bind(id)
      .run();
  return connection.changes() == 1;
}

void Store::State::set_progress(const std::string& table,
                                std::int64_t id,
                                const std::string& progress) {
  const std::scoped_lock hold(mutex);
  connection
      .prepare("UPDATE " + table +
               " SET progress = ? WHERE id = ? AND state IN ('queued', 'running')")
      .bind(std::string_view(progress))
      .bind(id)
      .run();
}

void Store::State::note_used(const std::string& table,
                             std::int64_t owner,
                             std::int64_t first_ordinal,
                             const std::vector<std::string>& keys) {
  const std::scoped_lock hold(mutex);
  const std::string used = table + "_evaluation", id = table + "_id";
  Transaction transaction(connection);
  connection.prepare("DELETE FROM " + used + " WHERE " + id + " = ? AND ordinal >= ?")
      .bind(owner)
      .bind(first_ordinal)
      .run();
  Statement insert =
      connection.prepare("INSERT INTO " + used + " (" + id + ", ordinal, key) VALUES (?, ?, ?)");
  std::int64_t ordinal = first_ordinal;
  for (const std::string& key : keys) {
    insert.bind(owner).bind(ordinal++).bind(std::string_view(key)).run();
  }
  transaction.commit();
}

std::vector<UsedEvaluation> Store::State::used(const std::string& table,
                                               std::int64_t owner,
                                               int limit,
                                               std::int64_t after) {
  const std::scoped_lock hold(mutex);
  Statement row = connection.prepare(
      "SELECT u.ordinal, e.key, e.question, e.answer, e.seconds, e.engine_version, e.created_at "
      "FROM " +
      table + "_evaluation u JOIN evaluation e ON e.key = u.key WHERE u." + table +
      "_id = ?1 AND u.ordinal > ?2 ORDER BY u.ordinal LIMIT ?3");
  row.bind(owner).bind(after).bind(static_cast<std::int64_t>(limit));
  std::vector<UsedEvaluation> result;
  while (row.step()) result.push_back({row.integer(0), evaluation_of(row, 1)});
  return result;
}

}  // namespace repose::db
