#include "server/report/label.hpp"

#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

using repose::calibrator::Measurement;
using repose::server::distinction_label;

namespace {

Measurement drum(std::map<std::string, double> settings) {
  Measurement measurement;
  measurement.experiment = {"drum", {}, std::move(settings)};
  measurement.observable = "dynamic_angle";
  return measurement;
}

}  // namespace

TEST_CASE("a measurement is told from its like by what differs between them", "[server]") {
  constexpr double rpm = std::numbers::pi / 30.0;
  const std::vector<Measurement> drums{drum({{"diameter", 0.1}, {"speed", 15.0 * rpm}}),
                                       drum({{"diameter", 0.1}, {"speed", 60.0 * rpm}}),
                                       drum({{"diameter", 0.1}})};
  CHECK(distinction_label(drums, drums[1]) == "speed 60 rpm");
  CHECK(
      distinction_label(drums, drums[2]).starts_with("speed "));  // the usual one, which they lack
  CHECK(distinction_label({drums.data(), 1}, drums[0]) == "diameter 100 mm, speed 15 rpm");
  CHECK(distinction_label({}, drum({})).empty());
}
