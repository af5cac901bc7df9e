#include "server/studies/study_runner.hpp"

#include <algorithm>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "calibrator/calibrate.hpp"
#include "engine/catalogue.hpp"
#include "engine/evaluate.hpp"
#include "engine/unit.hpp"

namespace repose::server {

using engine::Evaluation;
using engine::Trial;

namespace {

/// Seeds of the best set's replicates, apart from those of the runs.
constexpr std::uint64_t fresh_seed = 1001;

/// What one sample of the result is asked with.
struct Question {
  std::string experiment;
  std::string observable;
  double factor;  ///< SI value of the paper's unit
  std::vector<Trial> trials;
  Samples* answers;  ///< where the sample goes, by experiment
  double cost;       ///< expected, beside others
};

/// Whether it was not run, since the study was asked to stop.
bool is_missing(const Evaluation& evaluation) {
  const auto* failure = std::get_if<engine::Failure>(&evaluation.outcome);
  return failure != nullptr && failure->kind == engine::FailureKind::cancelled;
}

/// Adds one evaluation to a sample; means are sums until all are in.
void add(Sample& sample, const Question& question, const Evaluation& evaluation) {
  sample.grain_steps += static_cast<double>(evaluation.effort.grain_steps);
  sample.simulated_seconds += evaluation.effort.simulated_seconds;
  sample.time_step = evaluation.effort.time_step;
  sample.largest_overlap_at_rest =
      std::max(sample.largest_overlap_at_rest, evaluation.effort.overlap_at_rest);
  if (const auto* failure = std::get_if<engine::Failure>(&evaluation.outcome)) {
    if (is_missing(evaluation)) return;
    if (sample.failed++ == 0) {
      sample.failure =
          std::string(engine::failure_kind_names.at(static_cast<std::size_t>(failure->kind))) +
          ": " + failure->message;
    }
    return;
  }
  for (const auto& seen : std::get<std::vector<engine::Observation>>(evaluation.outcome)) {
    if (seen.name != question.observable) continue;
    if (seen.unread.empty()) {
      sample.values.push_back(seen.value / question.factor);
    } else if (sample.failed++ == 0) {
      sample.failure = seen.unread;
    }
  }
}

Sample sample_of(const Question& question, std::span<const Evaluation> evaluations) {
  Sample sample;
  for (const Evaluation& evaluation : evaluations) add(sample, question, evaluation);
  const auto run =
      evaluations.size() - static_cast<std::size_t>(std::ranges::count_if(evaluations, is_missing));
  const auto count = static_cast<double>(std::max<std::size_t>(1, run));
  sample.grain_steps /= count;
  sample.simulated_seconds /= count;
  return sample;
}

class Runner {
 public:
  Runner(const PublishedStudy& study,
         StudySize size,
         Workers& workers,
         const std::stop_token& stop,
         const StudyObserver& observer)
      : study_(study), size_(size), workers_(workers), stop_(stop), observer_(observer) {
    result_.study = &study;
    result_.size = size;
    result_.engine_version = engine::version();
  }

  StudyResult run() {
    std::vector<Question> questions = drop_tests();
    for (const StudyExperiment& experiment : study_.experiments) add_runs(experiment, questions);
    add_variants(questions);
    // The cheapest first, so that a study that is interrupted has as many rows as its time allowed.
    std::ranges::stable_sort(questions, {}, &Question::cost);
    ask("runs and variants", questions);
    if (result_.missing == 0) search();
    return std::move(result_);
  }

 private:
  [[nodiscard]] Question question(const StudyExperiment& what,
                                  const engine::ParameterSet& parameters,
                                  const engine::Experiment& experiment,
                                  Samples& answers,
                                  std::uint64_t seed = 1) const {
    return {what.experiment,
            what.observable,
            engine::unit::find(what.unit).value().factor,
            replicate_trials(parameters, experiment, replicates_of(what, size_), seed),
            &answers,
            expected_cost(parameters)};
  }

