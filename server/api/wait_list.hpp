/// WaitList: what Linux is to report of sockets (epoll), and a way to be woken from another thread.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <span>
#include <sys/epoll.h>

namespace repose::server {

class WaitList {
 public:
  /// The number under which a call of wake() is reported.
  static constexpr std::uint64_t woken = 1;

  WaitList();
  ~WaitList();
  WaitList(const WaitList&) = delete;
  WaitList& operator=(const WaitList&) = delete;

  void add(int socket, std::uint32_t events, std::uint64_t id);
  void change(int socket, std::uint32_t events, std::uint64_t id);
  void remove(int socket);

  /// From any thread.
  void wake() const;

  /// What has happened, at the latest after that time; a negative one is for ever.
  std::span<const epoll_event> wait(std::chrono::milliseconds longest);

 private:
  void control(int operation, int socket, std::uint32_t events, std::uint64_t id) const;

  int epoll_;
  int waker_;
  std::array<epoll_event, 128> events_{};
};

}  // namespace repose::server
