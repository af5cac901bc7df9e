/// RequestReader: the bytes of one connection -> whole requests, under limits. It knows no sockets
/// and no clock.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "server/api/guard.hpp"

namespace repose::server {

/// Largest head, bytes: request line and header fields.
inline constexpr std::size_t largest_head = 16U << 10U;

/// A request that has come whole and is not refused, printed anew for the HTTP library: only fields
/// that this program reads, nothing that the library would decode or act upon by itself.
struct WholeRequest {
  std::string text;
  bool keeps_alive = true;
};

class RequestReader {
 public:
  enum class Progress { empty, head, body, whole, refused };

  /// `names` are the hosts that are answered for.
  explicit RequestReader(const std::vector<std::string>& names) : names_(&names) {}

  void append(std::string_view bytes) { bytes_.append(bytes); }

  /// Reads on as far as the bytes reach.
  Progress advance();
  [[nodiscard]] Progress progress() const { return progress_; }

  /// Of a refused one.
  [[nodiscard]] const HeadRefusal& refusal() const { return refusal_; }
  /// The request that is whole; what follows it is read next.
  WholeRequest take();

  /// Whether the client waits for leave to send the body; true once for each request.
  bool take_expectation();
  /// What is held at present and will be, bytes.
  [[nodiscard]] std::size_t size() const { return bytes_.size() + body_size_; }

 private:
  Progress refuse_with(HeadRefusal refusal);
  Progress read_head();

  const std::vector<std::string>* names_;
  Progress progress_ = Progress::empty;
  std::string bytes_;
  std::string head_;           ///< as it is printed anew, without its end
  std::size_t body_size_ = 0;  ///< bytes that the head announces
  bool keeps_alive_ = true;
  bool expects_leave_ = false;
  HeadRefusal refusal_{};
};

}  // namespace repose::server