  /// Answers all questions at once, so that every worker is busy.
  void ask(const std::string& part, const std::vector<Question>& questions) {
    std::vector<Trial> trials;
    for (const Question& each : questions) {
      trials.insert(trials.end(), each.trials.begin(), each.trials.end());
    }
    const auto tell = [&](std::size_t done, std::size_t all, bool stored) {
      if (observer_) observer_(part, done, all, stored);
    };
    const std::vector<Evaluation> evaluations = workers_.run(trials, stop_, tell);
    note(evaluations);
    std::size_t from = 0;
    for (const Question& each : questions) {
      const std::span all(evaluations);
      (*each.answers)[each.experiment] = sample_of(each, all.subspan(from, each.trials.size()));
      from += each.trials.size();
    }
  }

  void note(std::span<const Evaluation> evaluations) {
    result_.trials += evaluations.size();
    result_.missing += static_cast<std::size_t>(std::ranges::count_if(evaluations, is_missing));
    for (const Evaluation& evaluation : evaluations) {
      result_.grain_steps += static_cast<double>(evaluation.effort.grain_steps);
    }
  }

  /// Of every combination, as the paper did; once, since nothing in it is random.
  std::vector<Question> drop_tests() {
    const StudyExperiment drop{study_.drop_experiment, study_.drop_observable, "1", 0.0, 1, 1};
    std::vector<Question> questions;
    for (const StudyRun& run : study_.runs) add_run(drop, run, questions);
    return questions;
  }

  void add_run(const StudyExperiment& what, const StudyRun& run, std::vector<Question>& questions) {
    questions.push_back(question(what,
                                 run_parameters(study_, run.run),
                                 {what.experiment, fidelity_of(size_), {}},
                                 result_.runs[run.run]));
  }

  /// Every run of the study in this experiment, where the paper ran it.
  void add_runs(const StudyExperiment& what, std::vector<Question>& questions) {
    for (const StudyRun& run : study_.runs) {
      if (run.printed.contains(what.experiment)) add_run(what, run, questions);
    }
  }

  void add_variants(std::vector<Question>& questions) {
    for (const StudyVariant& variant : study_.variants) {
      result_.variants.push_back({variant.variant, {}});
    }
    for (std::size_t i = 0; i < study_.variants.size(); ++i) {
      const StudyVariant& variant = study_.variants[i];
      for (const StudyExperiment& what : study_.experiments) {
        if (std::ranges::count(variant.experiments, what.experiment) == 0) continue;
        questions.push_back(question(what,
                                     variant_parameters(study_, variant),
                                     variant_experiment(variant, what.experiment, size_),
                                     result_.variants[i].samples));
      }
    }
  }

  void search() {
    SearchResult found{study_search(study_, size_), {}, {}};
    const calibrator::Evaluator evaluator = [&](std::span<const Trial> trials) {
      const auto tell = [&](std::size_t done, std::size_t all, bool stored) {
        if (observer_) observer_("search, a batch", done, all, stored);
      };
      auto evaluations = workers_.run(trials, stop_, tell);
      note(evaluations);
      return evaluations;
    };
    found.fit = calibrator::calibrate(found.calibration, evaluator, {.stop = stop_});
    std::vector<Question> questions;
    for (const StudyExperiment& what : study_.experiments) {
      questions.push_back(question(what,
                                   found.fit.best,
                                   {what.experiment, fidelity_of(size_), {}},
                                   found.samples,
                                   fresh_seed));
    }
    ask("the best set", questions);
    result_.search = std::move(found);
  }

  const PublishedStudy& study_;
  const StudySize size_;
  Workers& workers_;
  const std::stop_token stop_;
  const StudyObserver& observer_;
  StudyResult result_;
};

}  // namespace

StudyResult run_study(const PublishedStudy& study,
                      StudySize size,
                      Workers& workers,
                      const std::stop_token& stop,
                      const StudyObserver& observer) {
  return Runner(study, size, workers, stop, observer).run();
}

}  // namespace repose::server
