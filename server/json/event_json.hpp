/// Events -> documents, and -> server-sent events (the HTML standard's text/event-stream).
#pragma once

#include <string>
#include <vector>

#include "db/event_store.hpp"
#include "server/json/page.hpp"

namespace repose::server {

/// {"items":[{"id","created_at","kind","data"}],"next"}
Page print_events(const std::vector<db::EventRecord>& events, int limit);

/// What an event says beside its number and kind: an object.
std::string print_event_data(const db::EventRecord& event);

/// id, event and data of each.
std::string print_event_stream(const std::vector<db::EventRecord>& events);

}  // namespace repose::server
