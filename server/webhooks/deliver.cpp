#include "server/webhooks/deliver.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <string>
#include <thread>
#include <vector>

#include "db/event_store.hpp"
#include "db/webhook_store.hpp"
#include "server/access/secret.hpp"
#include "server/json/webhook_json.hpp"

namespace repose::server {

namespace {

constexpr std::int64_t second = 1'000'000;  // microseconds
constexpr int gone = 410;                   // HTTP: the receiver wants no more

std::string sign(const std::string& secret, const std::string& text) {
  return "v1," + base64(signature(from_base64(secret.substr(secret_prefix.size())), text));
}

Message message_for(const db::WebhookRecord& webhook,
                    const db::EventRecord& event,
                    std::int64_t now) {
  const std::string id = "event_" + std::to_string(event.id);
  const std::string time = std::to_string(now / second);
  std::string body = print_delivery(event);
  const std::string signed_text = id + "." + time + "." + body;
  std::string signatures = sign(webhook.secret, signed_text);
  if (webhook.former_secret && now < *webhook.former_until) {
    signatures += " " + sign(*webhook.former_secret, signed_text);
  }
  return {.url = webhook.url,
          .fields = {{"Content-Type", "application/json"},
                     {"User-Agent", "repose"},
                     {"webhook-id", id},
                     {"webhook-timestamp", time},
                     {"webhook-signature", signatures}},
          .body = std::move(body)};
}

/// True where the event has arrived and the webhook is still that one; else when to try again, or
/// that nobody will, is kept.
bool tell(db::Store& store,
          const Post& post,
          const db::WebhookRecord& webhook,
          const db::EventRecord& event,
          std::int64_t failures,
          const Clock& clock,
          const std::stop_token& stop) {
  db::WebhookStore webhooks(store);
  const Posted posted = post(message_for(webhook, event, clock()), stop);
  if (posted.status >= 200 && posted.status < 300) {
    return webhooks.delivered(webhook, event.id);
  }
  if (stop.stop_requested()) return false;  // the receiver is not to blame
  const std::string account = posted.status == 0
                                  ? posted.account
                                  : "it answered with status " + std::to_string(posted.status);
  const auto attempt = static_cast<std::size_t>(failures);
  const bool again = attempt < delivery_waits.size();
  const std::string_view state = posted.status == gone ? "disabled" : again ? "active" : "parked";
  const std::int64_t wait = again ? second * delivery_waits.at(attempt) : 0;
  webhooks.failed(webhook, state, account, clock() + wait);
  return false;
}

/// The events of one webhook, up to a page and for some seconds: then it is the others' turn.
void deliver(db::Store& store,
             const Post& post,
             const db::WebhookRecord& webhook,
             const Clock& clock,
             const std::stop_token& stop) {
  constexpr int page = 100;
  constexpr std::int64_t turn = 5 * second;
  const std::int64_t begin = clock();
  const auto kinds = parse_kinds(webhook.kinds);
  const auto events = db::EventStore(store).events(std::nullopt, webhook.last_event, page);
  std::int64_t failures = webhook.failures;
  std::int64_t last = webhook.last_event;
  for (const auto& event : events) {
    if (stop.stop_requested() || clock() - begin >= turn) return;
    if (!is_told(kinds, event.kind)) continue;
    if (!tell(store, post, webhook, event, failures, clock, stop)) return;
    failures = 0;
    last = event.id;
  }
  // What is not for it is read again until a page is full of it: that costs no write.
  if (events.size() == page && events.back().id > last) {
    db::WebhookStore(store).passed_over(webhook, events.back().id);
  }
}

}  // namespace

void deliver_due(db::Store& store,
                 const Post& post,
                 const Clock& clock,
                 const std::stop_token& stop,
                 FailureLog& failures) {
  constexpr std::size_t most_at_once = 16;
  const auto due = db::WebhookStore(store).due(clock());
  std::atomic<std::size_t> next = 0;
  const auto serve = [&] {
    for (std::size_t n = next++; n < due.size() && !stop.stop_requested(); n = next++) {
      failures.run("webhook " + std::to_string(due[n].id),
                   [&] { deliver(store, post, due[n], clock, stop); });
    }
  };
  std::vector<std::jthread> others;
  while (others.size() + 1 < std::min(due.size(), most_at_once)) others.emplace_back(serve);
  serve();
}

}  // namespace repose::server
