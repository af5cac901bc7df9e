#include "calibrator/diagnosis/suspect.hpp"

#include <algorithm>

#include <catch2/catch.hpp>

using namespace repose;
using namespace repose::calibrator;
using engine::MaterialId;
using engine::ParameterKey;

namespace {

const ParameterKey grains{"sliding_friction.coefficient", {MaterialId::grain, MaterialId::grain}};
const ParameterKey wall{"sliding_friction.coefficient", {MaterialId::grain, MaterialId::wall}};

/// Friction of grains free from 0.2 to 0.8, measured at these moistures.
Calibration study(const std::vector<double>& moistures) {
  Calibration calibration;
  calibration.free.push_back({grains, 0.2, 0.8, Scale::linear, {}});
  for (const double moisture : moistures) {
    Measurement measurement;
    measurement.experiment = {"drop", engine::Fidelity::draft, {{"moisture", moisture}}};
    measurement.observable = "restitution";
    calibration.measurements.push_back(measurement);
  }
  return calibration;
}

engine::ParameterSet best(double of_grains, double of_wall) {
  engine::ParameterSet set;
  set.set(grains, of_grains);
  set.set(wall, of_wall);
  return set;
}

const Suspect* find(const std::vector<Suspect>& suspects, std::string_view name) {
  const auto found = std::ranges::find(suspects, name, &Suspect::name);
  return found == suspects.end() ? nullptr : &*found;
}

}  // namespace

TEST_CASE("a wall whose friction is tied or set equal to the grains' is suspected",
          "[calibrator]") {
  Calibration tied = study({0.1});
  tied.tied.push_back({wall, grains, 0.7});
  CHECK(find(suspects_of(tied, best(0.5, 0.35)), own_wall_friction) != nullptr);
  Calibration equal = study({0.1});
  equal.free.clear();
  equal.fixed = best(0.5, 0.5);
  CHECK(find(suspects_of(equal, best(0.5, 0.5)), own_wall_friction) != nullptr);
}

TEST_CASE("a wall whose friction is known apart, or free, is not", "[calibrator]") {
  Calibration known = study({0.1});
  known.fixed.set(wall, 0.3);
  CHECK(find(suspects_of(known, best(0.5, 0.3)), own_wall_friction) == nullptr);
  Calibration open = study({0.1});
  open.free.push_back({wall, 0.2, 0.8, Scale::linear, {}});
  CHECK(find(suspects_of(open, best(0.5, 0.5)), own_wall_friction) == nullptr);
}

TEST_CASE("a wall friction of its own is freed from the tie", "[calibrator]") {
  Calibration tied = study({0.1});
  tied.tied.push_back({wall, grains, 1.0});
  const auto suspects = suspects_of(tied, best(0.5, 0.5));
  extend(*find(suspects, own_wall_friction), best(0.5, 0.5), tied);
  CHECK(tied.tied.empty());
  CHECK(std::ranges::count(tied.free, wall, &FreeParameter::key) == 1);
}

TEST_CASE("effects of moisture need measurements at more than one", "[calibrator]") {
  for (const char* name : {"moisture_softening", "moisture_friction", "moisture_density"}) {
    const auto one = suspects_of(study({0.1, 0.1}), best(0.5, 0.5));
    REQUIRE(find(one, name) != nullptr);
    CHECK(find(one, name)->objection.find("same moisture") != std::string::npos);
    const auto two = suspects_of(study({0.1, 0.2}), best(0.5, 0.5));
    REQUIRE(find(two, name) != nullptr);
    CHECK(find(two, name)->objection.empty());
  }
  const auto drag = suspects_of(study({0.1}), best(0.5, 0.5));
  CHECK(find(drag, "air_drag")->objection.empty());
}

TEST_CASE("what an effect leaves alone is kept out of the search", "[calibrator]") {
  Calibration calibration = study({0.1, 0.2});
  const auto suspects = suspects_of(calibration, best(0.5, 0.5));
  extend(*find(suspects, "moisture_softening"), best(0.5, 0.5), calibration);
  const ParameterKey reference{"moisture_softening.reference", {MaterialId::grain}};
  CHECK(calibration.fixed.get(reference) == 0.12);
  CHECK(std::ranges::count(calibration.free, reference, &FreeParameter::key) == 0);
}

TEST_CASE("the moisture at which a model is meant is no effect, and is kept", "[calibrator]") {
  Calibration calibration = study({0.1, 0.2});
  const ParameterKey reference{"moisture_density.reference", {MaterialId::grain}};
  calibration.fixed.set(reference, 0.07);
  const auto suspects = suspects_of(calibration, best(0.5, 0.5));
  REQUIRE(find(suspects, "moisture_density") != nullptr);
  extend(*find(suspects, "moisture_density"), best(0.5, 0.5), calibration);
  CHECK(calibration.fixed.get(reference) == 0.07);
  CHECK(calibration.free.back().key.field == "moisture_density.rate");
}

TEST_CASE("an effect that may go either way is looked for on both sides", "[calibrator]") {
  Calibration calibration = study({0.1, 0.2});
  const auto suspects = suspects_of(calibration, best(0.5, 0.3));
  CHECK(find(suspects, "moisture_density")->two_sided);
  for (const Suspect& other : suspects) {
    CAPTURE(other.name);
    if (other.name != "moisture_density") CHECK_FALSE(other.two_sided);
  }
  extend(*find(suspects, "moisture_density"), best(0.5, 0.3), calibration);
  CHECK(calibration.free.back().lower < 0.0);
  CHECK(calibration.free.back().upper > 0.0);
}
