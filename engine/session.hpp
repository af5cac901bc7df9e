/// Session: one experiment at work: its world, its limits, and what may end it early. An
/// experiment's protocol reads as calls on a session; each call that can fail returns false, and
/// failure() says why.
#pragma once

#include <concepts>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/amendment.hpp"
#include "engine/catalogue.hpp"
#include "engine/experiment.hpp"
#include "engine/result.hpp"
#include "engine/size_population.hpp"
#include "engine/world.hpp"

namespace repose::engine {

/// What an experiment sets up before the first grain.
struct Apparatus {
  std::vector<Surface> walls;
  Vec3 period;                   ///< m; 0 where not periodic
  Vec3 low, high;                ///< corners of the room, m; grains that leave it are removed
  double time_step_share = 0.2;  ///< time step over the Rayleigh time of the smallest grain
  double fastest = 1.0;          ///< speed at which grains may meet, m/s
  bool closed = false;           ///< no grain may leave the room: one that does went through a wall
};

/// Radii of the grains that a parameter set describes, m.
struct GrainRadii {
  double smallest = 0.0;  ///< of the smallest sphere, be it a grain or a member of a clump
  double largest = 0.0;   ///< of the sphere that holds the largest grain
};
GrainRadii grain_radii(const ParameterSet& parameters);

class Session {
 public:
  Session(const Trial& trial, const Run& run);

  /// Makes the world; refuses a time step that is not stable.
  bool set_up(const Apparatus& apparatus);

  [[nodiscard]] World& world() { return *world_; }
  [[nodiscard]] const Material& grain() const { return model_.material(MaterialId::grain); }
  /// Radius of the sphere that holds the largest grain, m.
  [[nodiscard]] double largest_radius() const { return radii_.largest; }
  [[nodiscard]] std::uint64_t seed() const { return trial_.seed; }
  /// Rayleigh time of the smallest sphere, s.
  [[nodiscard]] double rayleigh() const { return rayleigh_time(radii_.smallest, grain()); }
  /// How long the shortest collision at that speed lasts, s.
  [[nodiscard]] double impact_time_at(double speed) const;
  /// Mass of the mean grain, kg.
  [[nodiscard]] double grain_mass() const;

  /// A new grain of the population as the sphere that holds it: its size depends on the seed and on
  /// how many grains were put in before it.
  [[nodiscard]] GrainRow next_grain() const;
  /// Puts that grain in where its sphere now is, with its motion; a clump's orientation depends on
  /// the seed and on how many grains were put in before it.
  void put(const GrainRow& grain_row);

  /// Counts grains that a filling procedure wanted to put in.
  void request(std::uint64_t grains) { requested_ += grains; }

  /// Steps until the condition holds (true) or the run must end (false). The condition is asked
  /// every `watch` seconds; reaching `limit` (s) is a failure of that kind with that message.
  bool until(const std::function<bool()>& condition,
             double watch,
             double limit,
             FailureKind kind,
             const std::string& message);
  bool run_for(double seconds);
  /// Waits until the bed is at rest: mean kinetic energy per grain, the spin of spheres left out,
  /// below 1e-4 m g d for 0.05 s.
  bool rest(double limit);
  /// The same where it is no failure that the bed still moves at the limit: false then, too.
  bool comes_to_rest(double limit);

  /// Marks the end of a part of the protocol: a frame with that name.
  void stage(std::string_view name);

  /// Grains that left the room so far.
  [[nodiscard]] std::uint64_t left_the_room() const { return left_; }

  bool fail(FailureKind kind, const std::string& message);
  [[nodiscard]] bool failed() const { return failure_.has_value(); }
  [[nodiscard]] Failure failure() const;
  [[nodiscard]] Effort effort() const;

 private:
  bool steps(std::uint64_t count);
  [[nodiscard]] std::uint64_t steps_in(double seconds) const;
  bool check();
  void emit(std::string_view stage);

