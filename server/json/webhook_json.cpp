#include "server/json/webhook_json.hpp"

#include <algorithm>

#include "server/json/event_json.hpp"
#include "server/json/place.hpp"
#include "server/json/text.hpp"
#include "server/webhooks/post.hpp"

namespace repose::server {

namespace {

/// What a receiver gets that does not say what it wants: ends and alarms.
const std::vector<std::string>& usual_kinds() {
  static const std::vector<std::string> kinds{"calibration.done",
                                              "calibration.failed",
                                              "diagnosis.done",
                                              "diagnosis.failed",
                                              "night.*",
                                              "promotion"};
  return kinds;
}

std::string read_url(const Place& place, const std::vector<std::string>& private_hosts) {
  constexpr std::size_t longest = 2000;
  const auto url = place.text(longest);
  if (!url) return {};
  const auto target = parse_url(*url);
  if (!target) {
    place.complain("it is no address that can be posted to",
                   "https://HOST/PATH, without a user and password");
    return {};
  }
  const bool is_private = std::ranges::find(private_hosts, target->host) != private_hosts.end();
  if (target->scheme != "https" && !is_private) {
    place.complain("what goes there could be read on the way",
                   "https, or a host that `repose serve --webhook-host` names");
  }
  return *url;
}

Json webhook_json(const db::WebhookRecord& webhook) {
  return {{"id", webhook.id},
          {"url", webhook.url},
          {"events", Json::parse(webhook.kinds)},
          {"state", webhook.state},
          {"created_at", print_time(webhook.created_at)},
          {"last_event", webhook.last_event},
          {"delivered", webhook.delivered},
          {"failed", webhook.failed},
          {"failure", webhook.account ? Json(*webhook.account) : Json(nullptr)},
          {"next_attempt_at",
           webhook.failures > 0 && webhook.state == "active" ? Json(print_time(webhook.next_at))
                                                             : Json(nullptr)}};
}

}  // namespace

engine::Result<WebhookContent, Problems> parse_webhook(
    std::string_view text, const std::vector<std::string>& private_hosts) {
  ProblemList problems;
  const auto json = parse_text(text, {}, problems);
  if (!json) return engine::Unexpected{problems.all()};
  Members members(Place(&*json, "", problems));
  const Place url = members.required("url", "the address to post to");
  const Place events = members.optional("events");
  const Place new_secret = members.optional("new_secret");
  members.no_others();
  WebhookContent content;
  if (url.exists()) content.url = read_url(url, private_hosts);
  for (const Place& event : events.elements()) {
    const auto kind = event.one_of(event_kinds, "kind of event");
    if (kind) content.kinds.emplace_back(event_kinds.at(*kind));
  }
  if (events.exists() && events.json().is_array() && events.json().empty()) {
    events.complain("nothing would ever be told", "at least one kind of event");
  }
  if (!events.exists()) content.kinds = usual_kinds();
  if (new_secret.exists()) content.new_secret = new_secret.truth().value_or(false);
  if (!problems.empty()) return engine::Unexpected{problems.all()};
  return content;
}

std::string print_kinds(const std::vector<std::string>& kinds) { return to_text(Json(kinds)); }

std::vector<std::string> parse_kinds(std::string_view kinds) {
  return Json::parse(kinds).get<std::vector<std::string>>();
}

bool is_told(const std::vector<std::string>& kinds, std::string_view kind) {
  return std::ranges::any_of(kinds, [kind](std::string_view wanted) {
    return wanted.ends_with('*') ? kind.starts_with(wanted.substr(0, wanted.size() - 1))
                                 : kind == wanted;
  });
}

std::string print_webhook(const db::WebhookRecord& webhook,
                          const std::optional<std::string>& secret) {
  Json json = webhook_json(webhook);
  if (secret) json["secret"] = *secret;
  return to_text(json);
}

std::string print_webhooks(const std::vector<db::WebhookRecord>& webhooks) {
  Json items = Json::array();
  for (const auto& webhook : webhooks) items.push_back(webhook_json(webhook));
  return to_text(Json{{"items", std::move(items)}});
}

std::string print_delivery(const db::EventRecord& event) {
  Json json;
  json["type"] = event.kind;
  json["timestamp"] = print_time(event.created_at);
  json["data"] = Json::parse(print_event_data(event));
  return to_text(json);
}

}  // namespace repose::server
