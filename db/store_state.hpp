/// The inside of the store: its connection, and what several of its verbs need.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "db/lock.hpp"
#include "db/sqlite.hpp"
#include "db/store.hpp"

namespace repose::db {

/// One connection writes, reads and checkpoints under one mutex: two connections of one process
/// that write or checkpoint at the same moment can corrupt a WAL file in this version of SQLite,
/// and nothing here is so frequent that it would wait.
///
/// Below, `table` is calibration or diagnosis: what is asked for, worked on and finished.
struct Store::State {
  State(const std::filesystem::path& file, Access access);

  std::vector<std::int64_t> in_state(const std::string& table, std::string_view state);
  bool requeue(const std::string& table, std::int64_t id);
  void set_progress(const std::string& table, std::int64_t id, const std::string& progress);
  /// All or none. What is noted from that ordinal on goes: a run that was cut off is run again from
  /// its beginning, perhaps by another engine.
  void note_used(const std::string& table,
                 std::int64_t owner,
                 std::int64_t first_ordinal,
                 const std::vector<std::string>& keys);
  /// Those after that ordinal.
  std::vector<UsedEvaluation> used(const std::string& table,
                                   std::int64_t owner,
                                   int limit,
                                   std::int64_t after);

  std::unique_ptr<FileLock> lock;
  Connection connection;
  std::recursive_mutex mutex;  ///< held through the verbs that make one transaction together
};

/// The six columns of an evaluation from that one on.
EvaluationRecord evaluation_of(const Statement& row, int first);

}  // namespace repose::db
