/// Tells the addresses of webhooks what has happened, from the table of events: in order, each
/// event until its receiver has answered, and at least once. Signed as Standard Webhooks has it
/// (https://www.standardwebhooks.com, version 1.0):
///
///   webhook-id, webhook-timestamp,
///   webhook-signature: v1,<base64 of HMAC-SHA256(secret, "id.timestamp.body")>
///
/// with a second signature while a former secret is still good. The id of an event is the same in
/// every attempt: a receiver that has seen it has it twice.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <stop_token>

#include "db/store.hpp"
#include "server/jobs/failure_log.hpp"
#include "server/webhooks/post.hpp"

namespace repose::server {

/// Seconds before each further attempt at an event; after the last one the webhook is parked until
/// somebody puts it in force again.
inline constexpr std::array<std::int64_t, 6> delivery_waits{10, 60, 600, 3600, 6 * 3600, 24 * 3600};

/// Microseconds since 1970 UTC; asked by several threads.
using Clock = std::function<std::int64_t()>;

/// What is due, to several webhooks at once and to each for some seconds at most: none that fails
/// here, and no receiver that is slow or deaf, keeps the others waiting.
void deliver_due(db::Store& store,
                 const Post& post,
                 const Clock& clock,
                 const std::stop_token& stop,
                 FailureLog& failures);

}  // namespace repose::server
