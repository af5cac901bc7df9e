/// Excuses: departures that are no physics of the grains: an apparatus that reads wrongly, by the
/// same share everywhere or along a condition of the experiment. They need no runs. Where one does
/// as well as an effect the effect is not proved; where one does better it says where to look.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "calibrator/diagnosis/models.hpp"
#include "calibrator/diagnosis/question.hpp"

namespace repose::calibrator {

struct ExcuseDirection {
  std::string observable;  ///< "drop.restitution"
  std::string setting;     ///< empty: an offset
  Eigen::VectorXd change;  ///< of the fitted measurements for 100 % of their sizes, SI
};

/// An offset of every observable, and a trend with every setting that its measurements differ in.
std::vector<ExcuseDirection> excuse_directions(const DiagnosisQuestion& question,
                                               const std::vector<Eigen::Index>& fitted);

/// The calibrated model with the excuse's size free.
struct ExcuseFit {
  double size = 0.0;
  double deviance = 0.0;
  double misfit = 0.0;
  double p = 1.0;  ///< of the misfit
};
ExcuseFit fit_excuse(const Models& models, const Model& base, const ExcuseDirection& direction);

/// The one apparatus without whose readings the others would not ask for the model's additions;
/// empty: there is none. What is right about it alone may be anything, so this is every excuse that
/// an apparatus could have, offsets of each of its readings.
std::string sole_witness(const DiagnosisQuestion& question,
                         const Models& models,
                         const Model& model);

}  // namespace repose::calibrator
