#include "server/api/answering.hpp"

#include <utility>

namespace repose::server {

Answering::Answering(std::size_t threads, Transport::Answer answer, std::function<void()> wake)
    : answer_(std::move(answer)), wake_(std::move(wake)) {
  for (std::size_t i = 0; i < threads; ++i) {
    threads_.emplace_back([this](const std::stop_token& stop) { work(stop); });
  }
}

void Answering::ask(std::uint64_t id, WholeRequest request) {
  {
    const std::scoped_lock hold(mutex_);
    questions_.push_back({id, std::move(request)});
  }
  asked_.notify_one();
}

std::deque<Answering::Done> Answering::take() {
  const std::scoped_lock hold(mutex_);
  return std::exchange(done_, {});
}

std::size_t Answering::waiting() const {
  const std::scoped_lock hold(mutex_);
  return questions_.size();
}

void Answering::work(const std::stop_token& stop) {
  std::unique_lock hold(mutex_);
  while (asked_.wait(hold, stop, [this] { return !questions_.empty(); })) {
    const Question question = std::move(questions_.front());
    questions_.pop_front();
    hold.unlock();
    Output output = answer_(question.request.text, question.request.keeps_alive);
    hold.lock();
    done_.push_back({question.id, std::move(output)});
    hold.unlock();
    wake_();
    hold.lock();
  }
}

}  // namespace repose::server
