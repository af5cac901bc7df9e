#include "server/jobs/failure_log.hpp"

#include <stdexcept>
#include <string>

#include <catch2/catch.hpp>

#include "tests/support/captured_log.hpp"

using repose::server::FailureLog;
using repose::tests::CapturedLog;

TEST_CASE("a failure is told once, until it is another or was over", "[server]") {
  const CapturedLog log;
  FailureLog failures;
  const auto fail = [&](const char* name, const char* why) {
    CHECK_FALSE(failures.run(name, [&] { throw std::runtime_error(why); }));
  };
  fail("this", "full");
  fail("this", "full");
  fail("that", "full");
  fail("this", "broken");
  CHECK_FALSE(failures.empty());
  CHECK(failures.run("this", [] {}));
  CHECK_FALSE(failures.empty());
  fail("this", "broken");
  CHECK(failures.run("this", [] {}));
  CHECK(failures.run("that", [] {}));
  CHECK(failures.empty());
  CHECK(log.text() ==
        "repose: this failed: full\n"
        "repose: that failed: full\n"
        "repose: this failed: broken\n"
        "repose: this failed: broken\n");
}
