#include "server/api/transport.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <deque>
#include <fcntl.h>
#include <map>
#include <mutex>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <optional>
#include <sys/socket.h>
#include <unistd.h>
#include <utility>

#include "server/api/answering.hpp"
#include "server/api/connection.hpp"
#include "server/api/wait_list.hpp"

namespace repose::server {

namespace {

using Clock = Connection::Clock;
using std::chrono::milliseconds;

constexpr std::uint64_t listener_id = 0;     // 1 is the wait list's own; connections follow
constexpr milliseconds tick{100};            // how late a deadline may be noticed
constexpr milliseconds last_answers{10000};  // for the requests in work when the server stops
constexpr int accepts_a_round = 64;  // so that a flood of connections starves none that is there

}  // namespace

struct Transport::State {
  State(int the_listener,
        std::vector<std::string> the_names,
        const TransportLimits& the_limits,
        Answer answer,
        Refuse the_refuse)
      : listener(the_listener),
        names(std::move(the_names)),
        limits(the_limits),
        refuse(std::move(the_refuse)),
        pump(limits.pump,
             [this](std::uint64_t id, std::optional<std::string> text) {
               deliver(id, std::move(text));
             }),
        answering(limits.threads, std::move(answer), [this] { waits.wake(); }) {
    fcntl(listener, F_SETFL, fcntl(listener, F_GETFL) | O_NONBLOCK);
    ::listen(listener, SOMAXCONN);  // the library's own backlog is 5
    waits.add(listener, EPOLLIN, listener_id);
  }

  void listen_for(const Connection& c, std::uint32_t events) {
    waits.change(c.socket, events, c.id);
  }
  void deliver(std::uint64_t id, std::optional<std::string> text) {
    {
      const std::scoped_lock hold(mutex);
      delivered.emplace_back(id, std::move(text));
    }
    waits.wake();
  }

  void run();
  void react(const epoll_event& event);
  void accept_some();
  bool make_room();
  void drop(std::uint64_t id);
  void receive(Connection& c);
  void read_on(Connection& c);
  void begin_work(Connection& c);
  void refuse_with(Connection& c, const HeadRefusal& refusal);
  void write(Connection& c);
  void after_writing(Connection& c);
  void take_answers();
  void begin_stream(Connection& c, Output output);
  void take_deliveries();
  void check_deadlines();
  void pass_deadline(Connection& c, Clock::time_point now);
  [[nodiscard]] std::size_t held() const;
  [[nodiscard]] bool busy() const;
  void begin_to_stop();

