#include "server/cli.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <iostream>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>

#include "db/store.hpp"
#include "engine/any_machine.hpp"
#include "engine/catalogue.hpp"
#include "engine/evaluate.hpp"
#include "server/cli/arguments.hpp"
#include "server/cli/exit_code.hpp"
#include "server/cli/input.hpp"
#include "server/json/place.hpp"

namespace repose::server {

namespace {

constexpr const char* main_footer =
    "A five-minute start:\n"
    "  repose evaluate kettle --fidelity draft      one virtual experiment with a reference grain\n"
    "  repose calibrate study.json                  calibrate, print the answer, write a report\n"
    "  repose serve                                 the same as a service with an HTTP API\n\n"
    "Exit code: 0 done, 1 failed, 2 bad input or usage, 130 interrupted.";

constexpr const char* evaluate_footer =
    "Examples:\n"
    "  repose evaluate kettle --replicates 3\n"
    "  repose evaluate tilting_box --set sliding_friction.coefficient:grain-grain=0.6 --json\n"
    "  repose evaluate drop --set material.shear_modulus:grain=41.7MPa --setting height=300mm\n"
    "  repose evaluate kettle --study study.json --frames frames/\n\n"
    "`repose explain kettle` says and draws what an experiment does.\n"
    "A value carries its unit unless it is a plain number: 41.7MPa, '15 rpm', 0.3.\n"
    "Without a study the grain is soybean: 6.496 mm, 1228 kg/m3, G 1.04 MPa, restitution 0.6,\n"
    "sliding friction 0.45 (grain-wall 0.30), rolling resistance 0.05.";

/// A number beyond its bounds would be taken for another one.
std::string objection_to_seed(const std::string& text) {
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error == std::errc{} && end == text.data() + text.size()) return "";
  return "a seed is a whole number from 0 to 18446744073709551615, not " + text;
}

void add_evaluate(CLI::App& app, EvaluateCommand& options, Work& work) {
  CLI::App& command = *app.add_subcommand("evaluate", "Run one virtual experiment");
  std::string names;
  for (const auto& info : engine::experiment_catalogue()) {
    names += (names.empty() ? "" : ", ") + std::string(info.name);
  }
  command.add_option("experiment", options.experiment, "Which: " + names)->required();
  command.add_option("--study", options.study, "Take parameters and settings from a study")
      ->type_name("FILE");
  command
      .add_option("--set",
                  options.parameters,
                  "Set a parameter, for instance sliding_friction.coefficient:grain-wall=0.3")
      ->type_name("FIELD:BETWEEN=VALUE")
      ->expected(1)
      ->take_all();
  command.add_option("--setting", options.settings, "Set the apparatus or the conditions")
      ->type_name("NAME=VALUE")
      ->expected(1)
      ->take_all();
  command.add_option("--seed", options.seed, "Seed of the first replicate")
      ->capture_default_str()
      ->check(objection_to_seed);
  command.add_option("--replicates", options.replicates, "Runs that differ in seed only")
      ->capture_default_str()
      ->check(CLI::Range(1, 10000));
  command
      .add_option("--threads",
                  options.threads,
                  "Threads that share a run of more than 8000 grains; the answer is the same")
      ->capture_default_str()
      ->check(CLI::Range(1, 64));
  command
      .add_option_function<std::string>(
          "--fidelity",
          [&options](const std::string& name) {
            const auto& known = engine::fidelity_names;
            const auto found = std::ranges::find(known, name);
            options.fidelity = static_cast<engine::Fidelity>(found - known.begin());
          },
          "How large a version is run (default: the study's, else standard)")
      ->check(CLI::IsMember({"draft", "standard", "paper"}));
  command.add_option("--frames", options.frames, "Write .vtp files and pictures there")
      ->type_name("DIR");
  command
      .add_option("--frame-interval", options.frame_interval, "Simulated seconds between frames")
      ->capture_default_str()
      ->check(CLI::Range(1e-6, 1e6));
  add_json(command, options.form, "One JSON object on standard output");
  command.footer(evaluate_footer);
  command.callback([&] { work = [&] { return evaluate_command(options); }; });
}

void add_catalogue(CLI::App& app, Form& form, SchemaCommand& options, Work& work) {
  CLI::App& catalogue =
      *app.add_subcommand("catalogue", "Print every effect, experiment and material property");
  form = Form::json;
  auto* json = catalogue.add_flag_callback(
      "--json", [&form] { form = Form::json; }, "As JSON (default)");
  catalogue
      .add_flag_callback(
          "--markdown", [&form] { form = Form::markdown; }, "As tables for people")
      ->excludes(json);
  catalogue.callback([&] { work = [&] { return catalogue_command(form); }; });
  CLI::App& schema = *app.add_subcommand("schema", "Print or write the JSON schemas");
  schema.add_option("name", options.name, "Which; without it the names are printed");
  schema.add_option("--write", options.folder, "Write them there")->type_name("DIR");
  schema.callback([&] { work = [&] { return schema_command(options); }; });
}

void add_materials(CLI::App& app, MaterialsCommand& options, Work& work) {
  CLI::App& command = *app.add_subcommand("materials", "Print published properties of grains");
  command.add_option("name", options.name, "Which grain; without it they are listed");
  auto* study = command.add_flag("--study", options.study, "Print a study to start from");
  command
      .add_flag_callback(
          "--json", [&options] { options.form = Form::json; }, "As JSON")
      ->excludes(study);
  command.callback([&] { work = [&] { return materials_command(options); }; });
}

/// Every command's arguments, alive while the command runs.
struct Commands {
  EvaluateCommand evaluate;
  CalibrateCommand calibrate;
  MissingEffectCommand missing_effect;
  ScheduleCommand schedule;
  ExportCommand fit_export;
  StoreCommand store;
  LineageCommand lineage;
  ReportCommand report;
  ListCommand list;
  ShowCommand show;
  CancelCommand cancel;
  ServeCommand serve;
  TokenCommand token;
  BenchCommand bench;
  BenchEffectsCommand bench_effects;
  BenchCalibratorCommand bench_calibrator;
  LaboratoryOptions laboratory;
  MaterialsCommand materials;
  StudyCommand study;
  Form catalogue_form = Form::json;
  SchemaCommand schema;
};

/// What is wrong where a command should stand; nothing where one does.
std::string objection_to_command(const CLI::App& group) {
  if (group.get_require_subcommand_min() == 0 || !group.get_subcommands().empty()) return "";
  std::vector<std::string> names;
  for (const CLI::App* command : group.get_subcommands([](const CLI::App*) { return true; })) {
    const bool is_hidden = command->get_group().empty();
    if (!is_hidden) names.push_back(command->get_name());
  }
  const std::vector<std::string> words = group.remaining();
  if (words.empty()) return "which command? There are " + listed(names);
  const std::string& word = words.front();
  if (!word.starts_with("-")) {
    return "there is no command '" + word + "'" + did_you_mean(word, names) + "; there are " +
           listed(names);
  }
  std::vector<std::string> options;
  for (const CLI::Option* option : group.get_options()) {
    for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
  }
  return "there is no option " + word + did_you_mean(word, options) + " before a command";
}

int usage_error(const CLI::App& app, const CLI::ParseError& error) {
  std::string command = "repose";
  const CLI::App* group = &app;
  while (!group->get_subcommands().empty()) {
    group = group->get_subcommands().front();
    command += " " + group->get_name();
  }
  const std::string objection = objection_to_command(*group);
  const bool asked_for = error.get_exit_code() == 0;  // help and version
  if (asked_for && (objection.empty() || group->remaining().empty())) return app.exit(error);
  std::cerr << "repose: " << (objection.empty() ? error.what() : objection) << "\nTry `" << command
            << " --help`.\n";
  return exit_code::misused;
}

/// The words of the command line; "help COMMAND" is another way to say "COMMAND --help".
std::vector<const char*> words_of(int argc, const char* const* argv) {
  std::vector<const char*> words(argv, argv + argc);
  if (words.size() > 1 && std::string_view(words[1]) == "help") {
    words.erase(words.begin() + 1);
    words.push_back("--help");
  }
  return words;
}

}  // namespace

