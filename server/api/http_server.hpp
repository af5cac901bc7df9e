/// HttpServer: the API on a socket. Loopback unless told otherwise; for a network, put a proxy in
/// front that encrypts and limits each client.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "server/api/route.hpp"
#include "server/api/transport.hpp"

namespace repose::server {

struct HttpOptions {
  std::string host = "127.0.0.1";
  int port = 0;  ///< 0: any that is free
  std::vector<std::string> names =
      {};  ///< hosts to answer for, beside `host` and the loopback's names
  TransportLimits limits = {};
};

class HttpServer {
 public:
  using Responder = std::function<Reply(Request)>;

  /// Binds the port. Throws std::runtime_error that names it where it is taken.
  HttpServer(Api& api, const HttpOptions& options);
  HttpServer(Responder responder, const HttpOptions& options);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  [[nodiscard]] int port() const;

  /// Answers requests until stop(), then finishes those in work and ends the streams.
  void run();
  /// From any thread, also before run().
  void stop();

  [[nodiscard]] TransportFigures figures() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace repose::server
