#include "engine/unit.hpp"

#include <set>

#include <catch2/catch.hpp>

using namespace repose::engine;

TEST_CASE("every unit is found by its symbol, and no two share one", "[engine]") {
  std::set<std::string_view> symbols;
  for (const Unit& u : unit::all()) {
    CAPTURE(u.symbol);
    CHECK(symbols.insert(u.symbol).second);
    REQUIRE(unit::find(u.symbol).has_value());
    CHECK(*unit::find(u.symbol) == u);
    CHECK(u.factor > 0.0);
  }
  CHECK_FALSE(unit::find("furlong").has_value());
}

TEST_CASE("a degree is not a plain number", "[engine]") {
  CHECK_FALSE(unit::degree.dimension == unit::one.dimension);
  CHECK(unit::degree.dimension == unit::radian.dimension);
  CHECK(180.0 * unit::degree.factor == Approx(unit::pi));
  CHECK(60.0 * unit::revolution_per_minute.factor == Approx(2.0 * unit::pi));
}
