#include "server/nightly/promotion.hpp"

#include <cmath>

#include <catch2/catch.hpp>

using namespace repose::server;

namespace {

Contender contender(double z, double width) {
  return {.fits = true, .held_out = {{z, 0.1}}, .widths = {width, 0.2}};
}

}  // namespace

TEST_CASE("a fit is promoted where its error is not worse and its intervals are not wider",
          "[server]") {
  CHECK(judge(contender(0.5, 0.3), contender(2.0, 0.3)).promoted);
  CHECK(judge(contender(0.5, 0.1), contender(0.5, 0.3)).promoted);
  // Worse by less than the replicates can tell, wider by less than a twentieth.
  CHECK(judge(contender(0.6, 0.31), contender(0.5, 0.3)).promoted);
}

TEST_CASE("a fit waits as a candidate, and the reason says why", "[server]") {
  Contender misses = contender(0.1, 0.1);
  misses.fits = false;
  CHECK_FALSE(judge(misses, contender(3.0, 0.9)).promoted);
  CHECK_THAT(judge(misses, contender(3.0, 0.9)).reason, Catch::Contains("more than chance"));
  const Promotion worse = judge(contender(0.8, 0.3), contender(0.5, 0.3));
  CHECK_FALSE(worse.promoted);
  CHECK_THAT(worse.reason, Catch::Contains("worse: 0.8 against 0.5"));
  const Promotion wider = judge(contender(0.5, 0.4), contender(0.5, 0.3));
  CHECK_FALSE(wider.promoted);
  CHECK_THAT(wider.reason, Catch::Contains("1.1547 times as wide"));
}

TEST_CASE("an error that is no number is never good enough", "[server]") {
  CHECK_FALSE(judge(contender(std::nan(""), 0.1), contender(3.0, 0.9)).promoted);
}

TEST_CASE("the error of several measurements is their root mean square", "[server]") {
  const Residual error = error_of({{3.0, 0.1}, {-4.0, 0.1}});
  CHECK(error.z == Approx(std::sqrt(12.5)));
  CHECK(error.standard_error == Approx(0.1 / std::sqrt(2.0)));
  CHECK(error_of({{0.0, 0.2}}).standard_error == Approx(0.2));
}