  int listener;
  std::vector<std::string> names;
  TransportLimits limits;
  Refuse refuse;
  WaitList waits;
  std::map<std::uint64_t, Connection> connections;
  std::uint64_t next_id = 2;
  std::atomic<bool> stopping = false;
  std::atomic<std::size_t> connected = 0, streams = 0;
  std::mutex mutex;
  std::deque<std::pair<std::uint64_t, std::optional<std::string>>> delivered;
  StreamPump pump;      // with its thread
  Answering answering;  // with its threads
};

void Transport::State::drop(std::uint64_t id) {
  const auto found = connections.find(id);
  if (found == connections.end()) return;
  if (found->second.phase == Phase::streaming) {
    pump.remove(id);
    --streams;
  }
  ::close(found->second.socket);
  connections.erase(found);
  connected = connections.size();
}

/// Closes the connection that has been reading for longest; false where all have work.
bool Transport::State::make_room() {
  const Connection* oldest = nullptr;
  for (const auto& [id, c] : connections) {
    if (c.phase != Phase::reading && c.phase != Phase::leaving) continue;
    if (oldest == nullptr || c.since < oldest->since) oldest = &c;
  }
  if (oldest == nullptr) return false;
  drop(oldest->id);
  return true;
}

void Transport::State::accept_some() {
  for (int i = 0; i < accepts_a_round; ++i) {
    const int socket = accept4(listener, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (socket < 0) {
      // Out of descriptors: one more is free when the oldest has gone.
      if (errno == EMFILE || errno == ENFILE) make_room();
      return;
    }
    if (connections.size() >= limits.connections && !make_room()) {
      ::close(socket);
      continue;
    }
    const int on = 1;
    setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    const std::uint64_t id = next_id++;
    connections.emplace(
        id,
        Connection{
            .id = id, .socket = socket, .reader = RequestReader(names), .since = Clock::now()});
    connected = connections.size();
    waits.add(socket, EPOLLIN, id);
  }
}

void Transport::State::receive(Connection& c) {
  std::array<char, 16384> block{};
  const ssize_t count = recv(c.socket, block.data(), block.size(), 0);
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return;
  if (count <= 0) {
    drop(c.id);
  } else if (c.phase == Phase::reading) {
    c.reader.append({block.data(), static_cast<std::size_t>(count)});
    read_on(c);
  }  // of a stream's client and of one that is leaving nothing more is read
}

/// Takes the request on as far as its bytes reach.
void Transport::State::read_on(Connection& c) {
  const auto before = c.reader.progress();
  const auto now = c.reader.advance();
  if (now != before) c.since = Clock::now();
  if (now == RequestReader::Progress::refused) return refuse_with(c, c.reader.refusal());
  if (now == RequestReader::Progress::whole) return begin_work(c);
  if (now != RequestReader::Progress::body) return;
  if (before != now && held() > limits.memory) {
    return refuse_with(c, {503, "Too much is under way; try again in a second."});
  }
  if (c.reader.take_expectation()) {
    static constexpr std::string_view leave = "HTTP/1.1 100 Continue\r\n\r\n";
    ::send(c.socket, leave.data(), leave.size(), MSG_NOSIGNAL);
  }
}

void Transport::State::begin_work(Connection& c) {
  if (answering.waiting() >= limits.waiting) {
    return refuse_with(c, {503, "Too many requests wait; try again in a second."});
  }
  WholeRequest request = c.reader.take();
  c.keeps_alive = request.keeps_alive && !stopping;
  c.enter(Phase::working);
  listen_for(c, 0);  // what comes meanwhile stays with the system
  answering.ask(c.id, std::move(request));
}

void Transport::State::refuse_with(Connection& c, const HeadRefusal& refusal) {
  c.out = refuse(refusal.status, refusal.detail);
  c.written = 0;
  c.keeps_alive = false;  // where the next request begins is not certain
  c.enter(Phase::writing);
  write(c);
}

void Transport::State::write(Connection& c) {
  while (c.written < c.out.size()) {
    const ssize_t count =
        ::send(c.socket, c.out.data() + c.written, c.out.size() - c.written, MSG_NOSIGNAL);
    if (count < 0 && errno == EAGAIN) {
      return listen_for(c, c.phase == Phase::streaming ? EPOLLIN | EPOLLOUT : EPOLLOUT);
    }
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return drop(c.id);
    c.written += static_cast<std::size_t>(count);
    c.since = Clock::now();
  }
  c.out.clear();
  c.out.shrink_to_fit();
  c.written = 0;
  after_writing(c);
}

void Transport::State::after_writing(Connection& c) {
  listen_for(c, EPOLLIN);
  if (c.phase == Phase::streaming) return pump.ready(c.id);
  if (!c.keeps_alive || stopping) {
    // Closing at once would take the answer from a client that is still sending.
    shutdown(c.socket, SHUT_WR);
    return c.enter(Phase::leaving);
  }
  c.enter(Phase::reading);
  read_on(c);  // the next request may be here
}

void Transport::State::begin_stream(Connection& c, Output output) {
  if (streams >= limits.streams) {
    return refuse_with(
        c, {503, "All " + std::to_string(limits.streams) + " event streams are taken."});
  }
  ++streams;
  c.out = std::move(output.text);
  c.enter(Phase::streaming);
  pump.add(c.id, std::move(output.stream));
  write(c);
}

void Transport::State::take_answers() {
  for (auto& [id, output] : answering.take()) {
    const auto found = connections.find(id);
    if (found == connections.end()) continue;  // the client has left
    Connection& c = found->second;
    if (output.stream) {
      begin_stream(c, std::move(output));
      continue;
    }
    c.keeps_alive = c.keeps_alive && output.keeps_alive;
    c.out = std::move(output.text);
    c.written = 0;
    c.enter(Phase::writing);
    write(c);
  }
}

void Transport::State::take_deliveries() {
  std::deque<std::pair<std::uint64_t, std::optional<std::string>>> texts;
  {
    const std::scoped_lock hold(mutex);
    texts.swap(delivered);
  }
  for (auto& [id, text] : texts) {
    const auto found = connections.find(id);
    if (found == connections.end()) continue;
    if (!text) {
      drop(id);
      continue;
    }
    found->second.out += *text;
    write(found->second);
  }
}

void Transport::State::pass_deadline(Connection& c, Clock::time_point now) {
  if (c.phase == Phase::streaming && c.out.empty()) {
    c.since = now;
    c.out =
        ":\n\n";  // a comment: it keeps proxies from closing, and shows whether the client lives
    return write(c);
  }
  const bool has_begun = c.reader.progress() != RequestReader::Progress::empty;
  if (c.phase == Phase::reading && has_begun) {
    return refuse_with(c, {408, "The request did not come whole in time."});
  }
  drop(c.id);
}

void Transport::State::check_deadlines() {
  const auto now = Clock::now();
  std::vector<std::uint64_t> late;
  for (const auto& [id, c] : connections) {
    if (c.phase != Phase::working && now - c.since >= patience(c, limits)) late.push_back(id);
  }
  for (const std::uint64_t id : late) {
    if (const auto found = connections.find(id); found != connections.end()) {
      pass_deadline(found->second, now);
    }
  }
  // Answers that nobody reads must not fill the memory.
  while (held() > limits.memory) {
    const auto largest = std::ranges::max_element(
        connections, {}, [](const auto& entry) { return entry.second.out.size(); });
    if (largest == connections.end() || largest->second.out.empty()) break;
    drop(largest->first);
  }
}

std::size_t Transport::State::held() const {
  std::size_t bytes = 0;
  for (const auto& [id, c] : connections) bytes += c.size();
  return bytes;
}

bool Transport::State::busy() const {
  return std::ranges::any_of(connections, [](const auto& entry) {
    return entry.second.phase == Phase::working || entry.second.phase == Phase::writing;
  });
}

void Transport::State::react(const epoll_event& event) {
  const std::uint64_t id = event.data.u64;
  if (id == listener_id) return accept_some();
  if (id == WaitList::woken) {
    take_answers();
    take_deliveries();
    return;
  }
  const auto found = connections.find(id);
  if (found == connections.end()) return;
  Connection& c = found->second;
  if ((event.events & (EPOLLERR | EPOLLHUP)) != 0) return drop(id);
  if ((event.events & EPOLLOUT) != 0) return write(c);
  if ((event.events & EPOLLIN) != 0) receive(c);
}

/// Takes no more; what is in work is finished.
void Transport::State::begin_to_stop() {
  waits.remove(listener);
  std::vector<std::uint64_t> done;
  for (const auto& [id, c] : connections) {
    if (c.phase != Phase::working && c.phase != Phase::writing) done.push_back(id);
  }
  for (const std::uint64_t id : done) drop(id);
}

void Transport::State::run() {
  auto last_look = Clock::now();
  std::optional<Clock::time_point> end;
  while (true) {
    if (stopping && !end) {
      begin_to_stop();
      end = Clock::now() + last_answers;
    }
    if (end && (!busy() || Clock::now() >= *end)) break;
    const bool idle = connections.empty() && !end;
    for (const epoll_event& event : waits.wait(idle ? milliseconds(-1) : tick)) react(event);
    if (Clock::now() - last_look < tick) continue;
    last_look = Clock::now();
    check_deadlines();
  }
  while (!connections.empty()) drop(connections.begin()->first);
}

Transport::Transport(int listener,
                     std::vector<std::string> names,
                     const TransportLimits& limits,
                     Answer answer,
                     Refuse refuse)
    : state_(std::make_unique<State>(
          listener, std::move(names), limits, std::move(answer), std::move(refuse))) {}
Transport::~Transport() = default;

void Transport::run() { state_->run(); }

void Transport::stop() {
  state_->stopping = true;
  state_->waits.wake();
}

TransportFigures Transport::figures() const {
  return {state_->connected, state_->streams, state_->answering.waiting()};
}

}  // namespace repose::server
