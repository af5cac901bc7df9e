#include "calibrator/phrase.hpp"

#include <catch2/catch.hpp>

using namespace repose;
using calibrator::counted;
using calibrator::enumerate;
using calibrator::joined;
using calibrator::number;
using calibrator::quantity;

TEST_CASE("a number keeps the digits before its point, however few figures are asked for",
          "[calibrator]") {
  CHECK(number(0.012345, 3) == "0.0123");
  CHECK(number(1.5, 2) == "1.5");
  CHECK(number(163.5, 2) == "164");
  CHECK(number(-1234.4, 2) == "-1234");
  CHECK(number(1e300, 2) == "1e+300");  // longer than any sentence bears
}

TEST_CASE("a quantity is told in the unit of its measurement", "[calibrator]") {
  CHECK(quantity(0.05, engine::unit::millimetre, 3) == "50 mm");
  CHECK(quantity(0.912, engine::unit::one, 2) == "0.91");
}

TEST_CASE("one thing is not many", "[calibrator]") {
  CHECK(counted(1, "run") == "1 run");
  CHECK(counted(0, "run") == "0 runs");
}

TEST_CASE("the last of several things is joined by a word", "[calibrator]") {
  CHECK(enumerate({}).empty());
  CHECK(enumerate({"a"}) == "a");
  CHECK(enumerate({"a", "b"}) == "a and b");
  CHECK(enumerate({"a", "b", "c"}) == "a, b and c");
  CHECK(joined({"a", "b", "c"}, "; ") == "a; b; c");
}
