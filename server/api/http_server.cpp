#include "server/api/http_server.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <iostream>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <utility>

#include <httplib.h>

#include "server/api/guard.hpp"
#include "server/api/problem.hpp"

namespace repose::server {

namespace {

constexpr std::size_t threads = 32;       // one request each; a slow client holds one
constexpr std::size_t keep_alive = 1000;  // requests a connection; the library's 5 cost a thousand
                                          // fold in requests per second
constexpr std::time_t read_seconds = 5;   // without a byte
constexpr std::time_t write_seconds = 10;

RequestHead head_of(const httplib::Request& request) {
  // The library puts its own notes on both ends among the fields.
  static constexpr std::array<std::string_view, 4> notes{
      "REMOTE_ADDR", "REMOTE_PORT", "LOCAL_ADDR", "LOCAL_PORT"};
  RequestHead head{request.method, {}, request.ranges.size()};
  for (const auto& [name, value] : request.headers) {
    if (std::ranges::find(notes, std::string_view(name)) == notes.end()) {
      head.fields.emplace_back(name, value);
    }
  }
  return head;
}

Request request_of(const httplib::Request& request) {
  return {.method = request.method,
          .path = request.path,
          .query = request.params,
          .content_type = request.get_header_value("Content-Type"),
          .body = request.body};
}

void send(const Reply& reply, httplib::Response& response) {
  response.status = reply.status;
  for (const auto& [name, value] : reply.headers) response.set_header(name, value);
  response.set_content(reply.body, reply.content_type);
}

/// Answers and closes the connection. The library closes it only where writing fails: so the body
/// is written, and then said to have failed. What is left of the request is thus never read as the
/// next one.
void send_and_close(const Reply& reply, httplib::Request& request, httplib::Response& response) {
  response.status = reply.status;
  response.set_header("Connection", "close");
  response.set_content_provider(
      reply.body.size(),
      reply.content_type,
      [body = reply.body](std::size_t, std::size_t, httplib::DataSink& sink) {
        sink.write(body.data(), body.size());
        return false;
      });
  // An answer to HEAD has no body, so nothing would fail.
  if (request.method == "HEAD") request.method = "GET";
}

/// Without the library's SO_REUSEPORT, with which two servers share a port unawares.
void set_socket_options(socket_t socket) {
  const int on = 1;
  setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
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

/// Gives the port back also where nobody ever listened on it.
class Listener : public httplib::Server {
 public:
  Listener() = default;
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;
  ~Listener() override {
    const socket_t socket = svr_sock_.exchange(INVALID_SOCKET);
    if (socket != INVALID_SOCKET) ::close(socket);
  }
};

}  // namespace

struct HttpServer::State {
  Listener http;
  Responder responder;
  std::vector<std::string> names;
  int port = 0;
  std::atomic<bool> entered = false;
  std::atomic<bool> stopped = false;
  std::atomic<bool> finished = false;

  void set_limits() {
    http.new_task_queue = [] { return new httplib::ThreadPool(threads); };
    http.set_payload_max_length(largest_body);
    http.set_tcp_nodelay(true);
    http.set_keep_alive_max_count(keep_alive);
    http.set_read_timeout(read_seconds);
    http.set_write_timeout(write_seconds);
    http.set_socket_options(set_socket_options);
    http.set_default_headers({{"X-Content-Type-Options", "nosniff"},
                              {"Referrer-Policy", "no-referrer"},
                              {"Cache-Control", "no-store"}});
  }

  void set_handlers() {
    using Handled = httplib::Server::HandlerResponse;
    http.set_pre_routing_handler([this](const httplib::Request& given,
                                        httplib::Response& response) {
      auto refusal = refuse(head_of(given), names);
      // The library's own variable, handed on as a constant. Answers are whole: a range would be
      // cut out of them, problems included.
      auto& request = const_cast<httplib::Request&>(given);
      request.ranges.clear();
      if (!refusal) return Handled::Unhandled;
      send_and_close(problem_reply(refusal->status, std::move(refusal->detail)), request, response);
      return Handled::Handled;
    });
    http.set_exception_handler([](const httplib::Request& request,
                                  httplib::Response& response,
                                  const std::exception_ptr& thrown) {
      log_exception(request, thrown);
      send(problem_reply(500, "The service failed; its log says why."), response);
    });
    const httplib::Server::HandlerWithResponse explain = [](const httplib::Request&,
                                                            httplib::Response& response) {
      if (!response.body.empty() || response.content_provider_) return Handled::Unhandled;
      send(problem_reply(response.status, "The request was refused before it was read."), response);
      return Handled::Handled;
    };
    http.set_error_handler(explain);
    const httplib::Server::Handler answer = [this](const httplib::Request& request,
                                                   httplib::Response& response) {
      send(responder(request_of(request)), response);
    };
    // One pattern for all: paths are told apart by our own table.
    http.Get(".*", answer).Options(".*", answer);
    http.Post(".*", answer).Put(".*", answer).Patch(".*", answer).Delete(".*", answer);
  }
};

HttpServer::HttpServer(Responder responder, const HttpOptions& options)
    : state_(std::make_unique<State>()) {
  std::signal(SIGPIPE, SIG_IGN);  // a client that left is no reason to end
  State& state = *state_;
  state.responder = std::move(responder);
  state.names = options.names;
  const bool is_v6 = options.host.find(':') != std::string::npos;
  state.names.push_back(is_v6 ? "[" + options.host + "]" : options.host);
  state.set_limits();
  state.set_handlers();
  errno = 0;
  if (options.port == 0) {
    state.port = state.http.bind_to_any_port(options.host);
  } else if (state.http.bind_to_port(options.host, options.port)) {
    state.port = options.port;
  } else {
    state.port = -1;
  }
  if (state.port <= 0) {
    const std::error_code error = errno == 0
                                      ? std::make_error_code(std::errc::address_not_available)
                                      : std::error_code(errno, std::system_category());
    throw std::system_error(error,
                            "cannot listen on " + options.host + ":" +
                                std::to_string(options.port) + " (choose with --host, --port)");
  }
}

HttpServer::HttpServer(Service& service, const HttpOptions& options)
    : HttpServer([&service](Request request) { return respond(service, std::move(request)); },
                 options) {}

HttpServer::~HttpServer() = default;

int HttpServer::port() const { return state_->port; }

void HttpServer::run() {
  state_->entered = true;
  if (!state_->stopped) state_->http.listen_after_bind();
  state_->finished = true;
}

void HttpServer::stop() {
  state_->stopped = true;
  // The library forgets a stop that comes before it listens.
  while (state_->entered && !state_->finished && !state_->http.is_running()) {
    std::this_thread::yield();
  }
  state_->http.stop();
}

}  // namespace repose::server
