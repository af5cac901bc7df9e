/// Measurement: one observable as the laboratory saw it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/experiment.hpp"

namespace repose::calibrator {

/// Whether a measurement is fitted, or set aside to see whether the model predicts it.
enum class Role : std::uint8_t { fit, held_out };

inline constexpr std::array<std::string_view, 2> role_names{"fit", "held_out"};

struct Measurement {
  engine::Experiment experiment;  ///< its fidelity is the budget's
  std::string observable;
  double value = 0.0;           ///< SI
  double standard_error = 0.0;  ///< SI; standard uncertainty of `value`, k = 1
  double allowance = 0.0;       ///< SI; stated model discrepancy, added in quadrature
  int replicates = 0;           ///< that `standard_error` was estimated from; 0: it is known
  Role role = Role::fit;
  engine::Unit unit;  ///< as the user gave it; for printing only
  std::string source;
  int curve = 0;  ///< which curve of the study it is a point of, from 1; 0: of none

  bool operator==(const Measurement&) const = default;
};

/// The same experiment under the same settings, defaults spelt out or not, whatever the fidelity.
bool is_same_question(const engine::Experiment& a, const engine::Experiment& b);

/// Set aside, not fitted.
inline bool held_out(const Measurement& measurement) { return measurement.role == Role::held_out; }

/// Two readings of one thing, whatever they read and whoever made them.
bool is_same_quantity(const Measurement& a, const Measurement& b);

/// The measurements as a reader sees them: the points of a curve together, any other by itself.
std::vector<std::span<const Measurement>> lines_of(std::span<const Measurement> measurements);

/// The setting that changes along the points of a curve.
std::string setting_along(std::span<const Measurement> curve);

}  // namespace repose::calibrator
