/// Fit: the answer to a Calibration. Best values with intervals, what the data did not determine,
/// the misfit of every measurement, and why the search stopped.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/experiment.hpp"
#include "engine/parameter_set.hpp"

namespace repose::calibrator {

struct FittedParameter {
  engine::ParameterKey key;
  double value = 0.0;           ///< SI
  double lower = 0.0;           ///< SI; 95 % interval by profile likelihood on the emulator
  double upper = 0.0;           ///< SI
  bool lower_at_bound = false;  ///< the interval ends where the search does: bound or constraint
  bool upper_at_bound = false;
  double learnt = 0.0;      ///< 1 - posterior variance / prior variance, in unit coordinates
  bool determined = false;  ///< the interval ends within the search on both sides
};

/// A direction in the (unit) space of the free parameters, and how well the data fix it.
struct Direction {
  std::vector<double> components;   ///< of unit length, in the order of the free parameters
  double posterior_to_prior = 1.0;  ///< standard deviation along it, after over before
  bool learnt = false;              ///< at most half the prior's
  /// The same as a product of powers of the parameters near the best set, the largest power 1 or
  /// -1: what is known is that product, to this relative standard uncertainty.
  std::vector<double> powers = {};
  double product_error = 0.0;
};

/// The joint posterior of the free parameters, by sampling (calibrator/posterior.hpp).
struct Posterior {
  std::vector<std::vector<double>> samples;      ///< SI, one value per free parameter; some of all
  std::vector<std::array<double, 3>> quantiles;  ///< SI, 5, 50 and 95 % of each free parameter
  double r_hat = 1.0;                            ///< the largest of any parameter
  double effective_samples = 0.0;                ///< the fewest of any parameter
};

/// A measurement that would teach much.
struct NextMeasurement {
  engine::Experiment experiment;
  std::string observable;
  bool again = false;           ///< it is among the measurements: this is it with half the error
  double predicted = 0.0;       ///< SI, at the best set
  double standard_error = 0.0;  ///< SI; assumed: the median relative one of the study, or half
  double gain = 0.0;            ///< shares of the prior variances that it would take away, summed
  std::size_t parameter = 0;    ///< that it would teach most about, index of the free ones
  double learnt = 0.0;          ///< of that parameter with it, as FittedParameter's
};

/// One measurement against the confirmed prediction.
struct Prediction {
  std::size_t measurement = 0;      ///< index into Calibration::measurements
  double predicted = 0.0;           ///< SI; mean of the confirming replicates
  double standard_error = 0.0;      ///< SI; of that mean
  int replicates = 0;               ///< that confirmed
  double scatter = 0.0;             ///< SI; standard deviation of one replicate
  double emulated = 0.0;            ///< SI; what the emulator had promised
  double emulated_deviation = 0.0;  ///< SI; its standard deviation
  double z = 0.0;                   ///< (predicted - measured) / combined standard uncertainty
};

/// One evaluation in the order of work, for the convergence plot.
struct HistoryPoint {
  int evaluation = 0;      ///< counted from 1
  std::string_view stage;  ///< "start", "replicate", "pair", "search", "confirm"
  engine::ParameterSet parameters;
  std::vector<double> values;  ///< SI, one per measurement; NaN where the experiment failed
  double misfit = 0.0;         ///< sum of squared z of this evaluation; NaN where one failed
  double best = 0.0;           ///< smallest expected misfit so far, by the emulator
};

enum class StopReason : std::uint8_t {
  hit,          ///< fresh replicates are within one standard error of every measurement
  no_better,    ///< nothing better is within the emulator's reach
  implausible,  ///< no parameter set comes within three standard errors: physics is missing
  budget,       ///< the evaluations are spent
  cancelled,
  failed,     ///< too few evaluations succeeded to learn from
  converged,  ///< a baseline had nothing more to try
};

inline constexpr std::array<std::string_view, 7> stop_reason_names{
    "hit",
    "no_better",
    "implausible",
    "budget",
    "cancelled",
    "failed",
    "converged",
};

struct Fit {
  engine::ParameterSet best;                ///< complete: fixed, free and tied
  std::vector<FittedParameter> parameters;  ///< the free ones, in the calibration's order
  std::vector<Direction> directions;        ///< best-learnt first
  Posterior posterior = {};
  std::vector<NextMeasurement> next = {};  ///< the three that would teach most, best first
  std::vector<Prediction> predictions;     ///< one per measurement, in order
  std::vector<double> offset;              ///< SI, per measurement: confirm fidelity minus fidelity
  std::vector<double> offset_error;        ///< SI, its standard error
  double misfit = 0.0;  ///< sum of z squared over the fitted measurements, confirmed
  int evaluations = 0;  ///< spent, confirmation included
  int failed = 0;       ///< of these
  StopReason stop = StopReason::budget;
  std::vector<HistoryPoint> history;
  std::vector<std::string> remarks;  ///< sentences for people: warnings, what was not learnt
};

/// Told while the work goes on.
struct Progress {
  std::string_view stage;
  int evaluations_done = 0;
  int evaluations_planned = 0;
  double misfit = 0.0;            ///< smallest expected misfit so far; NaN before there is one
  std::vector<double> predicted;  ///< SI, per measurement, there
  std::vector<double> z;          ///< per measurement, there
  engine::ParameterSet best;      ///< there: what would be recommended now; empty before
};

}  // namespace repose::calibrator
