/// WebhookStore: the verbs for addresses that are told of events. As the store's: each is one
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

struct WebhookRecord {
  std::int64_t id = 0;
  std::int64_t created_at = 0;
  std::string url;
  std::string kinds;  ///< document: of the events that it is told
  std::string secret;
  std::optional<std::string> former_secret;  ///< still signs, until:
  std::optional<std::int64_t> former_until;
  std::string state;            ///< active; parked: gave up; disabled: the receiver wants no more
  std::int64_t last_event = 0;  ///< that it was told, or that was not for it
  std::int64_t failures = 0;    ///< at the event that comes next
  std::int64_t next_at = 0;     ///< not before
  std::int64_t delivered = 0;   ///< in all
  std::int64_t failed = 0;      ///< attempts in all
  std::optional<std::string> account;  ///< of the last failure
  std::int64_t revision = 0;           ///< how often it was replaced
};

struct WebhookFigures {
  std::map<std::string, std::int64_t> states;
  std::int64_t delivered = 0, failed = 0;
};

class WebhookStore {
 public:
  explicit WebhookStore(const Store& store) : store_(store) {}

  /// It is told what happens from now on.
  std::int64_t add(const std::string& url,
                   const std::string& kinds,
                   const std::string& secret,
                   std::int64_t now);
  /// Puts another address and other kinds in its place, and goes on where it was; the former
  /// secret, where there is a new one, signs until that time too. False where there is none.
  bool replace(std::int64_t id,
               const std::string& url,
               const std::string& kinds,
               const std::optional<std::string>& new_secret,
               std::int64_t former_until,
               std::int64_t now);
  bool remove(std::int64_t id);
  [[nodiscard]] std::optional<WebhookRecord> webhook(std::int64_t id) const;
  [[nodiscard]] std::vector<WebhookRecord> webhooks() const;  ///< oldest first
  [[nodiscard]] std::vector<WebhookRecord> due(std::int64_t now) const;

  // What became of events, of a webhook as it was when they were sent: one that was replaced or
  // removed since does not change. False where it was.
  /// That event was told.
  bool delivered(const WebhookRecord& webhook, std::int64_t event);
  /// All up to that event were not for it.
  bool passed_over(const WebhookRecord& webhook, std::int64_t event);
  bool failed(const WebhookRecord& webhook,
              std::string_view state,
              const std::string& account,
              std::int64_t next_at);
  [[nodiscard]] WebhookFigures figures() const;

 private:
  [[nodiscard]] std::vector<WebhookRecord> select(std::string_view rest,
                                                  std::optional<std::int64_t> value) const;
  const Store& store_;
};

}  // namespace repose::db
