/// Figures of a store, for those who watch it.
#pragma once

#include <cstdint>

#include "db/store.hpp"

namespace repose::db {

struct Figures {
  std::int64_t evaluations = 0;
  double seconds = 0.0;  ///< wall time that the evaluations took
  std::int64_t events = 0;
  std::int64_t database_bytes = 0;
  std::int64_t log_bytes = 0;  ///< of the write-ahead log
};

Figures figures(const Store& store);

/// Writes and syncs a page that does not change. Throws db::Error where the store cannot be
/// written, or has so little room that it soon could not be.
void probe(Store& store);

}  // namespace repose::db
