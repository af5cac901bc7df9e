#include "engine/catalogue.hpp"

#include <set>

#include <catch2/catch.hpp>

using namespace repose::engine;

TEST_CASE("every parameter is found by its full name", "[engine]") {
  std::set<std::string> seen;
  for (const std::string& name : parameter_names()) {
    CAPTURE(name);
    CHECK(seen.insert(name).second);
    REQUIRE(find_parameter(name) != nullptr);
    CHECK(name.substr(name.find('.') + 1) == find_parameter(name)->field->name);
  }
  CHECK(seen.count("sliding_friction.coefficient") == 1);
  CHECK(find_parameter("sliding_friction") == nullptr);
  CHECK(find_parameter("") == nullptr);
}

TEST_CASE("settings resolve to what was set, else to the fidelity's default", "[engine]") {
  const ExperimentInfo& kettle = *find_experiment("kettle");
  const auto value = [&kettle](const Experiment& experiment, std::string_view name) {
    const auto values = resolved_settings(kettle, experiment);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (kettle.settings[i].name == name) return values[i];
    }
    return -1.0;
  };
  CHECK(value({"kettle", Fidelity::standard, {}}, "diameter") == 0.117475);
  CHECK(value({"kettle", Fidelity::paper, {}}, "diameter") == 0.117475);
  CHECK(value({"kettle", Fidelity::draft, {}}, "diameter") < 0.117475);
  CHECK(value({"kettle", Fidelity::draft, {{"diameter", 0.2}}}, "diameter") == 0.2);
}
