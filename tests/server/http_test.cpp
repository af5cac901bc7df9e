#include <atomic>
#include <stdexcept>
#include <string>
#include <thread>

#include <catch2/catch.hpp>

#include "server/api/http_server.hpp"
#include "tests/support/wire.hpp"

namespace {

using repose::server::HttpOptions;
using repose::server::HttpServer;
using repose::server::Reply;
using repose::server::Request;
using namespace repose::tests;

/// A server that answers with what it was asked.
class Running {
 public:
  explicit Running(const HttpOptions& options = {})
      : server_([this](const Request& request) { return answer(request); }, options),
        thread_([this] { server_.run(); }) {}
  ~Running() {
    server_.stop();
    thread_.join();
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  [[nodiscard]] int port() const { return server_.port(); }
  [[nodiscard]] int answered() const { return answered_; }

 private:
  Reply answer(const Request& request) {
    ++answered_;
    if (request.path == "/throw") throw std::runtime_error("a secret");
    return {.status = 200,
            .body = request.method + " " + request.path + " " + std::to_string(request.body.size()),
            .content_type = "text/plain"};
  }

  std::atomic<int> answered_ = 0;
  HttpServer server_;
  std::thread thread_;
};

const std::string get = "GET /x HTTP/1.1\r\nHost: localhost\r\n";
const std::string head = "HEAD /x HTTP/1.1\r\nHost: localhost\r\n";
const std::string post = "POST /x HTTP/1.1\r\nHost: localhost\r\n";

}  // namespace

TEST_CASE("a request is answered, and its answer may not be sniffed or stored", "[server]") {
  const Running server;
  const std::string answer = talk(server.port(), get + "Connection: close\r\n\r\n");
  CHECK(has(status_line(answer), "200"));
  CHECK(has(answer, "GET /x 0"));
  CHECK(has(answer, "X-Content-Type-Options: nosniff"));
  CHECK(has(answer, "Cache-Control: no-store"));
}

TEST_CASE("a connection carries many requests", "[server]") {
  const Running server;
  const Wire wire(server.port());
  for (int i = 0; i < 20; ++i) {
    wire.send(post + "Content-Length: 3\r\n\r\nabc");
    CHECK(has(wire.until("POST /x 3"), "200 OK"));
  }
}

TEST_CASE("hostile requests are refused with a problem, and the connection is closed", "[server]") {
  struct Attack {
    const char* status;
    std::string request;
  };
  const std::string lines = [] {
    std::string fields;
    for (int i = 0; i < 100; ++i) fields += "X-Many: y\r\n";
    return fields;
  }();
  const std::string smuggled = "GET /smuggled HTTP/1.1\r\nHost: localhost\r\n\r\n";
  const Running server;
  for (const auto& [status, request] : {
           Attack{"411", text(post, "Transfer-Encoding: chunked\r\n\r\n0\r\n\r\n", smuggled)},
           Attack{"411",
                  text(post,
                       "Content-Length: 6\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n",
                       smuggled)},
           Attack{"411", text(post, "\r\n", smuggled)},
           Attack{"400", text(post, "Content-Length: 6\r\nContent-Length: 3\r\n\r\nabc", smuggled)},
           Attack{"400", text(post, "Content-Length: -1\r\n\r\n", smuggled)},
           Attack{"400", text(get, "Content-Length: 48\r\n\r\n", smuggled)},
           Attack{"400", text(head, "Content-Length: 48\r\n\r\n", smuggled)},
           Attack{"415", text(post, "Content-Length: 6\r\nContent-Encoding: gzip\r\n\r\nabcdef")},
           Attack{"416", text(get, "Range: bytes=0-,0-,0-,0-\r\n\r\n")},
           Attack{"400", "GET /x HTTP/1.1\r\n\r\n"},
           Attack{"400", text(get, "Host: localhost\r\n\r\n")},
           Attack{"421", "GET /x HTTP/1.1\r\nHost: evil.example\r\n\r\n"},
           Attack{"431", text(get, lines, "\r\n")},
           Attack{"400", text(get, "X-Test: a\rEvil: 1\r\n\r\n")},
           Attack{"400", text(get, "X Test: a\r\n\r\n")},
           Attack{"400", text(get, "X-Test : a\r\n\r\n")},
           Attack{"400", text(get, "X-Test: a\r\n folded: b\r\n\r\n")},
           Attack{"400", "GET http://localhost/x HTTP/1.1\r\nHost: localhost\r\n\r\n"},
           Attack{"400", "GET /x HTTP/2.0\r\nHost: localhost\r\n\r\n"},
           Attack{"400", "GET  /x HTTP/1.1\r\nHost: localhost\r\n\r\n"},
           Attack{"400", "GET /x y HTTP/1.1\r\nHost: localhost\r\n\r\n"},
           Attack{"400", "\x16\x03\x01 TLS\r\n\r\n"},
           Attack{"414", "GET /" + std::string(9000, 'x') + " HTTP/1.1\r\n\r\n"},
           Attack{"431", text(get, "X-Long: " + std::string(17000, 'x') + "\r\n\r\n")},
       }) {
    INFO(request);
    const std::string answer = talk(server.port(), request);
    CHECK(has(status_line(answer), status));
    CHECK(has(answer, "application/problem+json"));
    CHECK(has(answer, "\"status\":" + std::string(status)));
  }
  CHECK(server.answered() == 0);
}

TEST_CASE("a body larger than a mebibyte is refused", "[server]") {
  const Running server;
  const auto send = [&](std::size_t size) {
    return talk(server.port(),
                post + "Connection: close\r\nContent-Length: " + std::to_string(size) + "\r\n\r\n" +
                    std::string(size, 'x'));
  };
  CHECK(has(status_line(send(1U << 20U)), "200"));
  const std::string answer = send((1U << 20U) + 1);
  CHECK(has(status_line(answer), "413"));
  CHECK(has(answer, "urn:repose:problem:too-large"));
}

TEST_CASE("what a failing handler says stays in the log", "[server]") {
  const Running server;
  const std::string answer =
      talk(server.port(), "GET /throw HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
  CHECK(has(status_line(answer), "500"));
  CHECK(has(answer, "urn:repose:problem:internal"));
  CHECK(!has(answer, "secret"));
}

TEST_CASE("a method that nobody knows is a bad request with a problem", "[server]") {
  const Running server;
  const std::string answer =
      talk(server.port(), "BREW /x HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
  CHECK(has(status_line(answer), "400"));
  CHECK(has(answer, "application/problem+json"));
}

TEST_CASE("the name that was bound is answered for, and those that are given", "[server]") {
  const Running server({.host = "127.0.0.1", .port = 0, .names = {"dem.example"}});
  const std::string answer =
      talk(server.port(), "GET /x HTTP/1.1\r\nHost: dem.example:80\r\nConnection: close\r\n\r\n");
  CHECK(has(status_line(answer), "200"));
}

TEST_CASE("a port that is taken is an error that names it", "[server]") {
  const Running first;
  const std::string port = std::to_string(first.port());
  try {
    const HttpServer second([](const Request&) { return Reply{}; }, {.port = first.port()});
    FAIL("two servers share the port");
  } catch (const std::runtime_error& error) {
    CHECK(has(error.what(), "127.0.0.1:" + port));
    CHECK(has(error.what(), "in use"));
  }
}

TEST_CASE("a server that never ran gives its port back", "[server]") {
  int port = 0;
  {
    const HttpServer idle([](const Request&) { return Reply{}; }, {});
    port = idle.port();
  }
  const Running next({.port = port});
  CHECK(next.port() == port);
}

TEST_CASE("a server that is stopped before it runs does not run", "[server]") {
  HttpServer server([](const Request&) { return Reply{}; }, {});
  server.stop();
  server.run();
}
