#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "engine/catalogue.hpp"
#include "server/cli/assignment.hpp"
#include "server/cli/commands.hpp"
#include "server/cli/next_command.hpp"
#include "server/cli/progress.hpp"
#include "server/cli/reference_grain.hpp"
#include "server/cli/text_table.hpp"
#include "server/json/replicates_json.hpp"

using namespace repose;
using Catch::Contains;
using engine::make_key;
using enum engine::MaterialId;
using server::parse_parameter;
using server::parse_setting;

TEST_CASE("a parameter is set by field, materials and value", "[server]") {
  const auto set = parse_parameter("sliding_friction.coefficient:grain-wall=0.3");
  REQUIRE(set);
  CHECK(set->key == make_key("sliding_friction.coefficient", {grain, wall}));
  CHECK(set->value == 0.3);
}

TEST_CASE("the order of two materials does not matter", "[server]") {
  const auto one = parse_parameter("restitution.coefficient:grain-wall=0.3");
  const auto other = parse_parameter("restitution.coefficient:wall-grain=0.3");
  REQUIRE(one);
  REQUIRE(other);
  CHECK(one->key == other->key);
}

TEST_CASE("a value is converted from its unit to SI", "[server]") {
  const auto modulus = parse_parameter("material.shear_modulus:grain=41.7MPa");
  REQUIRE(modulus);
  CHECK(modulus->value == Approx(41.7e6));
  const auto spaced = parse_parameter("material.diameter:grain = 6.496 mm");
  REQUIRE(spaced);
  CHECK(spaced->value == Approx(6.496e-3));
}

TEST_CASE("a plain number is refused where the field has a dimension", "[server]") {
  const auto set = parse_parameter("material.shear_modulus:grain=41.7");
  REQUIRE_FALSE(set);
  CHECK_THAT(set.error(), Contains("lacks its unit") && Contains("Pa, kPa, MPa, GPa"));
}

TEST_CASE("a unit of another dimension is refused with those accepted", "[server]") {
  const auto set = parse_parameter("sliding_friction.coefficient:grain-grain=30deg");
  REQUIRE_FALSE(set);
  CHECK_THAT(set.error(), Contains("'deg' is not a unit of coefficient") && Contains("1, %"));
}

TEST_CASE("an unknown field is refused with the nearest one", "[server]") {
  const auto set = parse_parameter("sliding_frction.coefficient:grain-grain=0.3");
  REQUIRE_FALSE(set);
  CHECK_THAT(set.error(), Contains("did you mean \"sliding_friction.coefficient\"?"));
}

TEST_CASE("materials that are missing, unknown or too many are refused", "[server]") {
  for (const char* text : {"sliding_friction.coefficient=0.3",
                           "sliding_friction.coefficient:grain=0.3",
                           "sliding_friction.coefficient:grain-grain-wall=0.3"}) {
    const auto set = parse_parameter(text);
    REQUIRE_FALSE(set);
    CHECK_THAT(set.error(), Contains("does not name what it is between; write "));
  }
  const auto said = [](const char* text) {
    const auto set = parse_parameter(text);
    REQUIRE_FALSE(set);
    return set.error();
  };
  CHECK_THAT(said("sliding_friction.coefficient:grain-sand=0.3"),
             Contains("'sand' is no material; there are grain, wall; write "));
  CHECK_THAT(said("material.density:wheat=800kg/m3"),
             Contains("'wheat' is no material") && Contains("material.density:grain"));
  CHECK_THAT(said("material.density:grain-wall=1228kg/m3"),
             Contains("does not name what it is of; write material.density:grain"));
  CHECK_THAT(said("air_drag.share:grain=0.5"),
             Contains("air_drag.share is of none; write air_drag.share"));
}

TEST_CASE("a value out of range, none at all or no number is refused", "[server]") {
  CHECK_THAT(parse_parameter("restitution.coefficient:grain-grain=7").error(),
             Contains("out of range") && Contains("must lie in"));
  CHECK_THAT(parse_parameter("restitution.coefficient:grain-grain").error(),
             Contains("assigns nothing"));
  CHECK_THAT(parse_parameter("restitution.coefficient:grain-grain=much").error(),
             Contains("is not a number"));
  CHECK_THAT(parse_parameter("restitution.coefficient:grain-grain=").error(),
             Contains("is not a number"));
  CHECK_THAT(parse_parameter("restitution.coefficient:grain-grain=nan").error(),
             Contains("is not a number"));
}

TEST_CASE("a plain number that is out of range without its unit is told what it lacks",
          "[server]") {
  const auto* kettle = engine::find_experiment("kettle");
  REQUIRE(kettle != nullptr);
  CHECK_THAT(parse_setting(*kettle, "moisture=18").error(),
             Contains("'18' lacks its unit; write 18%") && Contains("1800 %"));
  CHECK_THAT(parse_setting(*kettle, "moisture=180").error(), Contains("out of range"));
  CHECK_THAT(parse_setting(*kettle, "moisture=180%").error(), Contains("out of range"));
  CHECK_THAT(parse_parameter("moisture_softening.reference:grain=12").error(),
             Contains("'12' lacks its unit; write 12%"));
  CHECK_THAT(parse_parameter("restitution.coefficient:grain-grain=7").error(),
             !Contains("lacks its unit"));
}

