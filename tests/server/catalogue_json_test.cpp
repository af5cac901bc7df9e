#include "server/json/catalogue_json.hpp"

#include <catch2/catch.hpp>

#include "engine/catalogue.hpp"
#include "server/json/text.hpp"

namespace {

using repose::server::Json;
namespace engine = repose::engine;

const Json& catalogue() {
  static const Json json = Json::parse(repose::server::print_catalogue());
  return json;
}

}  // namespace

TEST_CASE("the catalogue's document holds every effect with bounds that contain its null",
          "[server]") {
  REQUIRE(catalogue()["effects"].size() == engine::effect_catalogue().size());
  for (const Json& effect : catalogue()["effects"]) {
    CHECK(!effect["citation"].get<std::string>().empty());
    for (const Json& parameter : effect["parameters"]) {
      CHECK(engine::find_parameter(parameter["field"].get<std::string>()) != nullptr);
      CHECK(parameter["lower"].get<double>() <= parameter["null"].get<double>());
      CHECK(parameter["null"].get<double>() <= parameter["upper"].get<double>());
      CHECK(!parameter["units"].empty());
    }
  }
}

TEST_CASE("no number of the catalogue is less than nothing and nothing", "[server]") {
  CHECK(repose::server::to_text(catalogue()).find("-0.0,") == std::string::npos);
}

TEST_CASE("every setting has a default at every fidelity, in the unit shown", "[server]") {
  REQUIRE(catalogue()["experiments"].size() == engine::experiment_catalogue().size());
  for (const Json& experiment : catalogue()["experiments"]) {
    CHECK(!experiment["observables"].empty());
    for (const Json& setting : experiment["settings"]) {
      for (const std::string_view fidelity : engine::fidelity_names) {
        const Json& value = setting["default"][std::string(fidelity)];
        if (setting.contains("choices")) {
          CHECK(value.is_string());
        } else {
          CHECK(setting["lower"].get<double>() <= value.get<double>() * (1 + 1e-12));
          CHECK(value.get<double>() <= setting["upper"].get<double>() * (1 + 1e-12));
        }
      }
    }
  }
}
