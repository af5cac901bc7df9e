// What a hostile client may do to the sockets: the server answers others all the while, and its
// memory stays where it was.

#include "server/api/transport.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <fstream>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <catch2/catch.hpp>

#include "server/api/http_server.hpp"
#include "tests/support/wire.hpp"

namespace {

using namespace std::chrono_literals;
using namespace repose::tests;
using repose::server::HttpOptions;
using repose::server::HttpServer;
using repose::server::Reply;
using repose::server::Request;
using repose::server::TransportLimits;

const std::string live = "GET /livez HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";
const std::string begun = "GET /x HTTP/1.1\r\nHost: localhost\r\n";

TransportLimits hasty() {
  TransportLimits limits;
  limits.threads = 2;
  limits.head = limits.body = 200ms;
  limits.idle = 500ms;
  return limits;
}

class Running {
 public:
  explicit Running(const TransportLimits& limits = hasty())
      : server_([this](const Request& request) { return answer(request); },
                HttpOptions{.limits = limits}),
        thread_([this] { server_.run(); }) {}
  ~Running() {
    release();
    server_.stop();
    thread_.join();
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  [[nodiscard]] int port() const { return server_.port(); }
  [[nodiscard]] bool is_alive() const { return has(talk(port(), live), "alive"); }
  [[nodiscard]] repose::server::TransportFigures figures() const { return server_.figures(); }
  /// Requests for /wait that a thread has taken up.
  [[nodiscard]] int in_work() const { return in_work_; }
  /// Lets the requests for /wait end.
  void release() {
    {
      const std::scoped_lock hold(mutex_);
      released_ = true;
    }
    changed_.notify_all();
  }
  void say(const std::string& text) {
    const std::scoped_lock hold(mutex_);
    said_ += text;
  }

 private:
  Reply answer(const Request& request) {
    if (request.path == "/large") return {.body = std::string(4U << 20U, 'x')};
    if (request.path == "/wait") {
      std::unique_lock hold(mutex_);
      ++in_work_;
      changed_.wait(hold, [this] { return released_; });
    }
    if (request.path != "/stream") return {.status = 200, .body = "alive"};
    return {.status = 200,
            .body = "hello\n\n",
            .content_type = "text/event-stream",
            .stream = [this, at = std::size_t{0}]() mutable {
              const std::scoped_lock hold(mutex_);
              std::string rest = said_.substr(at);
              at = said_.size();
              return rest;
            }};
  }

  std::atomic<int> in_work_ = 0;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool released_ = false;
  std::string said_;
  HttpServer server_;
  std::thread thread_;
};

/// Of this process, which is the server's too, in bytes.
std::size_t memory() {
  std::ifstream file("/proc/self/statm");
  std::size_t all = 0, resident = 0;
  file >> all >> resident;
  return resident * 4096;
}

std::vector<Wire> wires(int port, int count, const std::string& first) {
  std::vector<Wire> result;
  for (int i = 0; i < count; ++i) {
    result.emplace_back(port);
    result.back().send(first);
  }
  return result;
}

}  // namespace

TEST_CASE("clients that send their heads slowly keep nobody waiting, and are told off",
          "[server]") {
  const Running server;
  const auto slow = wires(server.port(), 100, begun);
  CHECK(server.is_alive());
  for (int i = 0; i < 10; ++i) {  // a field now and then does not win time
    for (const Wire& wire : slow) wire.send("X-More: y\r\n");
  }
  for (const Wire& wire : slow) {
    CHECK(has(wire.until("too-slow"), "HTTP/1.1 408"));
  }
  CHECK(server.is_alive());
}

TEST_CASE("a body that does not come is given up", "[server]") {
  const Running server;
  const auto slow = wires(
      server.port(), 20, "POST /x HTTP/1.1\r\nHost: localhost\r\nContent-Length: 100\r\n\r\nabc");
  CHECK(server.is_alive());
  for (const Wire& wire : slow) {
    const std::string refusal = wire.rest();
    CHECK(has(refusal, "HTTP/1.1 408"));
    CHECK(has(refusal, "X-Request-Id: "));
  }
}

TEST_CASE("a thousand connections on which nothing comes keep nobody out", "[server]") {
  TransportLimits limits = hasty();
  limits.connections = 200;
  limits.idle = 60s;
  const Running server(limits);
  const auto half_open = wires(server.port(), 1000, "");
  CHECK(server.is_alive());
  CHECK(server.figures().connections <= 200);
}

TEST_CASE("an endless head costs its limit of memory", "[server]") {
  const Running server;
  const std::size_t before = memory();
  const Wire line(server.port());
  line.send("GET /x HTTP/1.1\r\nX-Long: ");
  const std::string block(1U << 20U, 'x');
  for (int i = 0; i < 64; ++i) line.send(block);
  CHECK(has(line.rest(), "HTTP/1.1 431"));
  const Wire fields(server.port());
  fields.send(begun);
  std::string many;
  for (int i = 0; i < 10000; ++i) many += "X-Many: y\r\n";
  for (int i = 0; i < 100; ++i) fields.send(many);
  CHECK(has(fields.rest(), "HTTP/1.1 431"));
  CHECK(server.is_alive());
  CHECK(memory() < before + (32U << 20U));
}

TEST_CASE("a body in chunks is refused whatever its length", "[server]") {
  const Running server;
  const std::size_t before = memory();
  const Wire wire(server.port());
  wire.send("POST /x HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n");
  const std::string chunk = "100000\r\n" + std::string(1U << 20U, 'x') + "\r\n";
  for (int i = 0; i < 64; ++i) wire.send(chunk);
  CHECK(has(wire.rest(), "HTTP/1.1 411"));
  CHECK(memory() < before + (32U << 20U));
}

TEST_CASE("bodies under way have a bound in all", "[server]") {
  TransportLimits limits = hasty();
  limits.memory = 4U << 20U;
  limits.body = 10s;
  const Running server(limits);
  const std::string announced =
      "POST /x HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1000000\r\n\r\n";
  const auto taken = wires(server.port(), 4, announced + std::string(1000, 'x'));
  CHECK(server.is_alive());  // those four have been read by now
  CHECK(has(talk(server.port(), announced), "HTTP/1.1 503"));
  CHECK(server.is_alive());
}

TEST_CASE("answers that nobody reads are given up when they fill the memory", "[server]") {
  TransportLimits limits = hasty();
  limits.memory = 16U << 20U;
  const Running server(limits);
  const std::string ask = "GET /large HTTP/1.1\r\nHost: localhost\r\n\r\n";
  const auto deaf = wires(server.port(), 30, ask);
  for (int i = 0; i < 100000 && server.figures().connections > 6; ++i) REQUIRE(server.is_alive());
  CHECK(server.figures().connections <= 6);
}

TEST_CASE("a request that waits holds up no other, and too many are refused", "[server]") {
  TransportLimits limits = hasty();
  limits.waiting = 4;
  limits.head = limits.idle = 60s;
  Running server(limits);
  const std::string wait = "GET /wait HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";
  std::vector<Wire> waiting = wires(server.port(), 2, wait);  // one for each thread
  while (server.in_work() < 2) std::this_thread::yield();
  for (std::size_t i = 1; i <= 4; ++i) {
    waiting.emplace_back(server.port());
    waiting.back().send(wait);
    while (server.figures().waiting < i) std::this_thread::yield();
  }
  const std::string refused = talk(server.port(), wait);
  CHECK(has(refused, "HTTP/1.1 503"));
  CHECK(has(refused, "Retry-After: 1"));
  server.release();
  for (const Wire& wire : waiting) CHECK(has(wire.rest(), "alive"));
}

TEST_CASE("two hundred streams are open, others are answered, and one more is refused",
          "[server]") {
  Running server;
  const std::string ask = "GET /stream HTTP/1.1\r\nHost: localhost\r\n\r\n";
  const auto streams = wires(server.port(), 200, ask);
  for (const Wire& wire : streams) CHECK(has(wire.until("hello"), "text/event-stream"));
  CHECK(server.figures().streams == 200);
  CHECK(server.is_alive());
  CHECK(has(talk(server.port(), ask), "HTTP/1.1 503"));
  server.say("data: 1\n\n");
  for (const Wire& wire : streams) CHECK(has(wire.until("data: 1"), "data: 1"));
}

TEST_CASE("a stream on which nothing happens beats, and its place is free when it ends",
          "[server]") {
  TransportLimits limits = hasty();
  limits.streams = 1;
  limits.heartbeat = 50ms;
  const Running server(limits);
  const std::string ask = "GET /stream HTTP/1.1\r\nHost: localhost\r\n\r\n";
  {
    const Wire wire(server.port());
    wire.send(ask);
    CHECK(has(wire.until("\n:\n"), "hello"));
    CHECK(has(wire.until(":\n\n"), ":\n\n"));
  }
  while (server.figures().streams > 0) std::this_thread::yield();
  const Wire again(server.port());
  again.send(ask);
  CHECK(has(again.until("hello"), "200 OK"));
}

TEST_CASE("HEAD of a stream ends", "[server]") {
  const Running server;
  const std::string answer =
      talk(server.port(), "HEAD /stream HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
  CHECK(has(answer, "200 OK"));
  CHECK(!has(answer, "hello"));
}

TEST_CASE("a flood on one connection is answered in order", "[server]") {
  const Running server;
  const Wire wire(server.port());
  std::string flood;
  for (int i = 0; i < 500; ++i) flood += "GET /livez HTTP/1.1\r\nHost: localhost\r\n\r\n";
  wire.send(flood + live);
  const std::string answers = wire.rest();
  std::size_t count = 0;
  for (auto at = answers.find("200 OK"); at != std::string::npos;
       at = answers.find("200 OK", at + 1)) {
    ++count;
  }
  CHECK(count == 501);
  CHECK(server.is_alive());
}

TEST_CASE("a client that sends no more is still answered", "[server]") {
  const Running server;
  const Wire wire(server.port());
  wire.send("GET /livez HTTP/1.1\r\nHost: localhost\r\n\r\n");
  wire.end();
  CHECK(has(wire.rest(), "alive"));
}

TEST_CASE("leave to send a body is given when its head is good, and refused when not", "[server]") {
  const Running server;
  const std::string head = "POST /x HTTP/1.1\r\nHost: localhost\r\nExpect: 100-continue\r\n";
  const Wire good(server.port());
  good.send(head + "Content-Length: 3\r\nConnection: close\r\n\r\n");
  CHECK(has(good.until("\r\n\r\n"), "100 Continue"));
  good.send("abc");
  CHECK(has(good.rest(), "alive"));
  const std::string refused = talk(server.port(), head + "Content-Length: 3000000\r\n\r\n");
  CHECK(has(refused, "HTTP/1.1 413"));
  CHECK(!has(refused, "100 Continue"));
}

TEST_CASE("a server that stops finishes what is in work and ends its streams", "[server]") {
  HttpServer server(
      [](const Request& request) {
        Reply reply{.status = 200, .body = "alive"};
        if (request.path == "/stream") reply.stream = [] { return std::string(); };
        return reply;
      },
      HttpOptions{.limits = hasty()});
  std::thread thread([&] { server.run(); });
  const Wire stream(server.port()), idle(server.port());
  stream.send("GET /stream HTTP/1.1\r\nHost: localhost\r\n\r\n");
  CHECK(has(stream.until("alive"), "200"));
  server.stop();
  thread.join();
  CHECK(stream.rest().empty());
  CHECK(idle.rest().empty());
}
