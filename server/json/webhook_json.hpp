/// Webhooks and what they deliver: documents (schemas/webhook.schema.json, answers) <-> rows.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "db/event_store.hpp"
#include "db/webhook_store.hpp"
#include "engine/result.hpp"
#include "server/json/problem.hpp"

namespace repose::server {

/// Before the base64 of a secret: see Standard Webhooks.
inline constexpr std::string_view secret_prefix = "whsec_";

/// What may be asked for: every kind of event, and the beginnings that several share.
inline constexpr std::array<std::string_view, 23> event_kinds{
    "calibration.*",
    "calibration.queued",
    "calibration.running",
    "calibration.progress",
    "calibration.done",
    "calibration.failed",
    "calibration.cancelled",
    "diagnosis.*",
    "diagnosis.queued",
    "diagnosis.running",
    "diagnosis.done",
    "diagnosis.failed",
    "diagnosis.cancelled",
    "night.*",
    "night.first",
    "night.kept",
    "night.moved",
    "night.model_no_longer_adequate",
    "night.failed",
    "night.skipped",
    "night.unchanged",
    "night.drift",
    "promotion",
};

struct WebhookContent {
  std::string url;
  std::vector<std::string> kinds;  ///< among event_kinds
  bool new_secret = false;
};

/// {"url","events","new_secret"}; without events: what ends, and what alarms. `private_hosts` may
/// be spoken to without encryption.
engine::Result<WebhookContent, Problems> parse_webhook(
    std::string_view text, const std::vector<std::string>& private_hosts);

std::string print_kinds(const std::vector<std::string>& kinds);
std::vector<std::string> parse_kinds(std::string_view kinds);
/// Whether an event of that kind is among those.
bool is_told(const std::vector<std::string>& kinds, std::string_view kind);

/// {"id","url","events","state",...}; with the secret where it is shown, which is once.
std::string print_webhook(const db::WebhookRecord& webhook,
                          const std::optional<std::string>& secret = {});
/// {"items"}
std::string print_webhooks(const std::vector<db::WebhookRecord>& webhooks);

/// {"type","timestamp","data"}: what the receiver gets of an event.
std::string print_delivery(const db::EventRecord& event);

}  // namespace repose::server
