#include "db/material_store.hpp"

#include "db/store_state.hpp"

namespace repose::db {

void MaterialStore::put(const MaterialRecord& material) {
  const std::scoped_lock hold(store_.state_->mutex);
  store_.state_->connection
      .prepare("INSERT OR REPLACE INTO material (name, created_at, document) VALUES (?, ?, ?)")
      .bind(std::string_view(material.name))
      .bind(material.created_at)
      .bind(std::string_view(material.document))
      .run();
}

std::optional<MaterialRecord> MaterialStore::find(const std::string& name) const {
  const std::scoped_lock hold(store_.state_->mutex);
  Statement row = store_.state_->connection.prepare(
      "SELECT name, created_at, document FROM material WHERE name = ?");
  row.bind(std::string_view(name));
  if (!row.step()) return std::nullopt;
  return MaterialRecord{row.text(0), row.integer(1), row.text(2)};
}

std::vector<MaterialRecord> MaterialStore::list() const {
  const std::scoped_lock hold(store_.state_->mutex);
  Statement row = store_.state_->connection.prepare(
      "SELECT name, created_at, document FROM material ORDER BY name");
  std::vector<MaterialRecord> records;
  while (row.step()) records.push_back({row.text(0), row.integer(1), row.text(2)});
  return records;
}

bool MaterialStore::remove(const std::string& name) {
  const std::scoped_lock hold(store_.state_->mutex);
  store_.state_->connection.prepare("DELETE FROM material WHERE name = ?")
      .bind(std::string_view(name))
      .run();
  return store_.state_->connection.changes() == 1;
}

}  // namespace repose::db
