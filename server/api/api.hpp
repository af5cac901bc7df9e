/// Api: what every request has in common, whatever its route: who asks, whether it was asked
/// before, whether the thing has changed since the client read it, and what is noted of it.
#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "server/access/tokens.hpp"
#include "server/api/metrics.hpp"
#include "server/api/route.hpp"

namespace repose::server {

/// A name for a request whose client gives it none that can be repeated.
std::string new_request_id();

class Api {
 public:
  /// Without tokens anyone may do anything: for a service that only this machine reaches.
  explicit Api(Service& service, Tokens* tokens = nullptr) : service_(service), tokens_(tokens) {}

  /// Never throws.
  Reply respond(Request request);

  /// Where the figures of the sockets come from.
  void watch(std::function<TransportFigures()> sockets) { sockets_ = std::move(sockets); }
  [[nodiscard]] std::string metrics() const;

 private:
  std::optional<Reply> refuse(const Route& route, Request& request);
  void watch_reader(const Route& route, const Request& request, Reply& reply);
  Reply answer(const Route& route, Request& request);
  Reply once(const Route& route, const Request& request);
  Reply change(const Route& route, const Request& request);
  bool is_there(const Request& request);
  std::optional<Reply> refuse_unread(const Request& request);

  Service& service_;
  Tokens* tokens_;
  Metrics metrics_;
  std::function<TransportFigures()> sockets_;
  std::mutex changes_;  ///< one at a time: what one has looked at no other changes meanwhile
};

}  // namespace repose::server
