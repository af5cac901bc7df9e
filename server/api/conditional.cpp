#include "server/api/conditional.hpp"

#include <algorithm>

#include "server/access/secret.hpp"
#include "server/letters.hpp"

namespace repose::server {

std::string entity_tag(std::string_view body) {
  constexpr std::size_t letters = 32;  // of a SHA-256 in hexadecimal: 128 bits
  return "\"" + digest(body).substr(0, letters) + "\"";
}

namespace {

/// Whether one of the tags in a field is the same as that one.
template <class Same>
bool any_tag(std::string_view field, const Same& same) {
  if (field == "*") return true;
  while (!field.empty()) {
    const std::size_t end = std::min(field.find(','), field.size());
    const std::string_view named = trimmed(field.substr(0, end));
    field.remove_prefix(std::min(end + 1, field.size()));
    if (same(named)) return true;
  }
  return false;
}

}  // namespace

bool names_tag(std::string_view field, std::string_view tag) {
  return any_tag(field, [tag](std::string_view named) { return named == tag; });
}

bool names_tag_weakly(std::string_view field, std::string_view tag) {
  return any_tag(field, [tag](std::string_view named) {
    if (named.starts_with("W/")) named.remove_prefix(2);
    return named == tag;
  });
}

}  // namespace repose::server
