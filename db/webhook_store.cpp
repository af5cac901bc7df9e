#include "db/webhook_store.hpp"

#include "db/store_state.hpp"

namespace repose::db {

std::int64_t WebhookStore::add(const std::string& url,
                               const std::string& kinds,
                               const std::string& secret,
                               std::int64_t now) {
  const std::scoped_lock hold(store_.state_->mutex);
  store_.state_->connection
      .prepare(
          "INSERT INTO webhook (created_at, url, kinds, secret, state, last_event, next_at) "
          "SELECT ?1, ?2, ?3, ?4, 'active', coalesce(max(id), 0), ?1 FROM event")
      .bind(now)
      .bind(std::string_view(url))
      .bind(std::string_view(kinds))
      .bind(std::string_view(secret))
      .run();
  return store_.state_->connection.last_id();
}

bool WebhookStore::replace(std::int64_t id,
                           const std::string& url,
                           const std::string& kinds,
                           const std::optional<std::string>& new_secret,
                           std::int64_t former_until,
                           std::int64_t now) {
  const std::scoped_lock hold(store_.state_->mutex);
  Connection& connection = store_.state_->connection;
  Transaction transaction(connection);
  connection
      .prepare(
          "UPDATE webhook SET url = ?, kinds = ?, state = 'active', failures = 0, next_at = ?, "
          "account = NULL, revision = revision + 1 WHERE id = ?")
      .bind(std::string_view(url))
      .bind(std::string_view(kinds))
      .bind(now)
      .bind(id)
      .run();
  if (connection.changes() == 0) return false;
  if (new_secret) {
    connection
        .prepare(
            "UPDATE webhook SET former_secret = secret, former_until = ?, secret = ? WHERE id = ?")
        .bind(former_until)
        .bind(std::string_view(*new_secret))
        .bind(id)
        .run();
  }
  transaction.commit();
  return true;
}

bool WebhookStore::remove(std::int64_t id) {
  const std::scoped_lock hold(store_.state_->mutex);
  store_.state_->connection.prepare("DELETE FROM webhook WHERE id = ?").bind(id).run();
  return store_.state_->connection.changes() == 1;
}

std::vector<WebhookRecord> WebhookStore::select(std::string_view rest,
                                                std::optional<std::int64_t> value) const {
  const std::scoped_lock hold(store_.state_->mutex);
  Statement row = store_.state_->connection.prepare(
      "SELECT id, created_at, url, kinds, secret, former_secret, former_until, state, last_event, "
      "failures, next_at, delivered, failed, account, revision FROM webhook " +
      std::string(rest) + " ORDER BY id");
  if (value) row.bind(*value);
  std::vector<WebhookRecord> records;
  while (row.step()) {
    records.push_back({row.integer(0),
                       row.integer(1),
                       row.text(2),
                       row.text(3),
                       row.text(4),
                       row.text_or_null(5),
                       row.integer_or_null(6),
                       row.text(7),
                       row.integer(8),
                       row.integer(9),
                       row.integer(10),
                       row.integer(11),
                       row.integer(12),
                       row.text_or_null(13),
                       row.integer(14)});
  }
  return records;
}

std::optional<WebhookRecord> WebhookStore::webhook(std::int64_t id) const {
  auto records = select("WHERE id = ?", id);
  if (records.empty()) return std::nullopt;
  return std::move(records.front());
}

std::vector<WebhookRecord> WebhookStore::webhooks() const { return select("", std::nullopt); }

std::vector<WebhookRecord> WebhookStore::due(std::int64_t now) const {
  return select("WHERE state = 'active' AND next_at <= ?", now);
}

bool WebhookStore::delivered(const WebhookRecord& webhook, std::int64_t event) {
  const std::scoped_lock hold(store_.state_->mutex);
  Connection& connection = store_.state_->connection;
  connection
      .prepare(
          "UPDATE webhook SET last_event = ?1, delivered = delivered + 1, failures = 0, "
          "account = NULL WHERE id = ?2 AND revision = ?3 AND last_event < ?1")
      .bind(event)
      .bind(webhook.id)
      .bind(webhook.revision)
      .run();
  return connection.changes() == 1;
}

bool WebhookStore::passed_over(const WebhookRecord& webhook, std::int64_t event) {
  const std::scoped_lock hold(store_.state_->mutex);
  Connection& connection = store_.state_->connection;
  connection
      .prepare(
          "UPDATE webhook SET last_event = ?1 WHERE id = ?2 AND revision = ?3 AND last_event < ?1")
      .bind(event)
      .bind(webhook.id)
      .bind(webhook.revision)
      .run();
  return connection.changes() == 1;
}

bool WebhookStore::failed(const WebhookRecord& webhook,
                          std::string_view state,
                          const std::string& account,
                          std::int64_t next_at) {
  const std::scoped_lock hold(store_.state_->mutex);
  Connection& connection = store_.state_->connection;
  connection
      .prepare(
          "UPDATE webhook SET state = ?, account = ?, next_at = ?, failures = failures + 1, "
          "failed = failed + 1 WHERE id = ? AND revision = ?")
      .bind(state)
      .bind(std::string_view(account))
      .bind(next_at)
      .bind(webhook.id)
      .bind(webhook.revision)
      .run();
  return connection.changes() == 1;
}

WebhookFigures WebhookStore::figures() const {
  const std::scoped_lock hold(store_.state_->mutex);
  Statement row = store_.state_->connection.prepare(
      "SELECT state, count(*), sum(delivered), sum(failed) FROM webhook GROUP BY state");
  WebhookFigures result;
  while (row.step()) {
    result.states[row.text(0)] = row.integer(1);
    result.delivered += row.integer(2);
    result.failed += row.integer(3);
  }
  return result;
}

}  // namespace repose::db
