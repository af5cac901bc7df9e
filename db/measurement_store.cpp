#include "db/measurement_store.hpp"

#include <limits>

#include "db/store_state.hpp"

namespace repose::db {

namespace {

constexpr std::string_view select_set =
    "SELECT id, name, version, material, created_at, measurements FROM measurement_set ";

MeasurementSetRecord set_of(const Statement& row) {
  return {row.integer(0), row.text(1), row.integer(2), row.text(3), row.integer(4), row.text(5)};
}

constexpr std::string_view select_fit =
    "SELECT c.id, c.name, c.state, c.created_at, c.started_at, c.finished_at, c.request_digest, "
    "c.misfit, c.fit, s.material, m.name, m.version FROM calibration c "
    "LEFT JOIN calibration_source s ON s.calibration_id = c.id "
    "LEFT JOIN measurement_set m ON m.id = s.measurement_set_id ";

FitRecord fit_of(const Statement& row) {
  FitRecord record;
  record.calibration.id = row.integer(0);
  record.calibration.name = row.text(1);
  record.calibration.state = row.text(2);
  record.calibration.created_at = row.integer(3);
  record.calibration.started_at = row.integer_or_null(4);
  record.calibration.finished_at = row.integer_or_null(5);
  record.calibration.request_digest = row.text(6);
  record.calibration.misfit = row.real_or_null(7);
  record.calibration.fit = row.text_or_null(8);
  record.material = row.text_or_null(9);
  record.set = row.text_or_null(10);
  record.version = row.integer_or_null(11);
  return record;
}

}  // namespace

MeasurementSetRecord MeasurementStore::put(const std::string& name,
                                           const std::string& material,
                                           const std::string& measurements,
                                           std::int64_t now) {
  const std::scoped_lock hold(store_.state_->mutex);
  Connection& connection = store_.state_->connection;
  Transaction transaction(connection);
  const auto newest = find(name, std::nullopt);
  if (newest && newest->material == material && newest->measurements == measurements) {
    return *newest;
  }
  const std::int64_t version = newest ? newest->version + 1 : 1;
  connection
      .prepare(
          "INSERT INTO measurement_set (name, version, material, created_at, measurements) "
          "VALUES (?, ?, ?, ?, ?)")
      .bind(std::string_view(name))
      .bind(version)
      .bind(std::string_view(material))
      .bind(now)
      .bind(std::string_view(measurements))
      .run();
  const std::int64_t id = connection.last_id();
  transaction.commit();
  return {id, name, version, material, now, measurements};
}

std::optional<MeasurementSetRecord> MeasurementStore::find(
    const std::string& name, const std::optional<std::int64_t>& version) const {
  const std::scoped_lock hold(store_.state_->mutex);
  Statement row = store_.state_->connection.prepare(
      std::string(select_set) +
      "WHERE name = ?1 AND (?2 IS NULL OR version = ?2) ORDER BY version DESC LIMIT 1");
  row.bind(std::string_view(name)).bind(version);
  if (!row.step()) return std::nullopt;
  return set_of(row);
}

std::vector<MeasurementSetRecord> MeasurementStore::list(
    int limit, const std::optional<std::string>& after) const {
  const std::scoped_lock hold(store_.state_->mutex);
  Statement row = store_.state_->connection.prepare(
      "SELECT id, name, max(version), material, created_at, '' FROM measurement_set "
      "WHERE ?1 IS NULL OR name > ?1 GROUP BY name ORDER BY name LIMIT ?2");
  row.bind(after).bind(static_cast<std::int64_t>(limit));
  std::vector<MeasurementSetRecord> records;
  while (row.step()) records.push_back(set_of(row));
  return records;
}

std::int64_t MeasurementStore::add_calibration(const std::string& name,
                                               const std::string& request,
                                               const std::string& digest,
                                               const SourceRecord& source,
                                               std::int64_t now) {
  const std::scoped_lock hold(store_.state_->mutex);
  Transaction transaction(store_.state_->connection);
  const std::int64_t calibration = store_.add_calibration(name, request, digest, now);
  store_.state_->connection
      .prepare(
          "INSERT INTO calibration_source (calibration_id, material, measurement_set_id) "
          "VALUES (?, ?, ?)")
      .bind(calibration)
      .bind(source.material)
      .bind(source.set)
      .run();
  transaction.commit();
  return calibration;
}

SourceRecord MeasurementStore::source(std::int64_t calibration) const {
  const std::scoped_lock hold(store_.state_->mutex);
  Statement row = store_.state_->connection.prepare(
      "SELECT material, measurement_set_id FROM calibration_source WHERE calibration_id = ?");
  row.bind(calibration);
  if (!row.step()) return {};
  return {row.text_or_null(0), row.integer_or_null(1)};
}

std::optional<MeasurementSetRecord> MeasurementStore::set(std::int64_t id) const {
  const std::scoped_lock hold(store_.state_->mutex);
  Statement row = store_.state_->connection.prepare(
      "SELECT id, name, version, material, created_at, '' FROM measurement_set WHERE id = ?");
  row.bind(id);
  if (!row.step()) return std::nullopt;
  return set_of(row);
}

std::vector<FitRecord> MeasurementStore::fits(const FitFilter& filter, int limit) const {
  return select_fits(
      "WHERE c.state = 'done' AND c.fit IS NOT NULL AND (?1 IS NULL OR s.material = ?1) "
      "AND (?2 IS NULL OR c.name = ?2) AND (?3 IS NULL OR c.id < ?3) ORDER BY c.id DESC LIMIT ?4",
      filter,
      limit);
}

std::vector<FitRecord> MeasurementStore::best_fits(const FitFilter& filter) const {
  // Of equal misfits the newest stands.
  return select_fits(
      "WHERE c.id IN (SELECT id FROM (SELECT f.id, row_number() OVER "
      "(PARTITION BY f.name, t.material ORDER BY f.misfit, f.id DESC) AS place "
      "FROM calibration f LEFT JOIN calibration_source t ON t.calibration_id = f.id "
      "WHERE f.fit IS NOT NULL AND f.misfit IS NOT NULL AND f.state = 'done' "
      "AND (?1 IS NULL OR t.material = ?1) AND (?2 IS NULL OR f.name = ?2) "
      "AND (?3 IS NULL OR f.id < ?3)) WHERE place = 1) ORDER BY c.name, s.material LIMIT ?4",
      filter,
      std::numeric_limits<int>::max());
}

std::vector<FitRecord> MeasurementStore::select_fits(std::string_view rest,
                                                     const FitFilter& filter,
                                                     int limit) const {
  const std::scoped_lock hold(store_.state_->mutex);
  Statement row = store_.state_->connection.prepare(std::string(select_fit) + std::string(rest));
  row.bind(filter.material)
      .bind(filter.name)
      .bind(filter.before)
      .bind(static_cast<std::int64_t>(limit));
  std::vector<FitRecord> records;
  while (row.step()) records.push_back(fit_of(row));
  return records;
}

}  // namespace repose::db
