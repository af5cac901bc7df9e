/// AttemptStore: the verbs for attempts to answer questions. As the store's: each is one
/// transaction, from any thread. Times are microseconds since 1970 UTC.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "db/store.hpp"

namespace repose::db {

struct AttemptRecord {
  std::string key;
  std::int64_t number = 0;
  std::string executor;
  std::string state;
  std::int64_t started_at = 0;
  std::optional<std::int64_t> finished_at;
  std::string account;  ///< how it ended, in words
};

class AttemptStore {
 public:
  explicit AttemptStore(Store& store) : store_(store) {}

  /// A new attempt, which runs; its number is one more than the last one's of that key, from 0.
  std::int64_t begin(const std::string& key, std::string_view executor, std::int64_t now);

  enum class Accepted : std::uint8_t {
    kept,     ///< the answer is in the store
    equal,    ///< the store had the same one
    other,    ///< the store has another one, which stays: one engine has answered in two ways
    too_late  ///< the attempt had ended: nothing has changed
  };
  /// running -> answered, and its answer is kept; running -> refused where it is another than the
  /// store has.
  Accepted accept(std::int64_t number, const EvaluationRecord& answer, std::int64_t now);
  /// running -> how it ended without an answer; false where it had ended.
  bool end(const std::string& key,
           std::int64_t number,
           std::string_view state,
           std::string_view account,
           std::int64_t now);
  /// Every running one -> lost: after a restart nothing runs. How many there were.
  std::int64_t lose_all(std::int64_t now);

  [[nodiscard]] std::vector<AttemptRecord> of(const std::string& key) const;  ///< first to last
  [[nodiscard]] std::map<std::string, std::int64_t> totals() const;  ///< ended ones by state

 private:
  Store& store_;
};

}  // namespace repose::db
