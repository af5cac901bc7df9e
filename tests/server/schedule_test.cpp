#include "server/jobs/schedule.hpp"

#include <catch2/catch.hpp>

using repose::server::Schedule;

TEST_CASE("calibrations run one at a time in the order of submission", "[server]") {
  Schedule schedule;
  CHECK_FALSE(schedule.next().has_value());
  schedule.submit(7);
  schedule.submit(3);
  schedule.submit(7);  // waits already
  CHECK(schedule.next() == 7);
  CHECK_FALSE(schedule.next().has_value());
  schedule.submit(7);  // runs already
  schedule.finished();
  CHECK(schedule.next() == 3);
  schedule.finished();
  CHECK_FALSE(schedule.next().has_value());
}

TEST_CASE("a waiting calibration is taken out, a running one is left to its runner", "[server]") {
  Schedule schedule;
  schedule.submit(1);
  schedule.submit(2);
  CHECK(schedule.next() == 1);
  CHECK(schedule.cancel(2) == Schedule::Cancelled::waiting);
  CHECK(schedule.cancel(2) == Schedule::Cancelled::unknown);
  CHECK(schedule.cancel(1) == Schedule::Cancelled::running);
  CHECK(schedule.running() == 1);
  schedule.finished();
  CHECK_FALSE(schedule.ready());
}
