#include "server/api/page_link.hpp"

#include <algorithm>
#include <string_view>

namespace repose::server {

namespace {

/// RFC 3986: all but the unreserved letters, and the slashes of a path.
std::string percent_encoded(std::string_view text) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  std::string result;
  for (const char letter : text) {
    const auto code = static_cast<unsigned char>(letter);
    const bool plain = (code >= '0' && code <= '9') || (code >= 'A' && code <= 'Z') ||
                       (code >= 'a' && code <= 'z');
    if (plain || std::string_view("-._~/").find(letter) != std::string_view::npos) {
      result += letter;
    } else {
      result += {'%', digits[code >> 4U], digits[code & 0xFU]};
    }
  }
  return result;
}

}  // namespace

std::string next_page(const Route& route, const Request& request, const std::string& cursor) {
  const auto field = std::ranges::find_if(route.query, [](const QueryField& one) {
    return one.name == "before" || one.name == "after";
  });
  if (field == route.query.end() || cursor.empty()) return {};
  std::string address = percent_encoded(request.path) + "?";
  for (const auto& [name, value] : request.query) {
    if (name != field->name) address += name + "=" + percent_encoded(value) + "&";
  }
  return address + std::string(field->name) + "=" + percent_encoded(cursor);
}

std::string print_query(const Request& request) {
  std::string text;
  for (const auto& [name, value] : request.query) {
    text += (text.empty() ? "" : "&") + percent_encoded(name) + "=" + percent_encoded(value);
  }
  return text;
}

}  // namespace repose::server
