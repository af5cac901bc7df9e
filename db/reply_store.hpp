/// ReplyStore: the replies kept for clients that ask again with the same key.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "db/store.hpp"

namespace repose::db {

struct KeptReply {
  std::string request_digest;
  std::string reply;  ///< document
};

class ReplyStore {
 public:
  explicit ReplyStore(Store& store) : store_(store) {}

  /// The reply that is kept for that key; else does `work`, and keeps what it returns, if anything,
  /// in one transaction with all that the work does to the store. Gives back what was there before.
  std::optional<KeptReply> once(const std::string& key,
                                const std::string& request_digest,
                                std::int64_t now,
                                const std::function<std::optional<std::string>()>& work);

  /// Forgets replies from before that time.
  void forget(std::int64_t before);

 private:
  Store& store_;
};

}  // namespace repose::db
