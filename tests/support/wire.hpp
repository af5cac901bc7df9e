/// Wire: bytes over a socket, as no well-behaved client would send them. Loopback only.
#pragma once

#include <arpa/inet.h>
#include <array>
#include <cstdint>
#include <netinet/in.h>
#include <stdexcept>
#include <string>
#include <string_view>
#include <sys/socket.h>
#include <unistd.h>
#include <utility>

namespace repose::tests {

class Wire {
 public:
  explicit Wire(int port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const timeval patience{20, 0};  // ends a test that would wait for ever
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    if (connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
      throw std::runtime_error("cannot connect");
    }
  }
  /// Takes over a socket that is connected.
  static Wire of(int socket) { return Wire(socket, Connected{}); }
  ~Wire() {
    if (socket_ >= 0) close(socket_);
  }
  Wire(Wire&& other) noexcept : socket_(std::exchange(other.socket_, -1)) {}
  Wire(const Wire&) = delete;
  Wire& operator=(const Wire&) = delete;

  void send(std::string_view text) const {
    while (!text.empty()) {
      const ssize_t sent = ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL);
      if (sent <= 0) return;  // the other end has closed: what it said is still to be read
      text.remove_prefix(static_cast<std::size_t>(sent));
    }
  }
  /// No more will be sent.
  void end() const { shutdown(socket_, SHUT_WR); }
  /// Everything until the other end closes.
  [[nodiscard]] std::string rest() const {
    std::string text;
    while (read_some(text)) {
    }
    return text;
  }
  /// Everything until that text has come.
  [[nodiscard]] std::string until(std::string_view end) const {
    std::string text;
    while (text.find(end) == std::string::npos && read_some(text)) {
    }
    return text;
  }

  /// The same, and then on until another.
  [[nodiscard]] std::string until(std::string_view end, std::string_view then) const {
    std::string text;
    const auto is_whole = [&] {
      const auto at = text.find(end);
      return at != std::string::npos && text.find(then, at + end.size()) != std::string::npos;
    };
    while (!is_whole() && read_some(text)) {
    }
    return text;
  }

 private:
  struct Connected {};
  Wire(int socket, Connected) : socket_(socket) {
    const timeval patience{20, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  }
  bool read_some(std::string& text) const {
    std::array<char, 4096> block{};
    const ssize_t count = recv(socket_, block.data(), block.size(), 0);
    if (count <= 0) return false;
    text.append(block.data(), static_cast<std::size_t>(count));
    return true;
  }

  int socket_;
};

/// All that comes back to one request, the server having closed.
inline std::string talk(int port, const std::string& request) {
  const Wire wire(port);
  wire.send(request);
  return wire.rest();
}

inline std::string status_line(const std::string& answer) {
  return answer.substr(0, answer.find('\r'));
}

/// A request's start, the rest of its head, and what comes after.
inline std::string text(const std::string& start,
                        std::string_view fields,
                        std::string_view after = "") {
  std::string whole = start;
  whole.append(fields).append(after);
  return whole;
}

inline bool has(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

}  // namespace repose::tests