int run_command_line(int argc, const char* const* argv) {
  CLI::App app("repose: calibrates DEM parameters against bulk measurements", "repose");
  app.set_version_flag("--version", "repose " + std::string(engine::version()));
  app.require_subcommand(1);
  app.footer(main_footer);
  app.add_option_function<std::string>(
         "--instruction-set",
         [](const std::string& name) {
           const auto found = std::ranges::find(engine::instruction_set_names, name);
           engine::use_instruction_set(
               static_cast<engine::InstructionSet>(found - engine::instruction_set_names.begin()));
         },
         "Use no better one than this; answers have the same bits on all")
      ->check(CLI::IsMember(std::vector<std::string>(engine::instruction_set_names.begin(),
                                                     engine::instruction_set_names.end())))
      ->envname("REPOSE_INSTRUCTION_SET");
  Commands commands;
  Work work;
  add_evaluate(app, commands.evaluate, work);
  add_calibrate(app, commands.calibrate, work);
  add_missing_effect(app, commands.missing_effect, work);
  add_schedule(app, commands.schedule, work);
  add_nightly(app, commands.schedule, work);
  add_export(app, commands.fit_export, work);
  add_store(app, commands.store, work);
  add_lineage(app, commands.lineage, work);
  add_report(app, commands.report, work);
  add_serve(app, commands.serve, work);
  add_token(app, commands.token, work);
  add_list(app, commands.list, work);
  add_show(app, commands.show, work);
  add_cancel(app, commands.cancel, work);
  add_bench(app,
            commands.bench,
            commands.bench_effects,
            commands.bench_calibrator,
            commands.laboratory,
            work);
  add_materials(app, commands.materials, work);
  add_study(app, commands.study, work);
  add_catalogue(app, commands.catalogue_form, commands.schema, work);
  CLI::App& answer = *app.add_subcommand("answer", "Answer one trial from standard input");
  answer.group("");  // hidden: for the worker pool
  answer.callback([&] { work = answer_command; });
  try {
    const std::vector<const char*> words = words_of(argc, argv);
    app.parse(static_cast<int>(words.size()), words.data());
  } catch (const CLI::ParseError& error) {
    return usage_error(app, error);
  }
  try {
    return work();
  } catch (const db::Error& error) {  // the file named cannot be used
    std::cerr << "repose: " << error.what() << "\n";
    return exit_code::misused;
  } catch (const std::system_error& error) {  // the folder or address named cannot be used
    std::cerr << "repose: " << error.what() << "\n";
    return exit_code::misused;
  } catch (const std::exception& error) {
    std::cerr << "repose: " << error.what() << "\n";
    return exit_code::failed;
  }
}

}  // namespace repose::server
