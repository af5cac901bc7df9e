/// Suspect: a physical effect that a model may lack, on a scale of strength: 0 is absent, 1 is
/// strong but plausible.
///
///   value = null + strength (strong - null)        of each of its parameters, held to their bounds
///   value = what the model has (1 + swing strength)  where the effect changes a parameter in use
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "calibrator/calibration.hpp"
#include "engine/parameter_set.hpp"

namespace repose::calibrator {

/// Beyond it a strength is no longer plausible.
inline constexpr double largest_strength = 1.3;

/// Friction of the walls that differs from the grains': a suspect, though no effect of its own.
inline constexpr std::string_view own_wall_friction = "wall_friction";

/// A parameter that a suspect moves.
struct Lever {
  engine::ParameterKey key;
  double null_value = 0.0;  ///< SI
  double strong = 1.0;      ///< SI; the swing where `relative`
  double lower = 0.0, upper = 1.0;
  bool relative = false;
  bool whole = false;  ///< only whole values mean anything

  [[nodiscard]] double value(const engine::ParameterSet& parameters, double strength) const;
};

struct Suspect {
  std::string name;   ///< of the effect in the catalogue
  std::string title;  ///< for people
  std::vector<Lever> levers;
  bool two_sided = false;
  std::string objection = {};  ///< why it cannot be weighed with this study; empty: it can

  void apply(engine::ParameterSet& parameters, double strength) const;

  /// The nearest strength that the levers can tell: whole numbers of spheres leave gaps.
  [[nodiscard]] double snapped(double strength) const;
};

/// Frees the suspect's parameters from null in a calibration: those of the grains, the others tied
/// to them.
void extend(const Suspect& suspect, const engine::ParameterSet& best, Calibration& calibration);

/// Every effect of the catalogue that the calibration left at null: those it names as suspects, or
/// all. `best` gives the grains' size and stiffness.
std::vector<Suspect> suspects_of(const Calibration& calibration, const engine::ParameterSet& best);

}  // namespace repose::calibrator
