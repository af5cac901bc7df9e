#include "server/api/wait_list.hpp"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <sys/eventfd.h>
#include <system_error>
#include <unistd.h>

namespace repose::server {

WaitList::WaitList()
    : epoll_(epoll_create1(EPOLL_CLOEXEC)), waker_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  if (epoll_ < 0 || waker_ < 0) {
    throw std::system_error(errno, std::generic_category(), "cannot wait for connections");
  }
  add(waker_, EPOLLIN, woken);
}

WaitList::~WaitList() {
  close(waker_);
  close(epoll_);
}

void WaitList::control(int operation, int socket, std::uint32_t events, std::uint64_t id) const {
  epoll_event event{};
  event.events = events;
  event.data.u64 = id;
  epoll_ctl(epoll_, operation, socket, &event);
}

void WaitList::add(int socket, std::uint32_t events, std::uint64_t id) {
  control(EPOLL_CTL_ADD, socket, events, id);
}

void WaitList::change(int socket, std::uint32_t events, std::uint64_t id) {
  control(EPOLL_CTL_MOD, socket, events, id);
}

void WaitList::remove(int socket) { control(EPOLL_CTL_DEL, socket, 0, 0); }

void WaitList::wake() const {
  const std::uint64_t one = 1;
  [[maybe_unused]] const auto count = write(waker_, &one, sizeof one);
}

std::span<const epoll_event> WaitList::wait(std::chrono::milliseconds longest) {
  const int count = epoll_wait(
      epoll_, events_.data(), static_cast<int>(events_.size()), static_cast<int>(longest.count()));
  const std::span<const epoll_event> happened(events_.data(),
                                              static_cast<std::size_t>(std::max(count, 0)));
  for (const epoll_event& event : happened) {
    std::uint64_t calls = 0;
    if (event.data.u64 == woken) {
      [[maybe_unused]] const auto size = read(waker_, &calls, sizeof calls);
    }
  }
  return happened;
}

}  // namespace repose::server
