#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include <catch2/catch.hpp>

#include "server/json/calibration_json.hpp"
#include "server/json/schemas.hpp"
#include "tests/schemas/schema_check.hpp"
#include "tests/support/program.hpp"

namespace {

namespace fs = std::filesystem;
using repose::tests::conforms;
using repose::tests::Json;
using repose::tests::violations;

const fs::path folder = fs::path(REPOSE_SOURCE_DIR) / "schemas";

std::string read(const fs::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

Json generated(const std::string& name) {
  for (const auto& [path, text] : repose::server::generated_schemas()) {
    if (path == "generated/" + name) return Json::parse(text);
  }
  FAIL("nothing generates " << name);
  return {};
}

}  // namespace

TEST_CASE("the generated files are those that the program would write", "[schemas]") {
  std::set<std::string> names;
  for (const auto& [path, text] : repose::server::generated_schemas()) {
    INFO("renew them: " << repose::tests::repose_program << " schema --write " << folder.string());
    names.insert(fs::path(path).filename());
    const bool same = read(folder / path) == text;
    CHECK(same);
  }
  for (const auto& entry : fs::directory_iterator(folder / "generated")) {
    CHECK(names.contains(entry.path().filename()));
  }
}

TEST_CASE("the schemas in the program are those in the folder", "[schemas]") {
  std::size_t count = 0;
  for (const auto& [name, text] : repose::server::written_schemas()) {
    ++count;
    CHECK(text == read(folder / name));
  }
  CHECK(count >= 3);
}

TEST_CASE("what the demo study names conforms to the generated schemas", "[schemas]") {
  const Json study = Json::parse(read(folder / "examples" / "valid" / "boac2010-soybean.json"));
  for (const Json& measurement : study["measurements"]) {
    CHECK_THAT(violations(generated("experiments.schema.json"), measurement), conforms());
  }
  for (const Json& free : study["free"]) {
    Json parameter{{"field", free["field"]}, {"between", free["between"]}};
    parameter["value"] = free["lower"];
    parameter["unit"] = free["unit"];
    CHECK_THAT(violations(generated("effects.schema.json"), parameter), conforms());
    parameter["between"] = Json::array();
    CHECK(!violations(generated("effects.schema.json"), parameter).empty());
  }
}
