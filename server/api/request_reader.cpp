#include "server/api/request_reader.hpp"

#include <array>
#include <charconv>
#include <utility>

namespace repose::server {

namespace {

/// The header fields that this program reads. All others stay outside: the library believes
/// REMOTE_ADDR from a client, serves ranges, and unpacks bodies.
constexpr std::array<std::string_view, 9> read_fields{"Host",
                                                      "Accept",
                                                      "Authorization",
                                                      "Content-Type",
                                                      "Idempotency-Key",
                                                      "If-Match",
                                                      "If-None-Match",
                                                      "Last-Event-ID",
                                                      "X-Request-Id"};

/// The library decodes %0D%0A in values to a line break: a percent sign is written so that it
/// comes out as it went in.
std::string escaped(std::string_view value) {
  std::string result;
  for (const char letter : value) {
    if (letter == '%') {
      result += "%25";
    } else {
      result += letter;
    }
  }
  return result;
}

std::string print_head(const RequestHead& head) {
  std::string text = head.method + " " + head.target + " HTTP/1.1\r\n";
  for (const std::string_view name : read_fields) {
    std::string joined;
    for (const std::string_view value : values_of(head, name)) {
      joined += (joined.empty() ? "" : ", ") + escaped(value);
    }
    if (!joined.empty()) text += std::string(name) + ": " + joined + "\r\n";
  }
  return text;
}

std::size_t body_size(const RequestHead& head) {
  std::size_t size = 0;
  for (const std::string_view length : values_of(head, "Content-Length")) {
    std::from_chars(length.data(), length.data() + length.size(), size);
  }
  return size;
}

}  // namespace

RequestReader::Progress RequestReader::refuse_with(HeadRefusal refusal) {
  refusal_ = std::move(refusal);
  bytes_.clear();
  return progress_ = Progress::refused;
}

RequestReader::Progress RequestReader::read_head() {
  // An empty line or two before a request are left over from the last one (RFC 9112, 2.2).
  if (bytes_.starts_with("\r\n")) bytes_.erase(0, 2);
  const std::size_t end = bytes_.find("\r\n\r\n");
  if (std::min(end, bytes_.size()) > largest_head) {
    return refuse_with(
        {431, "The head of a request has at most " + std::to_string(largest_head) + " bytes."});
  }
  if (end == std::string::npos) {
    return progress_ = bytes_.empty() ? Progress::empty : Progress::head;
  }
  const auto head = server::read_head(std::string_view(bytes_).substr(0, end));
  if (!head) return refuse_with(head.error());
  if (auto refusal = refuse(*head, *names_)) return refuse_with(std::move(*refusal));
  head_ = print_head(*head);
  body_size_ = body_size(*head);
  keeps_alive_ = head->keeps_alive;
  bytes_.erase(0, end + 4);
  const auto expectations = values_of(*head, "Expect");
  expects_leave_ = !expectations.empty() && bytes_.size() < body_size_;
  return progress_ = Progress::body;
}

RequestReader::Progress RequestReader::advance() {
  if (progress_ == Progress::empty || progress_ == Progress::head) read_head();
  if (progress_ == Progress::body && bytes_.size() >= body_size_) progress_ = Progress::whole;
  return progress_;
}

WholeRequest RequestReader::take() {
  WholeRequest request{std::move(head_), keeps_alive_};
  if (body_size_ > 0) request.text += "Content-Length: " + std::to_string(body_size_) + "\r\n";
  request.text += "\r\n";
  request.text.append(bytes_, 0, body_size_);
  bytes_.erase(0, body_size_);
  body_size_ = 0;
  head_.clear();
  progress_ = Progress::empty;
  return request;
}

bool RequestReader::take_expectation() { return std::exchange(expects_leave_, false); }

}  // namespace repose::server