TEST_CASE("a setting with named values is set by name", "[server]") {
  const auto* kettle = engine::find_experiment("kettle");
  REQUIRE(kettle != nullptr);
  const auto set = parse_setting(*kettle, "source=stream");
  REQUIRE(set);
  CHECK(set->name == "source");
  CHECK(set->value == 1.0);
  CHECK_THAT(parse_setting(*kettle, "source=hose").error(),
             Contains("write one of hopper, stream"));
}

TEST_CASE("an unknown setting is refused with those there are", "[server]") {
  const auto* drop = engine::find_experiment("drop");
  REQUIRE(drop != nullptr);
  CHECK_THAT(parse_setting(*drop, "heigt=3m").error(),
             Contains("did you mean \"height\"?") && Contains("it has height"));
}

TEST_CASE("the reference grain names parameters of the catalogue within their bounds", "[server]") {
  for (const auto& [key, value] : server::reference_grain()) {
    INFO(engine::to_string(key));
    const auto* info = engine::find_parameter(key.field);
    REQUIRE(info != nullptr);
    CHECK(key.between.size() == engine::materials_of(info->scope));
    CHECK(value >= info->field->lower);
    CHECK(value <= info->field->upper);
  }
}

TEST_CASE("what takes a calibration up says all that it was given, as a shell reads it",
          "[server]") {
  CHECK(server::shell_word("r.db") == "r.db");
  CHECK(server::shell_word("") == "''");
  CHECK(server::shell_word("it's here") == R"('it'\''s here')");
  CHECK(server::resume_words({.study = "my study.json", .database = "r.db"}) ==
        "repose calibrate 'my study.json' --db r.db");
  CHECK(server::resume_words({.asked_as = {"extend", "3", "--effect", "air_drag"},
                              .database = "$r.db",
                              .workers = 2,
                              .report = "a b.html",
                              .pictures = false,
                              .form = server::Form::json}) ==
        "repose extend 3 --effect air_drag --db '$r.db' --workers 2 --report 'a b.html' "
        "--no-pictures --json");
}

TEST_CASE("columns line up by letters, not by bytes", "[server]") {
  server::TextTable table({"a", "b"});
  table.row({"x", "1 ± 2"});
  table.row({"long", "3"});
  CHECK(table.str() == "a         b\nx     1 ± 2\nlong      3\n");
}

TEST_CASE("time left counts only trials that were run", "[server]") {
  server::ProgressView view;
  view.evaluations_planned = 10;
  view.evaluations_done = 5;
  view.trials_per_evaluation = 2;
  view.trials_stored = 10;
  CHECK(server::time_left(view) < 0.0);  // all from the store: nothing is known
  view.trials_run = 4;
  view.trials_done = 4;
  view.trials_all = 4;
  view.elapsed = 8.0;
  CHECK(server::time_left(view) == Approx(12.0));  // 6 trials at 2 s
}

TEST_CASE("no line of the display is wider than the terminal", "[server]") {
  calibrator::Calibration calibration;
  calibration.measurements.resize(2);
  calibration.measurements[0].observable = "a_rather_long_name_of_an_observable_indeed";
  server::ProgressView view;
  view.evaluations_planned = 10;
  view.misfit = 3.0;
  view.predicted = {1.0, 2.0};
  view.z = {0.5, -3.0};
  for (const std::size_t width : {20U, 40U, 80U}) {
    for (const std::string& line : server::progress_lines(calibration, view, width)) {
      CHECK(server::letters(line) <= width);
    }
  }
}

TEST_CASE("one replicate has no standard error: null in JSON", "[server]") {
  server::Replicates replicates;
  replicates.trial.experiment.name = "drop";
  replicates.evaluations.resize(1);
  replicates.evaluations[0].outcome = std::vector<engine::Observation>{{"restitution", 0.6}};
  replicates.evaluations[0].effort.grain_steps = 500;
  replicates.wall_seconds = {0.25};
  replicates.elapsed = 0.25;
  replicates.observations = {
      {"restitution", 0.6, std::numeric_limits<double>::quiet_NaN(), engine::unit::one}};
  const std::string text = print_replicates(replicates, "test");
  CHECK_THAT(text, Contains("\"standard_error\": null"));
  CHECK_THAT(text, Contains("\"particle_steps_per_second\": 2000.0"));
  CHECK_THAT(text, Contains("\"engine_version\": \"test\""));
}

TEST_CASE("a failed replicate is named by kind, message and seed", "[server]") {
  server::Replicates replicates;
  replicates.evaluations.resize(2);
  replicates.evaluations[1].trial.seed = 8;
  replicates.evaluations[1].outcome =
      engine::Failure{engine::FailureKind::did_not_rest, "still moving", 3.5};
  replicates.wall_seconds = {1.0, 1.0};
  const std::string text = print_replicates(replicates, "test");
  CHECK_THAT(text,
             Contains("\"kind\": \"did_not_rest\"") && Contains("\"message\": \"still moving\"") &&
                 Contains("\"simulated_seconds\": 3.5") && Contains("\"seed\": 8"));
}
