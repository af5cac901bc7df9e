#include "server/api/guard.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <system_error>

#include "server/letters.hpp"

namespace repose::server {

namespace {

constexpr std::size_t most_fields = 64;
constexpr std::size_t longest_target = 8000;  // bytes; the HTTP library reads 8192

bool same_name(std::string_view a, std::string_view b) { return lower_case(a) == lower_case(b); }

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

/// Control characters: a line break or a null in a field is an attack on whoever reads it next.
bool has_control(std::string_view text) {
  return std::ranges::any_of(text, [](char letter) {
    const auto code = static_cast<unsigned char>(letter);
    return (code < 0x20 && letter != '\t') || code == 0x7f;
  });
}

/// RFC 9110, 5.6.2: what methods and names of fields are made of.
bool is_token(std::string_view text) {
  static constexpr std::string_view letters =
      "!#$%&'*+-.^_`|~0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz";
  return !text.empty() && text.find_first_not_of(letters) == std::string_view::npos;
}

/// Takes the first line off a text of lines that each end in CR LF.
std::string_view next_line(std::string_view& lines) {
  const std::size_t end = std::min(lines.find("\r\n"), lines.size());
  const std::string_view line = lines.substr(0, end);
  lines.remove_prefix(std::min(end + 2, lines.size()));
  return line;
}

std::optional<HeadRefusal> read_first_line(std::string_view line, RequestHead& head) {
  const std::size_t first = line.find(' '), last = line.rfind(' ');
  if (first == std::string_view::npos || first == last) {
    return HeadRefusal{400, "A request begins with METHOD ADDRESS HTTP/1.1."};
  }
  const std::string_view method = line.substr(0, first), version = line.substr(last + 1);
  const std::string_view target = line.substr(first + 1, last - first - 1);
  if (!is_token(method)) return HeadRefusal{400, "A method is one word."};
  if (version != "HTTP/1.1" && version != "HTTP/1.0") {
    return HeadRefusal{400, "HTTP/1.1 and HTTP/1.0 are spoken here."};
  }
  if (target.size() > longest_target) {
    return HeadRefusal{414, "An address has at most " + std::to_string(longest_target) + " bytes."};
  }
  if (!target.starts_with('/') || target.find_first_of(" \t") != std::string_view::npos) {
    return HeadRefusal{400, "An address begins with / and holds no blank."};
  }
  head.method = method;
  head.target = target;
  head.keeps_alive = version == "HTTP/1.1";
  return std::nullopt;
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
  if (!lengths.empty() && lengths[0].find_first_not_of('0') != lengths[0].npos) {
    std::size_t length = 0;
    std::from_chars(lengths[0].data(), lengths[0].data() + lengths[0].size(), length);
    if (length > largest_body) {
      return HeadRefusal{413, "At most " + std::to_string(largest_body) + " bytes are read."};
    }
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

bool asks_for_ranges(const RequestHead& head) {
  return std::ranges::any_of(values_of(head, "Range"), [](std::string_view value) {
    return value.find(',') != std::string_view::npos;
  });
}

}  // namespace

std::vector<std::string_view> values_of(const RequestHead& head, std::string_view name) {
  std::vector<std::string_view> values;
  for (const auto& [field, value] : head.fields) {
    if (same_name(field, name)) values.push_back(value);
  }
  return values;
}

engine::Result<RequestHead, HeadRefusal> read_head(std::string_view lines) {
  RequestHead head;
  if (auto refusal = read_first_line(next_line(lines), head)) {
    return engine::Unexpected{std::move(*refusal)};
  }
  while (!lines.empty()) {
    const std::string_view line = next_line(lines);
    const std::size_t colon = std::min(line.find(':'), line.size());
    const std::string_view name = line.substr(0, colon);
    if (colon == line.size() || !is_token(name)) {
      return engine::Unexpected{HeadRefusal{400, "A header field is NAME: VALUE on one line."}};
    }
    head.fields.emplace_back(name, trimmed(line.substr(colon + 1)));
  }
  if (std::ranges::any_of(values_of(head, "Connection"),
                          [](std::string_view value) { return same_name(value, "close"); })) {
    head.keeps_alive = false;
  }
  return head;
}

std::optional<HeadRefusal> refuse(const RequestHead& head, const std::vector<std::string>& names) {
  if (head.fields.size() > most_fields) {
    return HeadRefusal{431, "At most " + std::to_string(most_fields) + " header fields are read."};
  }
  if (has_control(head.target) || std::ranges::any_of(head.fields, [](const auto& field) {
        return has_control(field.first) || has_control(field.second);
      })) {
    return HeadRefusal{400, "A header field holds a line break or another control character."};
  }
  if (auto refusal = refuse_body(head)) return refusal;
  if (asks_for_ranges(head)) return HeadRefusal{416, "One range at a time."};
  const auto hosts = values_of(head, "Host");
  if (hosts.size() != 1) return HeadRefusal{400, "A request names its host once."};
  if (!is_known(hosts[0], names)) {
    return HeadRefusal{421, "This server answers for localhost and for the name it was bound to."};
  }
  return std::nullopt;
}

}  // namespace repose::server
