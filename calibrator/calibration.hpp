/// Calibration: the question. Which parameters are free, what was measured, what may be spent.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calibrator/measurement.hpp"
#include "engine/parameter_set.hpp"

namespace repose::calibrator {

/// How a free parameter is mapped to [0, 1]: evenly in its value or in its logarithm.
enum class Scale : std::uint8_t { linear, log };

inline constexpr std::array<std::string_view, 2> scale_names{"linear", "log"};

/// What is known of a parameter beforehand: a normal distribution, cut off at the bounds.
struct Prior {
  double mean = 0.0;       ///< SI
  double deviation = 1.0;  ///< SI

  bool operator==(const Prior&) const = default;
};

struct FreeParameter {
  engine::ParameterKey key;
  double lower = 0.0;  ///< SI
  double upper = 1.0;  ///< SI
  Scale scale = Scale::linear;
  engine::Unit unit;                ///< as the user gave it; for printing only
  std::optional<Prior> prior = {};  ///< none: every value of the scale is as likely

  bool operator==(const FreeParameter&) const = default;
};

/// A parameter that follows another: value = factor x the other's.
struct Tie {
  engine::ParameterKey key;
  engine::ParameterKey to;
  double factor = 1.0;

  bool operator==(const Tie&) const = default;
};

/// A relation that every parameter set keeps: sum of coefficient x parameter <= bound.
struct Constraint {
  struct Term {
    engine::ParameterKey key;  ///< free, tied or fixed
    double coefficient = 1.0;

    bool operator==(const Term&) const = default;
  };
  std::vector<Term> terms;
  double bound = 0.0;  ///< SI
  engine::Unit unit;   ///< as the user gave it; for printing only

  bool operator==(const Constraint&) const = default;
};

/// What proposes the parameter sets: ours, or one of the baselines (calibrator/baselines/) that it
/// is compared with.
enum class Method : std::uint8_t {
  repose,
  bobyqa,
  cobyla,
  sbplx,
  crs2,
  isres,
  direct_l,
  mlsl,
  cma_es,
  filter,
};

inline constexpr std::array<std::string_view, 10> method_names{
    "repose",
    "bobyqa",
    "cobyla",
    "sbplx",
    "crs2",
    "isres",
    "direct_l",
    "mlsl",
    "cma_es",
    "filter",
};

/// What may be spent; the search ends with whatever is spent first. One evaluation is every
/// experiment of the study at one parameter set with one seed.
struct Budget {
  int evaluations = 60;
  /// Of computing, all cores together, and of waiting. No clock repeats itself: another run of the
  /// study may stop elsewhere, only a replay from the store stops where it did.
  std::optional<double> core_seconds = {};
  std::optional<double> wall_seconds = {};
  int batch = 4;  ///< evaluations proposed at a time; part of the question, so that the number of
                  ///< workers is not
  engine::Fidelity fidelity = engine::Fidelity::standard;
  /// Fidelity of the runs that confirm the best set. Where it differs from `fidelity`, the offset
  /// between the two is learnt from paired runs and carried by every prediction.
  engine::Fidelity confirm_fidelity = engine::Fidelity::standard;
  /// Runs at draft fidelity beside a dearer search, where paired runs prove that they help; they
  /// are not counted as evaluations.
  int draft_runs = 0;
  Method method = Method::repose;
  /// Begin with what the store has: runs of the same experiments at parameter sets of this study,
  /// made before it was asked.
  bool warm_start = false;

  bool operator==(const Budget&) const = default;
};

/// Where a calibration comes from that adds an effect to another's model.
struct Extension {
  std::int64_t calibration = 0;           ///< the one it extends
  std::optional<std::int64_t> diagnosis;  ///< whose runs it starts from too
  std::string effect;                     ///< that is added

  bool operator==(const Extension&) const = default;
};

struct Calibration {
  std::string name;
  engine::ParameterSet fixed;  ///< materials' properties and fixed parameters
  std::vector<FreeParameter> free;
  std::vector<Tie> tied;
  std::vector<Constraint> constraints = {};
  std::vector<Measurement> measurements;
  std::vector<std::string> suspects;  ///< effects to be weighed by the diagnosis
  Budget budget;
  std::uint64_t seed = 1;
  std::optional<Extension> extends = {};

  bool operator==(const Calibration&) const = default;
};

}  // namespace repose::calibrator
