/// Screen: what would each departure from the calibrated model gain, before any refit?
///
///   U_k = g_k' P r     I_k = g_k' P g_k     phi_k = U_k / I_k     S_k = 2 phi_k U_k - phi_k^2 I_k
///   absorbed_k = 1 - I_k / |g_k|^2          c_jk = g_j' P g_k / sqrt(I_j I_k)
///
///   r  whitened residuals, then the prior's     g_k  whitened change of the predictions per unit
///   of strength, then zeros     P  projector off the tangent space of the free parameters
///
/// A trace that was read from runs carries their scatter, which adds to I without any power:
///
///   noise_k = sum_i w_ik^2 v_ki,  W = P L^-1     power_k = (I_k - noise_k)^2 / I_k
///
///   v_ki  variance of the change of target i per unit of strength     power_k  what I_k would be
///   worth without scatter: phi^2 power_k is the noncentrality of S_k
///
/// phi is held within 0 (or its mirror image, where strengths have two signs) and 1.3. A change
/// that the free parameters can imitate is absorbed: it leaves no trace whatever its strength.
///
/// Source: score test, Rao 1948, Proc. Camb. Phil. Soc. 44, 50-57; one-sided at a bound, Self &
/// Liang 1987, J. Am. Stat. Assoc. 82, 605-610; projection, Plumlee 2017, J. Am. Stat. Assoc. 112,
/// 1274-1285. The joint null is drawn: Westfall & Young 1993, Resampling-based multiple testing.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "calibrator/diagnosis/model_fit.hpp"
#include "calibrator/diagnosis/suspect.hpp"

namespace repose::calibrator {

/// Similarity beyond which two traces are one.
inline constexpr double alike = 0.95;

/// How the predictions change along one departure.
struct Departure {
  Eigen::VectorXd change;  ///< of the targets per unit of strength, in their units
  bool two_sided = false;
  Eigen::VectorXd variance = {};  ///< of the change, where it was read from runs
};

struct Score {
  double value = 0.0;        ///< S: what -2 log likelihood would fall by
  double strength = 0.0;     ///< phi, one step; too small where much is absorbed
  double information = 0.0;  ///< I
  double noise = 0.0;        ///< part of I that is scatter of the runs behind the trace
  double absorbed = 0.0;     ///< share that the free parameters imitate
};

/// What the information is worth: beyond scatter.
double power_of(const Score& score);

/// Departures of a model, scored together.
class Screen {
 public:
  Screen(const ModelFit& base, const ModelSpace& space, std::vector<Departure> departures);

  [[nodiscard]] const std::vector<Score>& scores() const { return scores_; }
  [[nodiscard]] const Eigen::MatrixXd& similarity() const { return similarity_; }  ///< c_jk

  /// Whether the data cannot tell two departures apart. Mirror images are told apart where neither
  /// strength can fall below zero: what speaks for one speaks against the other.
  [[nodiscard]] bool same_trace(std::size_t a, std::size_t b) const;

  /// What is left of a departure once the free parameters have done their best, whitened: one value
  /// per target, then the prior's.
  [[nodiscard]] Eigen::VectorXd projected(std::size_t departure) const {
    return projected_.row(static_cast<Eigen::Index>(departure)).transpose();
  }

  /// What two departures would gain together; below zero where that needs a strength below zero.
  [[nodiscard]] double pair_gain(std::size_t a, std::size_t b) const;

  /// One draw of data from the model: the largest score among the departures [0, named) and among
  /// the rest, and the misfit.
  struct Draw {
    double named = 0.0;
    double unnamed = 0.0;
    double misfit = 0.0;
  };

  /// `freedom`: of each target's standard error, where that was itself estimated; infinite where it
  /// is known. Each residual is then a Student's t.
  [[nodiscard]] std::vector<Draw> draw_null(std::size_t named,
                                            const Eigen::VectorXd& freedom,
                                            std::uint64_t seed,
                                            int draws = 4000) const;

 private:
  std::vector<Departure> departures_;
  Eigen::MatrixXd projector_;
  Eigen::MatrixXd projected_;  ///< rows g_k' P
  Eigen::VectorXd slopes_;     ///< U
  Eigen::MatrixXd products_;   ///< g_j' P g_k
  std::vector<Score> scores_;
  Eigen::MatrixXd similarity_;
};

/// Share of the draws in which that is at least x.
double share_at_least(std::span<const Screen::Draw> null, double Screen::Draw::*what, double x);

}  // namespace repose::calibrator
