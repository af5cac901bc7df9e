#include "server/cli.hpp"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <iostream>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>

#include "calibrator/calibration.hpp"
#include "db/store.hpp"
#include "engine/any_machine.hpp"
#include "engine/catalogue.hpp"
#include "engine/evaluate.hpp"
#include "server/cli/arguments.hpp"
#include "server/cli/commands.hpp"
#include "server/cli/exit_code.hpp"
#include "server/cli/input.hpp"
#include "server/cli/laboratory_options.hpp"

namespace repose::server {

namespace {

constexpr const char* main_footer =
    "A five-minute start:\n"
    "  repose evaluate kettle --fidelity draft      one virtual experiment with a reference grain\n"
    "  repose calibrate study.json                  calibrate, print the answer, write a report\n"
    "  repose serve                                 the same as a service with a web page\n\n"
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

constexpr const char* calibrate_footer =
    "Ctrl-C stops; the same command takes the calibration up where it was. Progress goes to\n"
    "standard error: a display that renews itself on a terminal, a line a batch elsewhere.";

constexpr const char* study_footer =
    "Every finished evaluation is kept in the database: the same command goes on where an\n"
    "interrupted one was, and what is complete is printed again without simulating. Ctrl-C stops "
    "and\n"
    "reports what there is.";

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
  command.add_option("--seed", options.seed, "Seed of the first replicate")->capture_default_str();
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

void add_calibrate(CLI::App& app, CalibrateCommand& options, Work& work) {
  CLI::App& command = *app.add_subcommand("calibrate", "Calibrate a study and write its report");
  command.add_option("study", options.study, "Study document; - is standard input")
      ->required()
      ->type_name("STUDY.json");
  add_database(command, options.database);
  command.add_option("--workers", options.workers, "Evaluations at once (default: one a core)")
      ->check(CLI::Range(1, 4096));
  command.add_option("--report", options.report, "Report (default: beside the database)")
      ->type_name("FILE");
  command.add_flag_callback(
      "--no-pictures",
      [&options] { options.pictures = false; },
      "Do not run the best set once more for the report's pictures");
  add_json(command, options.form, "The calibration's document on standard output");
  command.footer(calibrate_footer);
  command.callback([&] {
    work = [&] {
      if (options.database.empty()) options.database = default_database();
      return calibrate_command(options);
    };
  });
}

void add_missing_effect(CLI::App& app, MissingEffectCommand& options, Work& work) {
  const auto add =
      [&](const char* name, const char* what, int (*run)(const MissingEffectCommand&)) {
        CLI::App& command = *app.add_subcommand(name, what);
        command.add_option("id", options.id, "Calibration")->required();
        add_database(command, options.database);
        add_json(command, options.form, "One JSON object on standard output");
        command.callback([&, run] {
          work = [&, run] {
            if (options.database.empty()) options.database = default_database();
            return run(options);
          };
        });
        return &command;
      };
  const auto add_tolerance = [&](CLI::App& command) {
    command
        .add_option("--tolerance",
                    options.tolerances,
                    "How closely codes agree on an observable, in place of the catalogue's share")
        ->type_name("EXPERIMENT.OBSERVABLE=SHARE")
        ->expected(1)
        ->take_all();
  };
  const auto add_workers = [&](CLI::App& command) {
    command.add_option("--workers", options.workers, "Evaluations at once (default: one a core)")
        ->check(CLI::Range(1, 4096));
  };
  add_tolerance(
      *add("compare", "Where a calibrated model misses its measurements", compare_command));
  CLI::App& diagnose =
      *add("diagnose", "Which physical effect a calibrated model lacks", diagnose_command);
  add_tolerance(diagnose);
  add_workers(diagnose);
  CLI::App& extend = *add("extend", "Add an effect to a model and calibrate it", extend_command);
  extend.add_option("--effect", options.effect, "Which; `repose diagnose` names them")->required();
  add_workers(extend);
  extend.add_option("--report", options.report, "Report (default: beside the database)")
      ->type_name("FILE");
  extend.add_flag_callback(
      "--no-pictures", [&options] { options.pictures = false; }, "No pictures in the report");
}

void add_lineage(CLI::App& app, LineageCommand& options, Work& work) {
  CLI::App& command =
      *app.add_subcommand("lineage", "Models that add effects to one another, before and after");
  command.add_option("id", options.id, "Calibration; any of them")->required();
  add_database(command, options.database);
  command.add_option("--report", options.report, "Write their HTML report there")
      ->type_name("FILE");
  add_json(command, options.form, "One JSON object on standard output");
  command.callback([&] {
    work = [&] {
      if (options.database.empty()) options.database = default_database();
      return lineage_command(options);
    };
  });
}

void add_report(CLI::App& app, ReportCommand& options, Work& work) {
  CLI::App& command = *app.add_subcommand("report", "Write the HTML report of a calibration");
  command.add_option("id", options.id, "Calibration")->required();
  add_database(command, options.database);
  command.add_option("--output", options.output, "Report (default: repose-report-ID.html)")
      ->type_name("FILE");
  command.add_flag_callback(
      "--no-pictures",
      [&options] { options.pictures = false; },
      "Do not run the best set once more for the report's pictures");
  command.callback([&] {
    work = [&] {
      if (options.database.empty()) options.database = default_database();
      return report_command(options);
    };
  });
}

void add_list(CLI::App& app, ListCommand& options, Work& work) {
  CLI::App& command = *app.add_subcommand("list", "List the calibrations, newest first");
  add_database(command, options.database);
  command.add_option("--limit", options.limit, "At most so many")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  add_json(command, options.form, "One JSON object on standard output");
  command.callback([&] {
    work = [&] {
      if (options.database.empty()) options.database = default_database();
      return list_command(options);
    };
  });
}

void add_show(CLI::App& app, ShowCommand& options, Work& work) {
  CLI::App& command = *app.add_subcommand("show", "Print the answer of a calibration");
  command.add_option("id", options.id, "Calibration")->required();
  add_database(command, options.database);
  add_json(command, options.form, "The calibration's document on standard output");
  command.callback([&] {
    work = [&] {
      if (options.database.empty()) options.database = default_database();
      return show_command(options);
    };
  });
}

void add_serve(CLI::App& app, ServeCommand& options, Work& work) {
  CLI::App& command = *app.add_subcommand("serve", "Start the service: HTTP API and web page");
  command.add_option("--host", options.host, "Address to listen on")->capture_default_str();
  command.add_option("--port", options.port, "Port; 0 is any free one")
      ->capture_default_str()
      ->check(CLI::Range(0, 65535));
  command.add_option("--name", options.names, "Another name of this host that requests may use")
      ->type_name("HOST")
      ->expected(1)
      ->take_all();
  add_database(command, options.database);
  command.add_option("--workers", options.workers, "Evaluations at once (default: one a core)")
      ->check(CLI::Range(1, 4096));
  command.callback([&] {
    work = [&] {
      if (options.database.empty()) options.database = default_database();
      return serve_command(options);
    };
  });
}

void add_token(CLI::App& app, TokenCommand& options, Work& work) {
  CLI::App& token =
      *app.add_subcommand("token", "Make, list and revoke the tokens that users of the API send");
  token.require_subcommand(1);
  const auto add = [&](const char* name, const char* what, int (*run)(const TokenCommand&)) {
    CLI::App& command = *token.add_subcommand(name, what);
    add_database(command, options.database);
    command.callback([&, run] {
      work = [&, run] {
        if (options.database.empty()) options.database = default_database();
        return run(options);
      };
    });
    return &command;
  };
  CLI::App& create = *add("create", "Make a token; it is shown this once", create_token_command);
  create.add_option("name", options.name, "Whose it is")->required();
  create.add_option("--scope", options.scope, "What it is good for")
      ->capture_default_str()
      ->check(CLI::IsMember({"read", "submit", "admin"}));
  create.add_option("--days", options.days, "Days until it expires (default: it does not)")
      ->check(CLI::Range(1, 36500));
  CLI::App& list = *add("list", "List the tokens", list_tokens_command);
  add_json(list, options.form, "One JSON object on standard output");
  CLI::App& revoke = *add("revoke", "Make a token worthless", revoke_token_command);
  revoke.add_option("id", options.id, "Which, as `repose token list` names it")->required();
}

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
  command.add_option("--workers", options.workers, "Evaluations at once")
      ->capture_default_str()
      ->check(CLI::Range(1, 4096));
  add_json(command, options.form, "JSON on standard output");
  command.callback([&] {
    work = [&] {
      if (options.database.empty()) options.database = default_database();
      return bench_effects_command(options);
    };
  });
}

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
  command.add_option("--workers", options.workers, "Evaluations at once (default: one a core)")
      ->check(CLI::Range(1, 4096));
  add_json(command, options.form, "The result on standard output");
  command.footer(study_footer);
  command.callback([&] {
    work = [&] {
      if (options.database.empty()) options.database = default_database();
      return study_command(options);
    };
  });
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

int usage_error(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == 0) return app.exit(error);  // help and version
  std::string command = "repose";
  for (const CLI::App* chosen : app.get_subcommands()) command += " " + chosen->get_name();
  std::cerr << "repose: " << error.what() << "\nTry `" << command << " --help`.\n";
  return exit_code::misused;
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
    app.parse(argc, argv);
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
