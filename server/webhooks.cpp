#include "server/webhooks.hpp"

#include <optional>

#include "db/webhook_store.hpp"
#include "server/access/secret.hpp"
#include "server/jobs/clock.hpp"
#include "server/json/webhook_json.hpp"

namespace repose::server {

using db::WebhookStore;
using engine::Unexpected;

namespace {

std::string new_secret() {
  constexpr std::size_t bytes = 32;
  return std::string(secret_prefix) + base64(random_bytes(bytes));
}

Answer<WebhookContent> read(std::string_view content,
                            const std::vector<std::string>& private_hosts) {
  auto read_one = parse_webhook(content, private_hosts);
  if (read_one) return *std::move(read_one);
  return Unexpected{invalid("the webhook", read_one.error())};
}

}  // namespace

Answer<std::string> add_webhook(db::Store& store,
                                std::string_view content,
                                const std::vector<std::string>& private_hosts) {
  const auto wanted = read(content, private_hosts);
  if (!wanted) return Unexpected{wanted.error()};
  const std::string secret = new_secret();
  WebhookStore webhooks(store);
  const std::int64_t id =
      webhooks.add(wanted->url, print_kinds(wanted->kinds), secret, microseconds_now());
  return print_webhook(*webhooks.webhook(id), secret);
}

Answer<std::string> replace_webhook(db::Store& store,
                                    std::int64_t id,
                                    std::string_view content,
                                    const std::vector<std::string>& private_hosts) {
  const auto wanted = read(content, private_hosts);
  if (!wanted) return Unexpected{wanted.error()};
  constexpr std::int64_t day = 24LL * 3600 * 1'000'000;  // microseconds
  const std::int64_t now = microseconds_now();
  std::optional<std::string> secret;
  if (wanted->new_secret) secret = new_secret();
  WebhookStore webhooks(store);
  if (!webhooks.replace(id, wanted->url, print_kinds(wanted->kinds), secret, now + day, now)) {
    return Unexpected{not_found("webhook", id)};
  }
  return print_webhook(*webhooks.webhook(id), secret);
}

Answer<std::string> remove_webhook(db::Store& store, std::int64_t id) {
  auto document = webhook(store, id);
  if (document) WebhookStore(store).remove(id);
  return document;
}

Answer<std::string> webhook(const db::Store& store, std::int64_t id) {
  const auto record = WebhookStore(store).webhook(id);
  if (!record) return Unexpected{not_found("webhook", id)};
  return print_webhook(*record);
}

std::string webhooks(const db::Store& store) {
  return print_webhooks(WebhookStore(store).webhooks());
}

}  // namespace repose::server
