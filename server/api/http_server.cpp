#include "server/api/http_server.hpp"

#include <cerrno>
#include <csignal>
#include <iostream>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <httplib.h>

#include "server/api/api.hpp"
#include "server/api/guard.hpp"
#include "server/api/problem.hpp"
#include "server/api/reply_text.hpp"
#include "server/letters.hpp"

namespace repose::server {

namespace {

Request request_of(const httplib::Request& request) {
  Request result{.method = request.method,
                 .path = request.path,
                 .query = request.params,
                 .content_type = request.get_header_value("Content-Type"),
                 .body = request.body};
  for (const auto& [name, value] : request.headers) result.fields[lower_case(name)] = value;
  return result;
}

void send(const Reply& reply, httplib::Response& response) {
  response.status = reply.status;
  for (const auto& [name, value] : reply.headers) response.set_header(name, value);
  response.set_content(reply.body, reply.content_type);
}

/// Without the library's SO_REUSEPORT, with which two servers share a port unawares.
void set_socket_options(socket_t socket) {
  const int on = 1;
  setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
}

/// Of a request that did not come as far as the API, which gives the others their identity.
Reply unread_refusal(int status, const std::string& detail) {
  Reply reply = problem_reply(status, detail);
  reply.headers.emplace_back("X-Request-Id", new_request_id());
  return reply;
}

/// Says what happened to the log, and nothing of it to the client.
void log_exception(const httplib::Request& request, const std::exception_ptr& thrown) {
  std::string what = "an unknown exception";
  try {
    std::rethrow_exception(thrown);
  } catch (const std::exception& error) {
    what = error.what();
  } catch (...) {  // NOLINT(bugprone-empty-catch): the text above says it
  }
  std::clog << "http: " + request.method + " " + request.path + " failed: " + what + "\n";
}

/// A request that has come whole, and room for its answer: the library reads and writes memory.
class MemoryStream final : public httplib::Stream {
 public:
  explicit MemoryStream(std::string_view request) : request_(request) {}
  [[nodiscard]] bool is_readable() const override { return !request_.empty(); }
  [[nodiscard]] bool is_writable() const override { return true; }
  ssize_t read(char* to, std::size_t size) override {
    const std::size_t count = request_.copy(to, size);
    request_.remove_prefix(count);
    return static_cast<ssize_t>(count);
  }
  ssize_t write(const char* from, std::size_t size) override {
    answer_.append(from, size);
    return static_cast<ssize_t>(size);
  }
  void get_remote_ip_and_port(std::string& /*ip*/, int& /*port*/) const override {}
  void get_local_ip_and_port(std::string& /*ip*/, int& /*port*/) const override {}
  [[nodiscard]] socket_t socket() const override { return INVALID_SOCKET; }
  [[nodiscard]] std::string take() { return std::move(answer_); }

 private:
  std::string_view request_;
  std::string answer_;
};

/// The reply of the request that this thread works on, where it is a stream: the library's handlers
/// have no other way to hand one on.
thread_local Reply stream_reply;  // NOLINT: each thread has its own

/// The library behind our own sockets: it binds, parses, decodes and prints.
class Library : public httplib::Server {
 public:
  Library() = default;
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
  /// Gives the port back.
  ~Library() override {
    const socket_t socket = svr_sock_.exchange(INVALID_SOCKET);
    if (socket != INVALID_SOCKET) ::close(socket);
  }

  [[nodiscard]] int listener() const { return svr_sock_; }

  Output answer(const std::string& request, bool keeps_alive) {
    MemoryStream stream(request);
    stream_reply = {};
    bool closes = false;
    const bool answered = process_request(stream, !keeps_alive, closes, nullptr);
    if (stream_reply.stream) {
      return {print_stream_head(stream_reply), false, std::move(stream_reply.stream)};
    }
    return {stream.take(), answered && !closes};
  }
};

}  // namespace

struct HttpServer::State {
  Library http;
  Responder responder;
  int port = 0;
  std::unique_ptr<Transport> transport;

  void set_handlers() {
    using Handled = httplib::Server::HandlerResponse;
    http.set_payload_max_length(largest_body);
    http.set_socket_options(set_socket_options);
    http.set_default_headers({{"X-Content-Type-Options", "nosniff"},
                              {"Referrer-Policy", "no-referrer"},
                              {"Cache-Control", "no-store"}});
    http.set_exception_handler([](const httplib::Request& request,
                                  httplib::Response& response,
                                  const std::exception_ptr& thrown) {
      log_exception(request, thrown);
      send(problem_reply(500, "The service failed; its log says why."), response);
    });
    const httplib::Server::HandlerWithResponse explain = [](const httplib::Request&,
                                                            httplib::Response& response) {
      if (!response.body.empty()) return Handled::Unhandled;
      send(unread_refusal(response.status, "The request was refused before it was read."),
           response);
      return Handled::Handled;
    };
    http.set_error_handler(explain);
    const httplib::Server::Handler answer = [this](const httplib::Request& request,
                                                   httplib::Response& response) {
      Reply reply = responder(request_of(request));
      send(reply, response);
      if (reply.stream && request.method != "HEAD") stream_reply = std::move(reply);
    };
    // One pattern for all: paths are told apart by our own table.
    http.Get(".*", answer).Options(".*", answer);
    http.Post(".*", answer).Put(".*", answer).Patch(".*", answer).Delete(".*", answer);
  }

  void bind(const HttpOptions& options) {
    errno = 0;
    if (options.port == 0) {
      port = http.bind_to_any_port(options.host);
    } else if (http.bind_to_port(options.host, options.port)) {
      port = options.port;
    } else {
      port = -1;
    }
    if (port > 0) return;
    const std::error_code error = errno == 0
                                      ? std::make_error_code(std::errc::address_not_available)
                                      : std::error_code(errno, std::system_category());
    throw std::system_error(error,
                            "cannot listen on " + options.host + ":" +
                                std::to_string(options.port) + " (choose with --host, --port)");
  }
};

HttpServer::HttpServer(Responder responder, const HttpOptions& options)
    : state_(std::make_unique<State>()) {
  std::signal(SIGPIPE, SIG_IGN);  // a client that left is no reason to end
  State& state = *state_;
  state.responder = std::move(responder);
  state.set_handlers();
  state.bind(options);
  std::vector<std::string> names = options.names;
  const bool is_v6 = options.host.find(':') != std::string::npos;
  names.push_back(is_v6 ? "[" + options.host + "]" : options.host);
  state.transport = std::make_unique<Transport>(
      state.http.listener(),
      std::move(names),
      options.limits,
      [&state](const std::string& request, bool keeps_alive) {
        return state.http.answer(request, keeps_alive);
      },
      [](int status, const std::string& detail) {
        Reply reply = unread_refusal(status, detail);
        if (status == 503) reply.headers.emplace_back("Retry-After", "1");
        return print_last_reply(reply);
      });
}

HttpServer::HttpServer(Api& api, const HttpOptions& options)
    : HttpServer([&api](Request request) { return api.respond(std::move(request)); }, options) {
  api.watch([transport = state_->transport.get()] { return transport->figures(); });
}

HttpServer::~HttpServer() = default;

int HttpServer::port() const { return state_->port; }

void HttpServer::run() { state_->transport->run(); }

void HttpServer::stop() { state_->transport->stop(); }

TransportFigures HttpServer::figures() const { return state_->transport->figures(); }

}  // namespace repose::server
