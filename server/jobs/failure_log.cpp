#include "server/jobs/failure_log.hpp"

#include <exception>
#include <iostream>

namespace repose::server {

bool FailureLog::run(const std::string& name, const std::function<void()>& work) {
  try {
    work();
  } catch (const std::exception& problem) {
    const std::scoped_lock hold(mutex_);
    std::string& last = failures_[name];
    if (last != problem.what())
      std::clog << "repose: " + name + " failed: " + problem.what() + "\n";
    last = problem.what();
    return false;
  }
  const std::scoped_lock hold(mutex_);
  failures_.erase(name);
  return true;
}

bool FailureLog::empty() const {
  const std::scoped_lock hold(mutex_);
  return failures_.empty();
}

}  // namespace repose::server
