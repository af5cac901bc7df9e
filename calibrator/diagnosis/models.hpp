/// Models: the calibrated model, and it with suspects added, each fitted to the targets on an
/// emulator of all runs in which no other suspect was on.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "calibrator/diagnosis/model_fit.hpp"
#include "calibrator/diagnosis/question.hpp"
#include "calibrator/diagnosis/suite_runs.hpp"
#include "calibrator/diagnosis/trend_emulator.hpp"
#include "engine/random.hpp"

namespace repose::calibrator {

/// Effects that a model adds, by their index among the suspects.
using Additions = std::vector<std::size_t>;

struct Model {
  Additions on;
  TrendEmulator emulator;
  ModelSpace space;
  ModelFit fit;
};

/// Points that the targets allow: the optimum, then draws from the normal law about it, held to the
/// box.
std::vector<Eigen::VectorXd> draws_of(const Model& model, int count, engine::Random& random);

class Models {
 public:
  Models(const DiagnosisQuestion& question, const SuiteRuns& runs);

  /// The calibrated model, looked for from the calibration's best set, the middle of the box and a
  /// few sets more.
  [[nodiscard]] Model fit_calibrated() const;

  /// The model with these suspects free, from everything that has been run so far.
  [[nodiscard]] Model fit(const Additions& on, std::span<const Eigen::VectorXd> starts) const;

  /// Moves a model with one addition to where its profile over the strength lies lowest, if that is
  /// below where its own search ended.
  void deepen(Model& model) const;

  /// 95 % interval of the strength of its first addition, by the profile of its posterior.
  struct Range {
    double lower = 0.0, upper = 0.0;
  };
  [[nodiscard]] Range strength_range(const Model& model) const;

  /// Variance of one run, per measurement; below zero where it is not known.
  [[nodiscard]] Eigen::VectorXd noise() const { return learn({}).noise(); }

  /// Measurements that are fitted and that enough runs have observed.
  [[nodiscard]] const std::vector<Eigen::Index>& fitted() const { return fitted_; }
  [[nodiscard]] bool knows_all_fitted() const;  ///< whether that is every one of the study's
  [[nodiscard]] const Eigen::VectorXd& targets() const { return targets_; }

  [[nodiscard]] Predictor predictor(const TrendEmulator& emulator) const;
  [[nodiscard]] Eigen::MatrixXd covariance(const TrendEmulator& emulator,
                                           const Eigen::VectorXd& at) const;
  [[nodiscard]] ModelSpace space(const Additions& on) const;

  /// The chance of such a misfit where nothing more is missing, estimated errors accounted for.
  [[nodiscard]] double misfit_p(const ModelFit& fit, const ModelSpace& space) const;

  /// The same of the measurements held out, which the fitted ones predict only as well as they
  /// know the parameters; 1 where none is held out and can be predicted.
  ///
  ///   Q = r' V^-1 r,   V = Sigma + J (J_f' J_f + M)^-1 J',   M of the prior, J_f of the fit
  ///
  /// What fitted and held-out readings share of a tolerance is left out: Q is smaller for it.
  [[nodiscard]] double held_out_p(const Model& model) const;

 private:
  [[nodiscard]] TrendEmulator learn(const Additions& on) const;
  void settle(Model& model, std::span<const Eigen::VectorXd> starts) const;

  /// The best fit at each strength of a grid, started from its neighbour's.
  [[nodiscard]] std::vector<ModelFit> profile(const Model& model) const;

  const DiagnosisQuestion& question_;
  const SuiteRuns& runs_;
  std::vector<Eigen::Index> fitted_;
  Eigen::VectorXd targets_;
};

}  // namespace repose::calibrator
