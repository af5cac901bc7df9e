#include "db/event_store.hpp"

#include "db/store_state.hpp"

namespace repose::db {

std::vector<EventRecord> EventStore::events(const std::optional<std::int64_t>& calibration,
                                            std::int64_t after,
                                            int limit) const {
  const std::scoped_lock hold(store_.state_->mutex);
  Statement row = store_.state_->connection.prepare(
      std::string(
          "SELECT id, created_at, kind, calibration_id, diagnosis_id, schedule_id, night_id, "
          "name, misfit, error, detail FROM event WHERE ") +
      (calibration ? "calibration_id = ?3 AND " : "") + "id > ?1 ORDER BY id LIMIT ?2");
  row.bind(after).bind(static_cast<std::int64_t>(limit));
  if (calibration) row.bind(*calibration);
  std::vector<EventRecord> events;
  while (row.step()) {
    events.push_back({row.integer(0),
                      row.integer(1),
                      row.text(2),
                      row.integer_or_null(3),
                      row.integer_or_null(4),
                      row.integer_or_null(5),
                      row.integer_or_null(6),
                      row.text_or_null(7),
                      row.real_or_null(8),
                      row.text_or_null(9),
                      row.text_or_null(10)});
  }
  return events;
}

std::int64_t EventStore::newest() const {
  const std::scoped_lock hold(store_.state_->mutex);
  Statement row = store_.state_->connection.prepare("SELECT coalesce(max(id), 0) FROM event");
  row.step();
  return row.integer(0);
}

std::int64_t EventStore::drift_alarms() const {
  const std::scoped_lock hold(store_.state_->mutex);
  Statement row = store_.state_->connection.prepare(
      "SELECT count(*) FROM event WHERE kind = 'night.drift'");  // as its index has it
  row.step();
  return row.integer(0);
}

}  // namespace repose::db
