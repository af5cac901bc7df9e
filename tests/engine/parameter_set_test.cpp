#include "engine/parameter_set.hpp"

#include <catch2/catch.hpp>

using namespace repose::engine;

TEST_CASE("a pair's key does not depend on the order of its materials", "[engine]") {
  const auto a = make_key("sliding_friction.coefficient", {MaterialId::wall, MaterialId::grain});
  const auto b = make_key("sliding_friction.coefficient", {MaterialId::grain, MaterialId::wall});
  CHECK(a == b);
  CHECK(to_string(a) == "sliding_friction.coefficient:grain-wall");
  CHECK(to_string(make_key("material.density", {MaterialId::grain})) == "material.density:grain");
  CHECK(to_string(make_key("gravity.tilt", {})) == "gravity.tilt");
}

TEST_CASE("sets with the same values are equal, whatever the order of setting", "[engine]") {
  ParameterSet a, b;
  const auto x = make_key("a.x", {});
  const auto y = make_key("a.y", {});
  a.set(x, 1.0);
  a.set(y, 2.0);
  b.set(y, 2.0);
  b.set(x, 0.0);
  CHECK_FALSE(a == b);
  b.set(x, 1.0);
  CHECK(a == b);
  CHECK(a.get(x) == 1.0);
  CHECK_FALSE(a.get(make_key("a.z", {})).has_value());
  a.erase(x);
  CHECK(a.get_or(x, 5.0) == 5.0);
}
