#include "db/figures.hpp"

#include <system_error>

#include "db/store_state.hpp"

namespace repose::db {

namespace {

std::int64_t size_of(const std::filesystem::path& file) {
  std::error_code missing;
  const auto size = std::filesystem::file_size(file, missing);
  return missing ? 0 : static_cast<std::int64_t>(size);
}

}  // namespace

/// Reads the figures, which the store keeps up to date: nothing is counted here.
struct Inspection {
  static Figures figures(const Store& store) {
    const std::scoped_lock hold(store.state_->mutex);
    Figures result;
    Statement total =
        store.state_->connection.prepare("SELECT evaluations, seconds FROM evaluation_total");
    if (total.step()) {
      result.evaluations = total.integer(0);
      result.seconds = total.real(1);
    }
    Statement event = store.state_->connection.prepare("SELECT coalesce(max(id), 0) FROM event");
    event.step();
    result.events = event.integer(0);
    return result;
  }
  static void probe(Store& store) {
    const std::scoped_lock hold(store.state_->mutex);
    store.state_->connection.run("UPDATE evaluation_total SET seconds = seconds");
  }
};

Figures figures(const Store& store) {
  Figures result = Inspection::figures(store);
  result.database_bytes = size_of(store.file());
  result.log_bytes = size_of(store.file().string() + "-wal");
  return result;
}

void probe(Store& store) {
  constexpr std::uintmax_t room = 4U << 20U;  // bytes: what the log grows to before it is moved
  std::error_code unknown;
  const auto space = std::filesystem::space(store.file(), unknown);
  if (!unknown && space.available < room) {
    throw Error(0,
                "the disk of " + store.file().string() + " has " +
                    std::to_string(space.available >> 10U) + " KiB left: make room");
  }
  Inspection::probe(store);
}

}  // namespace repose::db
