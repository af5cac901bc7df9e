#include "server/jobs/schedule.hpp"

#include <catch2/catch.hpp>

using repose::server::Job;
using repose::server::Schedule;

namespace {

constexpr Job calibration(std::int64_t id) { return {Job::Kind::calibration, id}; }
constexpr Job diagnosis(std::int64_t id) { return {Job::Kind::diagnosis, id}; }

}  // namespace

TEST_CASE("jobs run one at a time in the order of submission", "[server]") {
  Schedule schedule;
  CHECK_FALSE(schedule.next().has_value());
  schedule.submit(calibration(7));
  schedule.submit(calibration(3));
  schedule.submit(calibration(7));  // waits already
  CHECK(schedule.next() == calibration(7));
  CHECK_FALSE(schedule.next().has_value());
  schedule.submit(calibration(7));  // runs already
  schedule.finished();
  CHECK(schedule.next() == calibration(3));
  schedule.finished();
  CHECK_FALSE(schedule.next().has_value());
}

TEST_CASE("a waiting calibration is taken out, a running one is left to its runner", "[server]") {
  Schedule schedule;
  schedule.submit(calibration(1));
  schedule.submit(calibration(2));
  CHECK(schedule.next() == calibration(1));
  CHECK(schedule.cancel(calibration(2)) == Schedule::Cancelled::waiting);
  CHECK(schedule.cancel(calibration(2)) == Schedule::Cancelled::unknown);
  CHECK(schedule.cancel(calibration(1)) == Schedule::Cancelled::running);
  CHECK(schedule.running() == calibration(1));
  schedule.finished();
  CHECK_FALSE(schedule.ready());
}

TEST_CASE("a diagnosis and a calibration of one number are two jobs", "[server]") {
  Schedule schedule;
  schedule.submit(calibration(5));
  schedule.submit(diagnosis(5));
  CHECK(schedule.next() == calibration(5));
  CHECK(schedule.cancel(diagnosis(5)) == Schedule::Cancelled::waiting);
  CHECK(schedule.running() == calibration(5));
}