  const Trial& trial_;
  const Run& run_;
  ContactModel model_;
  SizePopulation sizes_;
  std::optional<ClumpShape> shape_;  ///< of every grain; none: spheres
  GrainRadii radii_;
  Apparatus apparatus_;
  std::optional<World> world_;
  std::optional<Failure> failure_;
  std::uint64_t requested_ = 0;
  std::uint64_t left_ = 0;
  double largest_overlap_ = 0.0;
  double overlap_at_rest_ = 0.0;
  double next_frame_ = 0.0;
  std::vector<FrameGrain> frame_grains_;
};

/// The value of an observable, SI, or why it could not be read.
using Reading = Result<double, std::string>;

/// What an experiment returns: a reading for each of its observables in the order of its table, or
/// nothing when the session failed.
using Readings = std::optional<std::vector<Reading>>;

/// The observations of an experiment, or a failure where none of its observables could be read.
Outcome outcome_of(const Readings& readings,
                   std::span<const ObservableInfo> observables,
                   const Session& session);

/// Problems of a trial that need no run to be seen; empty when there are none.
std::string check(const ExperimentInfo& info, const Trial& trial);

/// A catalogue entry from the experiment's file.
template <class E>
constexpr ExperimentInfo describe(std::span<const FieldInfo> settings,
                                  std::string (*refusal)(const Trial&),
                                  Evaluation (*run)(const Trial&, const Run&)) {
  return {E::text.name,
          E::text.title,
          E::text.summary,
          E::text.procedure,
          E::text.citation,
          settings,
          E::observables,
          refusal,
          run};
}

/// An experiment that knows of apparatus that cannot work: its refuse() says why, of settings and
/// the diameter of the sphere that holds the largest grain (m), before anything runs; empty: fine.
template <class E>
concept Refuses = requires(const typename E::Settings& settings, double largest_grain_diameter) {
  { E::refuse(settings, largest_grain_diameter) } -> std::same_as<std::string>;
};

/// A trial that was found in order: as its experiment's conditions leave it, all settings given.
template <class E>
struct Checked {
  Trial trial;
  typename E::Settings settings{};
};

/// Or the problem.
template <class E>
Result<Checked<E>, std::string> checked(const Trial& trial) {
  const ExperimentInfo& info = *find_experiment(E::text.name);
  if (std::string problem = check(info, trial); !problem.empty()) return Unexpected{problem};
  Checked<E> result;
  const std::vector<double> values = resolved_settings(info, trial.experiment);
  for (std::size_t i = 0; i < E::fields.size(); ++i) {
    result.settings.*E::fields[i].member = values[i];
  }
  Conditions conditions{};
  for (std::size_t i = 0; i < condition_fields.size(); ++i) {
    conditions.*condition_fields[i].member = values[E::fields.size() + i];
  }
  result.trial = {amended(trial.parameters, conditions), trial.experiment, trial.seed};
  if (const std::string problem = check(info, result.trial); !problem.empty()) {
    return Unexpected{"under the experiment's conditions " + problem};
  }
  return result;
}

/// Why the apparatus cannot work with grains of those parameters.
template <class E>
std::string refusal(const typename E::Settings& settings, const ParameterSet& parameters) {
  if constexpr (Refuses<E>) return E::refuse(settings, 2.0 * grain_radii(parameters).largest);
  return {};
}

/// Why a protocol would not begin; empty: it would.
template <class E>
std::string refusal(const Trial& trial) {
  const auto question = checked<E>(trial);
  return question ? refusal<E>(question->settings, question->trial.parameters) : question.error();
}

/// Runs a protocol: checks, settings, session, answer.
template <class E>
Evaluation conduct(const Trial& trial, const Run& run) {
  const auto refused = [&](const std::string& problem) {
    return Evaluation{trial, Failure{FailureKind::bad_input, problem, 0.0}, {}};
  };
  const auto question = checked<E>(trial);
  if (!question) return refused(question.error());
  const auto& [here, settings] = *question;
  if (const std::string reason = refusal<E>(settings, here.parameters); !reason.empty()) {
    return refused(reason);
  }
  Session session(here, run);
  const Readings readings = E::run(settings, session);
  return {trial, outcome_of(readings, E::observables, session), session.effort()};
}

}  // namespace repose::engine
