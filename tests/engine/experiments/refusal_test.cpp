// Apparatus that cannot work is refused before it runs, with the reason and what would be right.
#include "engine/refusal.hpp"

#include <map>
#include <string>

#include <catch2/catch.hpp>

#include "engine/evaluate.hpp"
#include "tests/support/reference_grain.hpp"

using namespace repose::engine;

namespace {

Failure refused(const std::string& experiment, const std::map<std::string, double>& settings) {
  const Evaluation evaluation =
      evaluate({repose::tests::reference_grain(), {experiment, Fidelity::draft, settings}, 1});
  CHECK(evaluation.effort.inserted == 0);
  const auto* failure = std::get_if<Failure>(&evaluation.outcome);
  REQUIRE(failure != nullptr);
  CHECK(failure->kind == FailureKind::bad_input);
  return *failure;
}

}  // namespace

TEST_CASE("a length is refused only below its number of grains, and every one is named",
          "[engine]") {
  CHECK(too_short({{"width", 0.030, 5.0}, {"depth", 0.0181, 3.0}}, 0.006).empty());
  const std::string problems =
      too_short({{"width", 0.0299, 5.0}, {"depth", 0.1, 3.0}, {"slot", 0.004, 2.5}}, 0.006);
  CHECK(problems ==
        "width = 29.9 mm must be at least 30 mm, which is 5 of the largest grains of 6 mm; "
        "slot = 4 mm must be at least 15 mm, which is 2.5 of the largest grains of 6 mm");
}

TEST_CASE("apparatus too small for its grains is refused with the smallest that works",
          "[engine]") {
  using Catch::Contains;
  CHECK_THAT(refused("kettle", {{"diameter", 0.020}}).message,
             Contains("diameter = 20 mm must be at least 32.48 mm"));
  CHECK_THAT(refused("kettle", {{"opening", 0.010}}).message,
             Contains("opening = 10 mm must be at least 19.49 mm"));
  CHECK_THAT(refused("kettle", {{"opening", 0.5}}).message,
             Contains("opening = 500 mm pours beside the kettle"));
  CHECK_THAT(refused("tilting_box", {{"width", 0.010}}).message,
             Contains("width = 10 mm must be at least 19.49 mm"));
  CHECK_THAT(refused("tilting_box", {{"rate", 0.0}}).message, Contains("rate = 0"));
}
