#include "server/api/guard.hpp"

#include <algorithm>
#include <array>

namespace repose::server {

namespace {

constexpr std::size_t most_fields = 64;

char lower(char letter) {
  return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
}

bool same_name(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, {}, lower, lower);
}

std::vector<std::string_view> values_of(const RequestHead& head, std::string_view name) {
  std::vector<std::string_view> values;
  for (const auto& [field, value] : head.fields) {
    if (same_name(field, name)) values.push_back(value);
  }
  return values;
}

/// The host of a Host field, without its port.
std::string_view without_port(std::string_view host) {
  if (host.starts_with('[')) return host.substr(0, std::min(host.find(']') + 1, host.size()));
  return host.substr(0, host.find(':'));
}

bool is_known(std::string_view host, const std::vector<std::string>& names) {
  static constexpr std::array<std::string_view, 4> loopback{
      "localhost", "127.0.0.1", "[::1]", "localhost."};
  const std::string_view name = without_port(host);
  const auto is_same = [name](std::string_view other) { return same_name(name, other); };
  return std::ranges::any_of(loopback, is_same) || std::ranges::any_of(names, is_same);
}

bool breaks_line(std::string_view value) {
  return value.find_first_of(std::string_view("\r\n\0", 3)) != std::string_view::npos;
}

bool is_whole(std::string_view text) {
  constexpr std::size_t longest = 18;  // digits that 64 bits hold for certain
  return !text.empty() && text.size() <= longest &&
         text.find_first_not_of("0123456789") == std::string_view::npos;
}

std::optional<HeadRefusal> refuse_body(const RequestHead& head) {
  if (!values_of(head, "Transfer-Encoding").empty()) {
    return HeadRefusal{411, "Send the body with a Content-Length, not in chunks."};
  }
  if (!values_of(head, "Content-Encoding").empty()) {
    return HeadRefusal{415, "Send the body as it is, not compressed."};
  }
  const auto lengths = values_of(head, "Content-Length");
  if (lengths.size() > 1 || (lengths.size() == 1 && !is_whole(lengths[0]))) {
    return HeadRefusal{400, "Content-Length is one whole number."};
  }
  const bool takes_body = head.method == "POST" || head.method == "PUT" || head.method == "PATCH";
  if (takes_body && lengths.empty()) {
    return HeadRefusal{411, "Send the body with a Content-Length."};
  }
  const bool reads_body = takes_body || head.method == "DELETE";
  if (!reads_body && lengths.size() == 1 && lengths[0].find_first_not_of('0') != lengths[0].npos) {
    return HeadRefusal{400, "A " + head.method + " has no body here."};
  }
  return std::nullopt;
}

}  // namespace

std::optional<HeadRefusal> refuse(const RequestHead& head, const std::vector<std::string>& names) {
  if (head.fields.size() > most_fields) {
    return HeadRefusal{431, "At most " + std::to_string(most_fields) + " header fields are read."};
  }
  for (const auto& [name, value] : head.fields) {
    if (breaks_line(name) || breaks_line(value)) {
      return HeadRefusal{400, "A header field holds a line break or a null."};
    }
  }
  if (auto refusal = refuse_body(head)) return refusal;
  if (head.ranges > 1) return HeadRefusal{416, "One range at a time."};
  const auto hosts = values_of(head, "Host");
  if (hosts.size() != 1) return HeadRefusal{400, "A request names its host once."};
  if (!is_known(hosts[0], names)) {
    return HeadRefusal{421, "This server answers for localhost and for the name it was bound to."};
  }
  return std::nullopt;
}

}  // namespace repose::server
