#include "server/jobs/job_queue.hpp"

#include <catch2/catch.hpp>

using repose::server::Job;
using repose::server::JobQueue;

namespace {

constexpr Job calibration(std::int64_t id) { return {Job::Kind::calibration, id}; }
constexpr Job diagnosis(std::int64_t id) { return {Job::Kind::diagnosis, id}; }

}  // namespace

TEST_CASE("jobs run one at a time in the order of submission", "[server]") {
  JobQueue queue;
  CHECK_FALSE(queue.next().has_value());
  queue.submit(calibration(7));
  queue.submit(calibration(3));
  queue.submit(calibration(7));  // waits already
  CHECK(queue.next() == calibration(7));
  CHECK_FALSE(queue.next().has_value());
  queue.submit(calibration(7));  // runs already
  queue.finished();
  CHECK(queue.next() == calibration(3));
  queue.finished();
  CHECK_FALSE(queue.next().has_value());
}

TEST_CASE("a waiting calibration is taken out, a running one is left to its runner", "[server]") {
  JobQueue queue;
  queue.submit(calibration(1));
  queue.submit(calibration(2));
  CHECK(queue.next() == calibration(1));
  CHECK(queue.cancel(calibration(2)) == JobQueue::Cancelled::waiting);
  CHECK(queue.cancel(calibration(2)) == JobQueue::Cancelled::unknown);
  CHECK(queue.cancel(calibration(1)) == JobQueue::Cancelled::running);
  CHECK(queue.running() == calibration(1));
  queue.finished();
  CHECK_FALSE(queue.ready());
}

TEST_CASE("a diagnosis and a calibration of one number are two jobs", "[server]") {
  JobQueue queue;
  queue.submit(calibration(5));
  queue.submit(diagnosis(5));
  CHECK(queue.next() == calibration(5));
  CHECK(queue.cancel(diagnosis(5)) == JobQueue::Cancelled::waiting);
  CHECK(queue.running() == calibration(5));
}
