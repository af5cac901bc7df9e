/// Commands: what each word of the command line does. Arguments come parsed; the exit code goes
/// back.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/experiment.hpp"

namespace repose::server {

enum class Form { text, json, markdown };

struct EvaluateCommand {
  std::string experiment;
  std::filesystem::path study;          ///< may be empty
  std::vector<std::string> parameters;  ///< FIELD:grain-grain=VALUE
  std::vector<std::string> settings;    ///< NAME=VALUE
  std::uint64_t seed = 1;
  int replicates = 1;
  unsigned threads = 1;  ///< of one run; with several replicates each has its own
  std::optional<engine::Fidelity> fidelity;
  std::filesystem::path frames;  ///< folder; empty: none written
  double frame_interval = 0.02;  ///< s of simulated time
  Form form = Form::text;
};
int evaluate_command(const EvaluateCommand& command);

/// One trial document on standard input, its answer on standard output.
int answer_command();

struct CalibrateCommand {
  std::filesystem::path study = {};
  std::vector<std::string> asked_as = {};  ///< words of the command line; empty: calibrate STUDY
  std::filesystem::path database;
  unsigned workers = 0;
  std::filesystem::path report = {};  ///< file; empty: its usual name beside the database
  bool pictures = true;
  Form form = Form::text;
};
int calibrate_command(const CalibrateCommand& command);
/// The same with the study's text in hand.
int calibrate_text(const CalibrateCommand& command, const std::string& study);

/// Of a finished calibration: compare, diagnose, extend.
struct MissingEffectCommand {
  std::int64_t id = 0;
  std::filesystem::path database;
  std::vector<std::string> tolerances;  ///< EXPERIMENT.OBSERVABLE=SHARE
  unsigned workers = 0;
  std::string effect;            ///< to extend by
  std::filesystem::path report;  ///< of the extended one
  bool pictures = true;
  Form form = Form::text;
};
int compare_command(const MissingEffectCommand& command);
int diagnose_command(const MissingEffectCommand& command);
int extend_command(const MissingEffectCommand& command);

/// Calibrations that the clock repeats.
struct ScheduleCommand {
  std::int64_t id = 0;           ///< of the schedule; to add: one to replace, 0 for a new one
  std::int64_t calibration = 0;  ///< to start from, or to put in force
  std::filesystem::path study;
  // To add; what is not given is that of the schedule replaced, or the usual.
  std::optional<std::string> name;  ///< the usual: the study's
  std::optional<std::string> cron;
  std::optional<std::string> time_zone;
  std::optional<int> jitter_minutes;
  std::optional<int> catch_up_hours;
  std::filesystem::path database;
  unsigned workers = 0;
  int limit = 50;
  bool once = false;  ///< it says so: the command does nothing else
  bool all = false;   ///< nights of every schedule, due or not
  Form form = Form::text;
};
int schedule_add_command(const ScheduleCommand& command);
int schedule_list_command(const ScheduleCommand& command);
int schedule_show_command(const ScheduleCommand& command);
int schedule_remove_command(const ScheduleCommand& command);
int schedule_history_command(const ScheduleCommand& command);
int schedule_promote_command(const ScheduleCommand& command);
int nightly_command(const ScheduleCommand& command);

/// Of the database as a file.
struct StoreCommand {
  std::filesystem::path database;
  std::filesystem::path file;  ///< the backup
};
int backup_command(const StoreCommand& command);
int restore_command(const StoreCommand& command);
int doctor_command(const StoreCommand& command);

struct ExportCommand {
  std::int64_t id = 0;
  std::filesystem::path database;
  std::string format = "json";
};
int export_command(const ExportCommand& command);

struct LineageCommand {
  std::int64_t id = 0;
  std::filesystem::path database;
  std::filesystem::path report;  ///< file; empty: the models are listed
  Form form = Form::text;
};
int lineage_command(const LineageCommand& command);

struct ReportCommand {
  std::int64_t id = 0;
  std::filesystem::path database;
  std::filesystem::path output;  ///< file; empty: its usual name in the working folder
  bool pictures = true;
};
int report_command(const ReportCommand& command);

struct ListCommand {
  std::filesystem::path database;
  int limit = 50;
  Form form = Form::text;
};
int list_command(const ListCommand& command);

struct ShowCommand {
  std::int64_t id = 0;
  std::filesystem::path database;
  Form form = Form::text;
};
int show_command(const ShowCommand& command);

/// What is ended before its end.
enum class Cancelled { calibration, diagnosis };

struct CancelCommand {
  std::int64_t id = 0;
  Cancelled what = Cancelled::calibration;
  std::filesystem::path database;
  Form form = Form::text;
};
int cancel_command(const CancelCommand& command);

struct ServeCommand {
  std::string host = "127.0.0.1";
  int port = 8080;
  std::vector<std::string> names;          ///< of this host, beside `host`, as requests may call it
  std::vector<std::string> webhook_hosts;  ///< that are not public, and may be told all the same
  std::filesystem::path database;
  unsigned workers = 0;
  double time_limit = 3600.0;  ///< s of wall time for one attempt at an evaluation
  double memory_limit = 8.0;   ///< GiB for its process
};
int serve_command(const ServeCommand& command);

struct TokenCommand {
  std::filesystem::path database;
  std::string name;              ///< of the one that is made
  std::string scope = "submit";  ///< one of scope_names
  int days = 0;                  ///< until it expires; 0: never
  std::string id;                ///< of the one that is revoked
  Form form = Form::text;
};
int create_token_command(const TokenCommand& command);
int list_tokens_command(const TokenCommand& command);
int revoke_token_command(const TokenCommand& command);

struct BenchCommand {
  std::vector<std::string> scenes{"static", "kettle", "tilting_box"};
  std::uint64_t grains = 5000;  ///< of the static scene
  bool stiff = false;
  int rounds = 3;
  unsigned threads = 1;
  std::filesystem::path bed;  ///< file for the static scene's grains; may be empty
  Form form = Form::text;
};
int bench_engine_command(const BenchCommand& command);

struct BenchEffectsCommand {
  std::vector<std::string> effects;      ///< which
  std::vector<std::string> experiments;  ///< which
  int seeds = 2;
  std::filesystem::path database;  ///< keeps the runs, so that it can be taken up again
  unsigned workers = 0;
  Form form = Form::text;
};
int bench_effects_command(const BenchEffectsCommand& command);

struct BenchCalibratorCommand {
  std::vector<std::string> cases{"A", "B", "C", "D", "E"};
  int seeds = 20;
  std::vector<std::string> methods;
  int honesty = 0;     ///< studies of each case to hold its answers to account; 0: compare methods
  int warm_start = 0;  ///< stored runs that each study starts from; 0: likewise
  Form form = Form::text;
};
int bench_calibrator_command(const BenchCalibratorCommand& command);

/// What the laboratory costs, draft and standard, on one core.
int bench_laboratory_command(Form form);

struct LaboratoryCommand {
  int sets = 12;  ///< of parameters, for the pairs of fidelities
  std::filesystem::path database;
  unsigned workers = 0;
  std::filesystem::path output;  ///< folder for the trends' page and numbers
  Form form = Form::text;
};
/// How draft readings lie to standard ones.
int bench_fidelity_command(const LaboratoryCommand& command);
/// Every observable under every parameter.
int trends_command(const LaboratoryCommand& command);

/// What an experiment is, on a screen; without a name, which there are.
int explain_command(const std::string& name);

/// What the commands of the laboratory are asked.
struct LaboratoryOptions {
  Form costs = Form::text;
  LaboratoryCommand fidelity;
  LaboratoryCommand trends;
  std::string explained;
};

struct MaterialsCommand {
  std::string name;    ///< empty: all are listed
  bool study = false;  ///< print a study to start from
  Form form = Form::text;
};
int materials_command(const MaterialsCommand& command);

struct StudyCommand {
  std::string name;
  bool quick = false;            ///< draft fidelity, few replicates
  std::filesystem::path output;  ///< folder for NAME.json and NAME.html
  std::filesystem::path database;
  unsigned workers = 0;
  Form form = Form::text;
};
int study_command(const StudyCommand& command);

int catalogue_command(Form form);

struct SchemaCommand {
  std::string name;              ///< of the schema to print; empty: their names
  std::filesystem::path folder;  ///< where they are written; empty: printed
};
int schema_command(const SchemaCommand& command);

}  // namespace repose::server
