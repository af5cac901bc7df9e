/// Conditional requests (RFC 9110, 13): the tag of an answer, and what a client says that it has.
#pragma once

#include <string>
#include <string_view>

namespace repose::server {

/// A strong tag: equal where the bodies are, and else different.
std::string entity_tag(std::string_view body);

/// Whether a field If-Match or If-None-Match names the tag: a list of tags, or * for any.
bool names_tag(std::string_view field, std::string_view tag);

/// The same where weak tags count too, as those of If-None-Match do (RFC 9110, 13.1.2).
bool names_tag_weakly(std::string_view field, std::string_view tag);

}  // namespace repose::server
