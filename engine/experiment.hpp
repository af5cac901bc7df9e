/// Experiment: which virtual test is asked for; Evaluation: what it answered.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "engine/field.hpp"
#include "engine/frame.hpp"
#include "engine/parameter_set.hpp"
#include "engine/team.hpp"

namespace repose::engine {

/// How large a version of an experiment is run. Results of different fidelity are different
/// quantities: they are never mixed without a correction.
enum class Fidelity : std::uint8_t { draft, standard, paper };

inline constexpr std::array<std::string_view, 3> fidelity_names{"draft", "standard", "paper"};

/// Which virtual experiment, how large, and the settings that differ from that size's defaults.
struct Experiment {
  std::string name;
  Fidelity fidelity = Fidelity::standard;
  std::map<std::string, double> settings;  ///< SI; sparse

  bool operator==(const Experiment&) const = default;
};

/// A question to the engine: one experiment on one parameter set with one seed.
struct Trial {
  ParameterSet parameters;
  Experiment experiment;
  std::uint64_t seed = 1;

  bool operator==(const Trial&) const = default;
};

/// One observable as the simulation saw it. One run knows no standard error; it comes from
/// replicates.
struct Observation {
  std::string name;
  double value = 0.0;       ///< SI; NaN where it could not be read
  std::string unread = {};  ///< then why, in words
};

enum class FailureKind : std::uint8_t {
  bad_input,            ///< the question itself cannot be run; the message says why
  time_step_too_large,  ///< the step asked for exceeds the stable one
  did_not_fill,         ///< fewer grains could be inserted than the procedure needs
  did_not_rest,         ///< still moving at the time limit
  not_observed,         ///< the run ended but none of the observables could be read
  unstable,             ///< overlap beyond reason, a lost grain or a number that is none
  timed_out,            ///< the host ended it (wall-clock limit)
  cancelled,            ///< the host asked it to stop
  crashed,              ///< the process that ran it died
};

inline constexpr std::array<std::string_view, 9> failure_kind_names{
    "bad_input",
    "time_step_too_large",
    "did_not_fill",
    "did_not_rest",
    "not_observed",
    "unstable",
    "timed_out",
    "cancelled",
    "crashed",
};

struct Failure {
  FailureKind kind = FailureKind::unstable;
  std::string message;
  double simulated_seconds = 0.0;
};

/// Observations in the order of the experiment's catalogue entry, or why there are none.
using Outcome = std::variant<std::vector<Observation>, Failure>;

/// What a run took. Wall time is not here: the engine has no clock.
struct Effort {
  std::uint64_t grains = 0;     ///< grains at the end of the run
  std::uint64_t inserted = 0;   ///< grains put in
  std::uint64_t requested = 0;  ///< grains the filling procedure asked for
  std::uint64_t steps = 0;
  std::uint64_t grain_steps = 0;  ///< sum over the steps of the spheres in them
  std::uint64_t rebuilds = 0;     ///< of the neighbour list
  double time_step = 0.0;         ///< s
  double simulated_seconds = 0.0;
  double largest_overlap = 0.0;  ///< of two grains or grain and wall, over the radius, 1
  double overlap_at_rest = 0.0;  ///< the same among those seen whenever the bed came to rest
  std::uint64_t contacts = 0;    ///< closed at the end
  double bytes_per_grain = 0.0;  ///< of memory, at the end
};

struct Evaluation {
  Trial trial;
  Outcome outcome;
  Effort effort;
};

/// All that may vary while the question stays the same.
struct Run {
  std::stop_token stop = {};
  FrameSink frames = {};        ///< receives what happened; may be empty
  double frame_interval = 0.0;  ///< s of simulated time between frames; 0: only the stages' ends
  Team team = {};               ///< threads to share a large run
};

struct ObservableInfo {
  std::string_view name;
  Unit unit;
  std::string_view meaning;
  /// How far DEM codes of the same physics are apart, relative (of an angle's tangent): model
  /// predictions are never trusted more closely.
  double code_spread = 0.03;
};

struct ExperimentText {
  std::string_view name;
  std::string_view title;
  std::string_view summary;
  std::string_view procedure;  ///< the protocol in a few sentences
  std::string_view citation;
};

/// A catalogue entry: made from the experiment's file, read by everyone else.
struct ExperimentInfo {
  std::string_view name;
  std::string_view title;
  std::string_view summary;
  std::string_view procedure;
  std::string_view citation;
  std::span<const FieldInfo> settings;
  std::span<const ObservableInfo> observables;
  std::string (*refusal)(const Trial& trial);  ///< why it would not begin; empty: it would
  Evaluation (*run)(const Trial& trial, const Run& run);
};

}  // namespace repose::engine
