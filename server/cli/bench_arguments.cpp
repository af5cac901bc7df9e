// The commands that measure, and those of published studies.
#include <string>

#include "calibrator/calibration.hpp"
#include "engine/catalogue.hpp"
#include "server/cli/arguments.hpp"

namespace repose::server {

namespace {

constexpr const char* study_footer =
    "Every finished evaluation is kept in the database: the same command goes on where an\n"
    "interrupted one was, and what is complete is printed again without simulating. Ctrl-C stops "
    "and\n"
    "reports what there is.";

void add_bench_calibrator(CLI::App& bench, BenchCalibratorCommand& options, Work& work) {
  CLI::App& command = *bench.add_subcommand(
      "calibrator", "Evaluations that each method needs where the truth is known");
  command.add_option("--case", options.cases, "Which (default: all)")
      ->check(CLI::IsMember(options.cases))
      ->expected(1)
      ->take_all();
  command.add_option("--seeds", options.seeds, "Studies of each case")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  options.methods.assign(calibrator::method_names.begin(), calibrator::method_names.end());
  command.add_option("--methods", options.methods, "Which, with commas between (default: all)")
      ->check(CLI::IsMember(options.methods))
      ->delimiter(',')
      ->take_all();
  auto* honesty = command.add_option(
      "--honesty",
      options.honesty,
      "Instead: over so many studies, how often intervals hold the truth and hits are true");
  honesty->check(CLI::Range(1, 10000))->type_name("STUDIES");
  command
      .add_option("--warm-start",
                  options.warm_start,
                  "Instead: new evaluations needed after so many stored runs for another target")
      ->check(CLI::Range(1, 300))
      ->type_name("RUNS")
      ->excludes(honesty);
  add_json(command, options.form, "JSON on standard output");
  command.callback([&] { work = [&] { return bench_calibrator_command(options); }; });
}

void add_bench_effects(CLI::App& bench, BenchEffectsCommand& options, Work& work) {
  CLI::App& command = *bench.add_subcommand(
      "effects", "What each effect does to each observable of the reference grain");
  for (const auto& effect : engine::effect_catalogue()) {
    if (effect.strong != nullptr) options.effects.emplace_back(effect.text.name);
  }
  for (const auto& info : engine::experiment_catalogue()) {
    options.experiments.emplace_back(info.name);
  }
  command.add_option("--effect", options.effects, "Which (default: all)")
      ->check(CLI::IsMember(options.effects))
      ->expected(1)
      ->take_all();
  command.add_option("--experiment", options.experiments, "Which (default: all)")
      ->check(CLI::IsMember(options.experiments))
      ->expected(1)
      ->take_all();
  command.add_option("--seeds", options.seeds, "Runs of each")
      ->capture_default_str()
      ->check(CLI::Range(1, 100));
  add_database(command, options.database);
  add_workers(command, options.workers);
  add_json(command, options.form, "JSON on standard output");
  does(command, options, bench_effects_command, work);
}

}  // namespace

void add_bench(CLI::App& app,
               BenchCommand& options,
               BenchEffectsCommand& effects,
               BenchCalibratorCommand& calibrator,
               LaboratoryOptions& laboratory,
               Work& work) {
  CLI::App& bench =
      *app.add_subcommand("bench", "Measure the engine, the laboratory and the calibrator");
  bench.require_subcommand(1);
  add_bench_effects(bench, effects, work);
  add_bench_calibrator(bench, calibrator, work);
  add_laboratory(app, bench, laboratory, work);
  CLI::App& command = *bench.add_subcommand("engine", "The engine, on beds of the reference grain");
  command.add_option("--scene", options.scenes, "Which (default: all)")
      ->check(CLI::IsMember(options.scenes))
      ->expected(1)
      ->take_all();
  command
      .add_option("--grains", options.grains, "Of the static bed: up to 5000, or a multiple of it")
      ->capture_default_str()
      ->check(CLI::Range(200, 1000000))
      ->check(
          [](const std::string& text) {
            const unsigned long grains = std::stoul(text);
            return grains <= 5000 || grains % 5000 == 0
                       ? std::string()
                       : text + " is more than 5000 and no multiple of it";
          },
          "",
          "tiles");
  command.add_flag("--stiff", options.stiff, "Grains of 41.7 MPa in place of 1.04 MPa");
  command.add_option("--rounds", options.rounds, "Times each scene is measured")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  command.add_option("--bed", options.bed, "Write the settled bed of the static scene there")
      ->type_name("FILE");
  command.add_option("--threads", options.threads, "Threads that share a run; then times are wall")
      ->capture_default_str()
      ->check(CLI::Range(1, 64));
  add_json(command, options.form, "One JSON object on standard output");
  command.callback([&] { work = [&] { return bench_engine_command(options); }; });
}

void add_study(CLI::App& app, StudyCommand& options, Work& work) {
  CLI::App& command = *app.add_subcommand("study", "Run a published simulation study again");
  command.add_option("name", options.name, "Which: boac2010")->required();
  command.add_flag("--quick", options.quick, "Draft fidelity, few replicates");
  command.add_option("--output", options.output, "Folder for the JSON file and the HTML report")
      ->type_name("FOLDER")
      ->default_str("the working folder");
  add_database(command, options.database);
  add_workers(command, options.workers);
  add_json(command, options.form, "The result on standard output");
  command.footer(study_footer);
  does(command, options, study_command, work);
}

}  // namespace repose::server
