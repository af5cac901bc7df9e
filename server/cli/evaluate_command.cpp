#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <exception>
#include <iostream>
#include <limits>
#include <mutex>
#include <new>
#include <optional>
#include <set>
#include <stop_token>
#include <sys/prctl.h>
#include <thread>
#include <utility>
#include <variant>

#include "engine/catalogue.hpp"
#include "engine/evaluate.hpp"
#include "server/cli/assignment.hpp"
#include "server/cli/commands.hpp"
#include "server/cli/exit_code.hpp"
#include "server/cli/input.hpp"
#include "server/cli/interrupt.hpp"
#include "server/cli/output.hpp"
#include "server/cli/reference_grain.hpp"
#include "server/cli/text_table.hpp"
#include "server/jobs/child.hpp"
#include "server/jobs/team.hpp"
#include "server/jobs/watch.hpp"
#include "server/json/attempt_json.hpp"
#include "server/json/evaluation_json.hpp"
#include "server/json/place.hpp"
#include "server/json/replicates_json.hpp"
#include "server/laboratory/draft_bias.hpp"
#include "server/report/frame_files.hpp"
#include "server/report/label.hpp"
#include "server/report/number_text.hpp"

namespace repose::server {

using calibrator::Calibration;
using engine::Evaluation;
using engine::Experiment;
using engine::Failure;
using engine::ParameterSet;
using engine::Result;
using engine::Trial;
using engine::Unexpected;

namespace {

/// The middle of a free parameter's bounds, by its scale.
double middle(const calibrator::FreeParameter& free) {
  return free.scale == calibrator::Scale::log ? std::sqrt(free.lower * free.upper)
                                              : 0.5 * (free.lower + free.upper);
}

/// The study's values; what is free and not given stands in the middle of its bounds, with a note.
ParameterSet study_parameters(const Calibration& calibration, const ParameterSet& given) {
  ParameterSet parameters = calibration.fixed;
  for (const calibrator::FreeParameter& free : calibration.free) {
    const double value = given.get(free.key).value_or(middle(free));
    parameters.set(free.key, value);
    if (given.get(free.key)) continue;
    std::cerr << "repose: " << engine::to_string(free.key) << " is free in the study and set to "
              << number_text(value / free.unit.factor) << unit_suffix(free.unit)
              << ", the middle of its bounds; --set " << engine::to_string(free.key)
              << "=VALUE chooses another\n";
  }
  for (const calibrator::Tie& tie : calibration.tied) {
    if (const auto other = parameters.get(tie.to)) parameters.set(tie.key, tie.factor * *other);
  }
  for (const auto& [key, value] : given) parameters.set(key, value);
  return parameters;
}

/// The study's own version of the experiment where it measures with it.
void take_study_settings(const Calibration& calibration, Experiment& experiment) {
  for (const calibrator::Measurement& measurement : calibration.measurements) {
    if (measurement.experiment.name != experiment.name) continue;
    experiment.settings = measurement.experiment.settings;
    if (!experiment.settings.empty()) {
      std::cerr << "repose: settings of the study: " << settings_label(experiment) << "\n";
    }
    return;
  }
}

Unexpected<InputError> given_twice(const std::string& option, const std::string& name) {
  return Unexpected{InputError{option + ": " + name + " is given twice; give it one value", {}}};
}

Result<Trial, InputError> trial_of(const EvaluateCommand& command) {
  const engine::ExperimentInfo* info = engine::find_experiment(command.experiment);
  if (info == nullptr) return Unexpected{no_experiment(command.experiment)};
  Trial trial;
  trial.experiment.name = command.experiment;
  trial.seed = command.seed;
  ParameterSet given;
  for (const std::string& text : command.parameters) {
    const auto assignment = parse_parameter(text);
    if (!assignment) return Unexpected{InputError{"--set: " + assignment.error(), {}}};
    if (given.get(assignment->key)) {
      return given_twice("--set", engine::to_string(assignment->key));
    }
    given.set(assignment->key, assignment->value);
  }
  if (command.study.empty()) {
    trial.parameters = reference_grain();
    for (const auto& [key, value] : given) trial.parameters.set(key, value);
  } else {
    const auto study = read_study(command.study);
    if (!study) return Unexpected{study.error()};
    trial.parameters = study_parameters(*study, given);
    trial.experiment.fidelity = study->budget.fidelity;
    take_study_settings(*study, trial.experiment);
  }
  trial.experiment.fidelity = command.fidelity.value_or(trial.experiment.fidelity);
  std::set<std::string> set;
  for (const std::string& text : command.settings) {
    const auto assignment = parse_setting(*info, text);
    if (!assignment) return Unexpected{InputError{"--setting: " + assignment.error(), {}}};
    if (!set.insert(assignment->name).second) return given_twice("--setting", assignment->name);
    trial.experiment.settings[assignment->name] = assignment->value;
  }
  return trial;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Means and standard errors over the replicates; nothing where one failed.
std::vector<MeanObservation> means(const Replicates& replicates) {
  std::vector<MeanObservation> result;
  if (replicates.failed() != nullptr) return result;
  const auto* info = engine::find_experiment(replicates.trial.experiment.name);
  const auto count = static_cast<double>(replicates.evaluations.size());
  for (std::size_t k = 0; k < info->observables.size(); ++k) {
    const auto value = [&](const Evaluation& evaluation) {
      return std::get<std::vector<engine::Observation>>(evaluation.outcome).at(k).value;
    };
    double sum = 0.0, squares = 0.0;
    for (const Evaluation& evaluation : replicates.evaluations) sum += value(evaluation);
    const double mean = sum / count;
    for (const Evaluation& evaluation : replicates.evaluations) {
      squares += (value(evaluation) - mean) * (value(evaluation) - mean);
    }
    const double error = count > 1.0 ? std::sqrt(squares / (count - 1.0) / count)
                                     : std::numeric_limits<double>::quiet_NaN();
    const engine::ObservableInfo& observable = info->observables[k];
    MeanObservation& seen =
        result.emplace_back(std::string(observable.name), mean, error, observable.unit);
    for (const Evaluation& evaluation : replicates.evaluations) {
      const std::string& why =
          std::get<std::vector<engine::Observation>>(evaluation.outcome).at(k).unread;
      if (why.empty() || !seen.unread.empty()) continue;
      seen.unread = "seed " + std::to_string(evaluation.trial.seed) + ": " + why;
    }
  }
  return result;
}

/// Runs the replicates, one seed after another from the trial's on, on as many threads as there are
/// cores. The frames of the first go to files.
Replicates run_replicates(const Trial& trial,
                          const EvaluateCommand& command,
                          FrameFiles* files,
                          std::stop_token stop) {
  Replicates replicates;
  const auto size = static_cast<std::size_t>(command.replicates);
  replicates.trial = trial;
  replicates.evaluations.resize(size);
  replicates.wall_seconds.resize(size);
  std::atomic<std::size_t> next = 0;
  double written = 0.0;  // s the first replicate spent on its files
  std::exception_ptr trouble;
  std::mutex trouble_mutex;
  const auto work = [&] {
    for (std::size_t i = next++; i < size; i = next++) {
      Trial replicate = trial;
      replicate.seed += i;
      engine::Run run;
      run.stop = stop;
      run.team = team_of(command.threads);
      if (i == 0 && files != nullptr) {
        run.frames = [&](const engine::Frame& frame) {
          const auto writing = std::chrono::steady_clock::now();
          files->write(frame);
          written += seconds_since(writing);
        };
        run.frame_interval = command.frame_interval;
      }
      const auto start = std::chrono::steady_clock::now();
      try {
        replicates.evaluations[i] = engine::evaluate(replicate, run);
      } catch (...) {  // a file that cannot be written; told to the caller's thread
        const std::scoped_lock lock(trouble_mutex);
        trouble = std::current_exception();
        replicates.evaluations[i] = {replicate, Failure{}, {}};
      }
      replicates.wall_seconds[i] = seconds_since(start) - (i == 0 ? written : 0.0);
    }
  };
  const auto start = std::chrono::steady_clock::now();
  {
    std::vector<std::jthread> threads;
    const std::size_t at_once = std::max(1U, std::thread::hardware_concurrency() / command.threads);
    for (std::size_t i = 0; i < std::min(at_once, size); ++i) threads.emplace_back(work);
  }
  // The files' time is no run's; with others beside it, the longest run is the better measure.
  replicates.elapsed = size == 1 ? replicates.wall_seconds.front() : seconds_since(start);
  if (trouble) std::rethrow_exception(trouble);
  replicates.observations = means(replicates);
  return replicates;
}

/// `shown`: the run has left pictures.
void print_failure(const Evaluation& evaluation, bool shown) {
  const auto& failure = std::get<Failure>(evaluation.outcome);
  std::cerr << "repose: " << evaluation.trial.experiment.name << " failed ("
            << engine::failure_kind_names.at(static_cast<std::size_t>(failure.kind)) << ", seed "
            << evaluation.trial.seed << ", after " << number_text(failure.simulated_seconds, 3)
            << " simulated seconds): " << failure.message << "\n"
            << (shown || failure.simulated_seconds == 0.0
                    ? ""
                    : "repose: --frames FOLDER keeps a picture of what it came to\n");
}

/// "drum, draft fidelity, seed 1".
std::string run_title(const Trial& trial) {
  const auto fidelity = static_cast<std::size_t>(trial.experiment.fidelity);
  return trial.experiment.name + ", " + std::string(engine::fidelity_names.at(fidelity)) +
         " fidelity, seed " + std::to_string(trial.seed);
}

void print_text(const Replicates& replicates) {
  const Experiment& experiment = replicates.trial.experiment;
  const std::size_t count = replicates.evaluations.size();
  std::cout << experiment.name << ", "
            << engine::fidelity_names.at(static_cast<std::size_t>(experiment.fidelity))
            << " fidelity, seed " << replicates.trial.seed;
  if (count > 1) std::cout << " to " << replicates.trial.seed + count - 1;
  std::cout << "\n\n";
  TextTable observations({"observable", "value"});
  for (const MeanObservation& seen : replicates.observations) {
    observations.row({seen.name,
                      seen.unread.empty() ? with_error(seen.value, seen.standard_error, seen.unit)
                                          : "not read"});
  }
  const engine::Effort effort = replicates.effort();
  TextTable facts({"run", ""});
  facts.row({"grains", count_text(effort.grains)});
  facts.row(
      {"inserted / requested", count_text(effort.inserted) + " / " + count_text(effort.requested)});
  facts.row({"time step", number_text(1e6 * effort.time_step, 3) + " us"});
  facts.row({"steps", count_text(effort.steps)});
  facts.row({"simulated", number_text(effort.simulated_seconds, 4) + " s"});
  facts.row({"wall time", duration_text(replicates.elapsed)});
  facts.row({"particle steps per second", number_text(replicates.particle_steps_per_second(), 3)});
  facts.row({"largest overlap / radius", number_text(effort.largest_overlap, 2)});
  facts.row({"overlap at rest / radius", number_text(effort.overlap_at_rest, 2)});
  std::cout << observations.str() << "\n";
  for (const MeanObservation& seen : replicates.observations) {
    if (!seen.unread.empty()) std::cout << seen.name << ", " << seen.unread << "\n\n";
  }
  const engine::ExperimentInfo& info = *engine::find_experiment(experiment.name);
  if (draft_is_in_force(info, experiment)) {
    for (const auto& seen : info.observables) {
      const std::string words = draft_words(info, seen);
      if (!words.empty()) std::cout << seen.name << ": " << words << "\n";
    }
    std::cout << "\n";
  }
  std::cout << facts.str();
  for (const std::string& warning : warnings(replicates)) {
    std::cout << "\nwarning: " << warning << "\n";
  }
  std::cout << "\nengine " << engine::version() << "\n";
}

}  // namespace

int evaluate_command(const EvaluateCommand& command) {
  const bool json = command.form == Form::json;
  const auto trial = trial_of(command);
  if (!trial) return report_error(trial.error(), json);
  std::optional<FrameFiles> files;
  if (!command.frames.empty()) {
    if (const auto why = make_folder(command.frames)) return report_error(*why, json);
    files.emplace(command.frames, run_title(*trial));
  }
  const Interrupt interrupt;
  const Replicates replicates =
      run_replicates(*trial, command, files ? &*files : nullptr, interrupt.token());
  if (files) {
    files->write_index();
    std::cerr << "repose: " << files->frames() << " frames and " << files->pictures()
              << " pictures in " << command.frames.string()
              << "; a browser plays play.html, ParaView opens frames.pvd\n";
  }
  const Evaluation* failed = replicates.failed();
  if (json) std::cout << print_replicates(replicates, engine::version()) << "\n";
  if (failed != nullptr) {
    print_failure(*failed, files.has_value());
    return interrupt.happened() ? exit_code::interrupted : exit_code::failed;
  }
  if (!json) print_text(replicates);
  return exit_code::done;
}

int answer_command() {
  // Whoever asked is gone: nobody will read the answer.
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  ignore_interrupts();
  const auto text = read_text("-");
  if (!text) return report_error(text.error(), false);
  const auto question = parse_question(*text);
  if (!question) return report_error({"the question cannot be read", question.error()}, false);
  try {
    // Tells whoever asked that this process works.
    std::optional<Watch> sign(
        std::in_place, beat, [](const std::stop_token&) { std::cout << std::endl; });
    const std::string answer = print_answer(engine::evaluate(question->trial));
    sign.reset();
    std::cout << print_answer_to(*question, answer) << "\n";
  } catch (const std::bad_alloc&) {
    return out_of_memory_code;
  }
  return exit_code::done;
}

}  // namespace repose::server
