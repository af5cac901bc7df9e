#include <cmath>
#include <random>

#include <catch2/catch.hpp>

#include "engine/material.hpp"
#include "server/json/codec.hpp"

namespace {

using repose::server::exact_unit;
using repose::server::exactly_in;
using repose::server::in_unit;
using repose::server::Json;
using repose::server::Place;
using repose::server::print_field;
using repose::server::ProblemList;
using repose::server::Problems;
using repose::server::read_field;
namespace engine = repose::engine;
namespace unit = repose::engine::unit;

const engine::FieldInfo length{
    .name = "length", .unit = unit::millimetre, .meaning = "a length", .lower = 1e-3, .upper = 0.1};
constexpr std::array<std::string_view, 2> colours{"red", "blue"};
const engine::FieldInfo colour{.name = "colour", .unit = {}, .meaning = "", .choices = colours};

struct Read {
  std::optional<double> value;
  Problems problems;
};

Read read(const char* text, const engine::FieldInfo& field) {
  const Json json = Json::parse(text);
  ProblemList problems;
  const auto value = read_field(Place(&json, "/x", problems), field, "box");
  return {value, problems.all()};
}

}  // namespace

TEST_CASE("a number is converted to SI by its unit", "[server]") {
  CHECK(read(R"({"value": 2, "unit": "cm"})", length).value == 2 * 1e-2);
  CHECK(read(R"({"unit": "in", "value": 0.5})", length).value == 0.5 * 0.0254);
}

TEST_CASE("a bound is told in the unit of the user", "[server]") {
  const Problems problems = read(R"({"value": 20, "unit": "cm"})", length).problems;
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == "/x/value");
  CHECK(problems[0].found == "20 cm");
  CHECK(problems[0].allowed == "0.1 to 10 cm");
}

TEST_CASE("a unit of another dimension is refused with those that are allowed", "[server]") {
  const Problems problems = read(R"({"value": 2, "unit": "deg"})", length).problems;
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == "/x/unit");
  CHECK(problems[0].allowed == "m, cm, mm, um, in");
}

TEST_CASE("degrees are no plain numbers", "[server]") {
  const engine::FieldInfo plain{.name = "plain", .unit = unit::one, .meaning = ""};
  CHECK(read(R"({"value": 2, "unit": "deg"})", plain).problems.size() == 1);
  CHECK(read(R"({"value": 20, "unit": "%"})", plain).value == 20 * 0.01);
}

TEST_CASE("a number without its unit is refused", "[server]") {
  for (const char* text : {"2",
                           "\"2 mm\"",
                           "null",
                           "[2, \"mm\"]",
                           R"({"value": 2})",
                           R"({"unit": "mm"})",
                           R"({"value": "2", "unit": "mm"})",
                           R"({"value": 2, "unit": "mm", "error": 1})"}) {
    CHECK(read(text, length).problems.size() == 1);
  }
}

TEST_CASE("how a number is written is told in its form, each unit in quotes", "[server]") {
  CHECK(read("2", length).problems.at(0).allowed ==
        R"({"value": number, "unit": "m" or "cm" or "mm" or "um" or "in"})");
  const engine::FieldInfo plain{.name = "plain", .unit = unit::one, .meaning = ""};
  CHECK(read("2", plain).problems.at(0).allowed == R"({"value": number, "unit": "1" or "%"})");
}

TEST_CASE("a choice is read and printed by its name", "[server]") {
  CHECK(read("\"blue\"", colour).value == 1.0);
  CHECK(print_field(1.0, colour) == "blue");
  CHECK(read("1", colour).problems.at(0).allowed == "red, blue");
}

TEST_CASE("what a user wrote in any unit is written again as they wrote it", "[server]") {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> digits(1.0, 10.0);
  for (const engine::Unit& each : unit::all()) {
    for (int i = 0; i < 2000; ++i) {
      const double rounded = std::round(digits(random) * 1e4) / 1e4;
      CHECK(exactly_in(rounded * each.factor, each) == rounded);
    }
  }
}

TEST_CASE("every double is printed so that it reads back exactly", "[server]") {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> power(-9.0, 9.0);
  for (const auto& field : engine::material_fields) {
    for (int i = 0; i < 2000; ++i) {
      const double value = std::pow(10.0, power(random));
      const engine::Unit printed_in = exact_unit(value, field.info.unit);
      const Json json = Json::parse(repose::server::to_text(print_field(value, field.info)));
      CHECK(json["unit"] == printed_in.symbol);
      CHECK(json["value"].get<double>() * printed_in.factor == value);
    }
  }
}

TEST_CASE("nothing has no sign", "[server]") {
  for (const char* symbol : {"mm", "%", "deg", "1"}) {
    CHECK(in_unit(0.0, *engine::unit::find(symbol)).dump() == "0.0");
    CHECK(in_unit(-0.0, *engine::unit::find(symbol)).dump() == "0.0");
  }
  CHECK(in_unit(-0.002, *engine::unit::find("mm")).dump() == "-2.0");
}

TEST_CASE("a number that is none is null", "[server]") {
  CHECK(repose::server::in_unit(std::nan(""), unit::degree).is_null());
  CHECK(repose::server::in_unit(INFINITY, unit::degree).is_null());
}

TEST_CASE("a near name is suggested and a far one is not", "[server]") {
  constexpr std::array<std::string_view, 2> names{"height", "speed"};
  CHECK(repose::server::did_you_mean("hight", names) == " (did you mean \"height\"?)");
  CHECK(repose::server::did_you_mean("colour", names).empty());
  CHECK(repose::server::did_you_mean(std::string(100'000, 'h'), names).empty());
}
