#include "calibrator/remarks.hpp"

#include <catch2/catch.hpp>

using namespace repose;
using namespace repose::calibrator;
using engine::make_key;
using engine::MaterialId;

TEST_CASE("a parameter is named by its materials and its field", "[calibrator]") {
  CHECK(parameter_name(
            make_key("sliding_friction.coefficient", {MaterialId::wall, MaterialId::grain})) ==
        "grain-wall sliding_friction.coefficient");
  CHECK(parameter_name(make_key("material.density", {MaterialId::grain})) ==
        "grain material.density");
  CHECK(parameter_name(make_key("size_spread.deviation", {})) == "size_spread.deviation");
}

TEST_CASE("a budget too small says what would do", "[calibrator]") {
  Calibration c;
  c.free.resize(5);
  c.budget.evaluations = 6;
  CHECK(budget_too_small(c, 11) ==
        "The budget of 6 evaluations is too small: 5 free parameters need at least 11.");
}
