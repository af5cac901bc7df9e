/// MaterialStore: grains that users describe themselves.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "db/store.hpp"

namespace repose::db {

struct MaterialRecord {
  std::string name;
  std::int64_t created_at = 0;  ///< of this description
  std::string document;
};

class MaterialStore {
 public:
  explicit MaterialStore(Store& store) : store_(store) {}

  void put(const MaterialRecord& material);
  [[nodiscard]] std::optional<MaterialRecord> find(const std::string& name) const;
  [[nodiscard]] std::vector<MaterialRecord> list() const;  ///< by name
  /// False where there is none of that name.
  bool remove(const std::string& name);

 private:
  Store& store_;
};

}  // namespace repose::db
