#include "db/schedule_store.hpp"

#include <limits>

#include "db/store_state.hpp"

namespace repose::db {

namespace {

ScheduleRecord schedule_of(const Statement& row) {
  return {row.integer(0),
          row.text(1),
          row.integer(2),
          row.integer_or_null(3),
          row.integer_or_null(4),
          row.text(5)};
}

NightRecord record_of(const Statement& row) {
  return {row.integer(0),
          row.integer(1),
          row.integer(2),
          row.integer(3),
          row.integer_or_null(4),
          row.text(5),
          row.text_or_null(6),
          row.integer_or_null(7),
          row.integer_or_null(8),
          row.text_or_null(9),
          row.integer_or_null(10),
          row.text_or_null(11)};
}

constexpr std::string_view select_schedule =
    "SELECT id, name, created_at, replaced_at, removed_at, request FROM schedule ";

constexpr std::string_view select_night =
    "SELECT id, schedule_id, planned_at, started_at, finished_at, state, outcome, incumbent_id, "
    "calibration_id, continues, diagnosis_id, result FROM night ";

}  // namespace

std::int64_t ScheduleStore::add(const std::string& name,
                                const std::string& request,
                                std::int64_t now) {
  const std::scoped_lock hold(store_.state_->mutex);
  store_.state_->connection
      .prepare("INSERT INTO schedule (name, created_at, request) VALUES (?, ?, ?)")
      .bind(std::string_view(name))
      .bind(now)
      .bind(std::string_view(request))
      .run();
  return store_.state_->connection.last_id();
}

bool ScheduleStore::replace(std::int64_t id,
                            const std::string& name,
                            const std::string& request,
                            std::int64_t now) {
  const std::scoped_lock hold(store_.state_->mutex);
  store_.state_->connection
      .prepare(
          "UPDATE schedule SET name = ?, request = ?, replaced_at = ? "
          "WHERE id = ? AND removed_at IS NULL")
      .bind(std::string_view(name))
      .bind(std::string_view(request))
      .bind(now)
      .bind(id)
      .run();
  return store_.state_->connection.changes() == 1;
}

bool ScheduleStore::remove(std::int64_t id, std::int64_t now) {
  const std::scoped_lock hold(store_.state_->mutex);
  store_.state_->connection
      .prepare("UPDATE schedule SET removed_at = ? WHERE id = ? AND removed_at IS NULL")
      .bind(now)
      .bind(id)
      .run();
  return store_.state_->connection.changes() == 1;
}

std::optional<ScheduleRecord> ScheduleStore::schedule(std::int64_t id) const {
  const std::scoped_lock hold(store_.state_->mutex);
  Statement row = store_.state_->connection.prepare(std::string(select_schedule) + "WHERE id = ?");
  row.bind(id);
  if (!row.step()) return std::nullopt;
  return schedule_of(row);
}

std::vector<ScheduleRecord> ScheduleStore::schedules() const {
  const std::scoped_lock hold(store_.state_->mutex);
  Statement row = store_.state_->connection.prepare(std::string(select_schedule) +
                                                    "WHERE removed_at IS NULL ORDER BY id");
  std::vector<ScheduleRecord> records;
  while (row.step()) records.push_back(schedule_of(row));
  return records;
}

std::optional<std::int64_t> ScheduleStore::begin_night(std::int64_t schedule,
                                                       std::int64_t planned_at,
                                                       std::int64_t now) {
  const std::scoped_lock hold(store_.state_->mutex);
  Connection& connection = store_.state_->connection;
  connection
      .prepare(
          "INSERT INTO night (schedule_id, planned_at, started_at, state) "
          "VALUES (?, ?, ?, 'running') ON CONFLICT DO NOTHING")
      .bind(schedule)
      .bind(planned_at)
      .bind(now)
      .run();
  if (connection.changes() != 1) return std::nullopt;
  return connection.last_id();
}

void ScheduleStore::set_night_calibration(std::int64_t night,
                                          std::int64_t calibration,
                                          const std::optional<std::int64_t>& incumbent,
                                          const std::optional<std::string>& continues) {
  const std::scoped_lock hold(store_.state_->mutex);
  store_.state_->connection
      .prepare(
          "UPDATE night SET calibration_id = ?, incumbent_id = ?, continues = ? "
          "WHERE id = ? AND state = 'running'")
      .bind(calibration)
      .bind(incumbent)
      .bind(continues)
      .bind(night)
      .run();
}

bool ScheduleStore::end_night(std::int64_t night, const NightEnd& end, std::int64_t now) {
  const std::scoped_lock hold(store_.state_->mutex);
  Connection& connection = store_.state_->connection;
  Transaction transaction(connection);
  connection
      .prepare(
          "UPDATE night SET state = ?, outcome = ?, diagnosis_id = ?, result = ?, finished_at = ? "
          "WHERE id = ? AND state = 'running'")
      .bind(std::string_view(end.state))
      .bind(end.outcome)
      .bind(end.diagnosis)
      .bind(std::string_view(end.result))
      .bind(now)
      .bind(night)
      .run();
  const bool ended = connection.changes() == 1;
  if (ended && !end.promotion.empty()) {
    connection
        .prepare(
            "INSERT INTO promotion (schedule_id, calibration_id, night_id, promoted_at, reason) "
            "SELECT schedule_id, calibration_id, id, ?, ? FROM night WHERE id = ?")
        .bind(now)
        .bind(std::string_view(end.promotion))
        .bind(night)
        .run();
  }
  transaction.commit();
  return ended;
}

std::vector<NightRecord> ScheduleStore::select_nights(std::string_view rest,
                                                      std::optional<std::int64_t> first,
                                                      std::optional<std::int64_t> second,
                                                      int limit) const {
  const std::scoped_lock hold(store_.state_->mutex);
  Statement row = store_.state_->connection.prepare(std::string(select_night) + std::string(rest));
  row.bind(first).bind(second).bind(static_cast<std::int64_t>(limit));
  std::vector<NightRecord> records;
  while (row.step()) records.push_back(record_of(row));
  return records;
}

std::optional<NightRecord> ScheduleStore::night(std::int64_t id) const {
  auto found = select_nights("WHERE id = ?1 AND ?2 IS NULL LIMIT ?3", id, std::nullopt, 1);
  if (found.empty()) return std::nullopt;
  return std::move(found.front());
}

std::optional<NightRecord> ScheduleStore::night_of(std::int64_t calibration) const {
  auto found = select_nights("WHERE calibration_id = ?1 AND ?2 IS NULL ORDER BY id DESC LIMIT ?3",
                             calibration,
                             std::nullopt,
                             1);
  if (found.empty()) return std::nullopt;
  return std::move(found.front());
}

std::vector<NightRecord> ScheduleStore::running_nights() const {
  return select_nights("WHERE state = 'running' AND ?1 IS NULL AND ?2 IS NULL ORDER BY id LIMIT ?3",
                       std::nullopt,
                       std::nullopt,
                       std::numeric_limits<int>::max());
}

std::vector<NightRecord> ScheduleStore::nights(std::int64_t schedule,
                                               int limit,
                                               std::optional<std::int64_t> before) const {
  return select_nights(
      "WHERE schedule_id = ?1 AND (?2 IS NULL OR id < ?2) ORDER BY id DESC LIMIT ?3",
      schedule,
      before,
      limit);
}

void ScheduleStore::promote(std::int64_t schedule,
                            std::int64_t calibration,
                            const std::string& reason,
                            std::int64_t now) {
  const std::scoped_lock hold(store_.state_->mutex);
  store_.state_->connection
      .prepare(
          "INSERT INTO promotion (schedule_id, calibration_id, promoted_at, reason) "
          "VALUES (?, ?, ?, ?)")
      .bind(schedule)
      .bind(calibration)
      .bind(now)
      .bind(std::string_view(reason))
      .run();
}

std::vector<PromotionRecord> ScheduleStore::promotions(std::int64_t schedule) const {
  const std::scoped_lock hold(store_.state_->mutex);
  Statement row = store_.state_->connection.prepare(
      "SELECT id, schedule_id, calibration_id, night_id, promoted_at, reason FROM promotion "
      "WHERE schedule_id = ? ORDER BY id DESC");
  row.bind(schedule);
  std::vector<PromotionRecord> records;
  while (row.step()) {
    records.push_back({row.integer(0),
                       row.integer(1),
                       row.integer(2),
                       row.integer_or_null(3),
                       row.integer(4),
                       row.text(5)});
  }
  return records;
}

std::map<std::int64_t, std::vector<std::int64_t>> ScheduleStore::in_force() const {
  const std::scoped_lock hold(store_.state_->mutex);
  Statement row = store_.state_->connection.prepare(
      "SELECT p.calibration_id, s.id FROM schedule s JOIN promotion p ON p.id = "
      "(SELECT max(id) FROM promotion WHERE schedule_id = s.id) "
      "WHERE s.removed_at IS NULL ORDER BY s.id");
  std::map<std::int64_t, std::vector<std::int64_t>> schedules;
  while (row.step()) schedules[row.integer(0)].push_back(row.integer(1));
  return schedules;
}

}  // namespace repose::db
