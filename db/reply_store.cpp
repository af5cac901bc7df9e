#include "db/reply_store.hpp"

#include "db/store_state.hpp"

namespace repose::db {

std::optional<KeptReply> ReplyStore::once(const std::string& key,
                                          const std::string& request_digest,
                                          std::int64_t now,
                                          const std::function<std::optional<std::string>()>& work) {
  const std::scoped_lock hold(store_.state_->mutex);
  Connection& connection = store_.state_->connection;
  Transaction transaction(connection);
  {
    Statement row =
        connection.prepare("SELECT request_digest, reply FROM kept_reply WHERE key = ?");
    row.bind(std::string_view(key));
    if (row.step()) return KeptReply{row.text(0), row.text(1)};
  }
  const std::optional<std::string> reply = work();
  if (reply) {
    connection
        .prepare(
            "INSERT INTO kept_reply (key, request_digest, created_at, reply) VALUES (?, ?, ?, ?)")
        .bind(std::string_view(key))
        .bind(std::string_view(request_digest))
        .bind(now)
        .bind(std::string_view(*reply))
        .run();
  }
  transaction.commit();
  return std::nullopt;
}

void ReplyStore::forget(std::int64_t before) {
  const std::scoped_lock hold(store_.state_->mutex);
  store_.state_->connection.prepare("DELETE FROM kept_reply WHERE created_at < ?")
      .bind(before)
      .run();
}

}  // namespace repose::db
