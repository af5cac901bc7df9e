#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "server/api/problem.hpp"
#include "server/json/calibration_json.hpp"
#include "server/json/fit_json.hpp"
#include "server/json/material_library.hpp"
#include "server/json/starting_study.hpp"
#include "tests/schemas/schema_check.hpp"

namespace {

using repose::server::parse_calibration;
using repose::server::print_calibration;
using repose::server::print_fit;
using repose::tests::conforms;
using repose::tests::Json;
using repose::tests::violations;
namespace fs = std::filesystem;

const fs::path folder = fs::path(REPOSE_SOURCE_DIR) / "schemas";

std::string read(const fs::path& path) {
  std::ifstream file(path);
  REQUIRE(file);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

Json schema(const std::string& name) { return Json::parse(read(folder / (name + ".schema.json"))); }

std::vector<fs::path> files(const std::string& kind) {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(folder / "examples" / kind)) {
    if (entry.path().filename() != "expected.json") paths.push_back(entry.path());
  }
  std::ranges::sort(paths);
  return paths;
}

}  // namespace

TEST_CASE("every valid example is read, and what is printed of it reads back", "[schemas]") {
  CHECK(files("valid").size() >= 3);
  for (const fs::path& path : files("valid")) {
    INFO(path);
    const auto calibration = parse_calibration(read(path));
    REQUIRE(calibration);
    const auto again = parse_calibration(print_calibration(*calibration));
    REQUIRE(again);
    CHECK(*again == *calibration);
  }
}

TEST_CASE("every valid example conforms to the schema, and so does what is printed of it",
          "[schemas]") {
  for (const fs::path& path : files("valid")) {
    INFO(path);
    const std::string text = read(path);
    CHECK_THAT(violations(schema("calibration"), Json::parse(text)), conforms());
    const Json printed = Json::parse(print_calibration(*parse_calibration(text)));
    CHECK_THAT(violations(schema("calibration"), printed), conforms());
  }
}

TEST_CASE("every invalid example has exactly the problems it was written for", "[schemas]") {
  const Json expected = Json::parse(read(folder / "examples" / "invalid" / "expected.json"));
  CHECK(expected.size() == files("invalid").size());
  for (const fs::path& path : files("invalid")) {
    INFO(path);
    REQUIRE(expected.contains(path.filename().string()));
    auto wanted = expected.at(path.filename().string()).get<std::vector<std::string>>();
    const auto result = parse_calibration(read(path));
    REQUIRE(!result);
    std::vector<std::string> pointers;
    for (const auto& problem : result.error()) {
      pointers.push_back(problem.pointer);
      CHECK(!problem.message.empty());
      CHECK(!problem.allowed.empty());
    }
    std::ranges::sort(pointers);
    std::ranges::sort(wanted);
    CHECK(pointers == wanted);
  }
}

TEST_CASE("what the schema refuses, the codec refuses", "[schemas]") {
  std::size_t refused = 0;
  for (const fs::path& path : files("invalid")) {
    const Json document = Json::parse(read(path), nullptr, false);
    if (document.is_discarded() || violations(schema("calibration"), document).empty()) continue;
    ++refused;
    INFO(path);
    CHECK(!parse_calibration(read(path)));
  }
  CHECK(refused > 10);  // the rest are mistakes that only the catalogue or the whole study shows
}

TEST_CASE("the answer of a cancelled calibration conforms to the schema of fits", "[schemas]") {
  const auto calibration =
      parse_calibration(read(folder / "examples" / "valid" / "held-out-and-allowance.json"));
  REQUIRE(calibration);
  repose::calibrator::Fit fit;
  fit.stop = repose::calibrator::StopReason::cancelled;
  for (const auto& free : calibration->free) {
    fit.best.set(free.key, free.lower);
    fit.parameters.push_back({free.key, free.lower, free.lower, free.upper});
    fit.directions.push_back({std::vector<double>(calibration->free.size(), 0.5), 1.0, false});
  }
  for (std::size_t i = 0; i < calibration->measurements.size(); ++i) {
    fit.predictions.push_back({i, 1.0, 0.1, 4, 0.2, 1.0, 0.1, 0.5});
    fit.offset.push_back(0.0);
    fit.offset_error.push_back(0.0);
  }
  fit.history.push_back(
      {1, "start", fit.best, std::vector<double>(calibration->measurements.size(), 1.0), 1.0, 1.0});
  CHECK_THAT(violations(schema("fit"), Json::parse(print_fit(*calibration, fit))), conforms());
}

TEST_CASE("a problem conforms to its schema", "[schemas]") {
  const auto reply = repose::server::problem_reply(422, "no", {{"/a", "wrong", "1", "2"}});
  CHECK_THAT(violations(schema("problem"), Json::parse(reply.body)), conforms());
}

TEST_CASE("what is published of a grain conforms to its schema, and the study made of it too",
          "[schemas]") {
  for (const auto& material : repose::server::material_library().materials) {
    INFO(material.name);
    const std::string facts = repose::server::print_material(material.name);
    CHECK_THAT(violations(schema("published_material"), Json::parse(facts)), conforms());
    const std::string study = repose::server::starting_study(material).text;
    CHECK_THAT(violations(schema("calibration"), Json::parse(study)), conforms());
  }
}
