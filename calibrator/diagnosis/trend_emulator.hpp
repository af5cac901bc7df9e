/// TrendEmulator: many observables at once over a few dozen or hundred runs, in place of the
/// simulations while models are compared.
///
///   f_j(x) = b_j0 + b_j'x + Z_j(x),
///   cov Z_j = s_j^2 (exp(-|x - x'|^2 / (2 l_j^2)) + n_j [same run])
///
///   x  inputs over their scales     l_j of {0.45, 0.9, 1.8}     n_j of {0.003, 0.02, 0.1, 0.5}
///   s_j^2, b_j  by generalised least squares; l_j, n_j by restricted likelihood
///
/// The lengths come from a short list, so that observables share their factorisations: a
/// diagnosis asks for dozens of such emulators, its tests for a hundred thousand. The calibration's
/// own emulator (surrogate.hpp) fits every length and is a hundred times dearer.
///
/// Source: Rasmussen & Williams 2006, eqs. 2.25-2.26 and 2.41-2.42.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace repose::calibrator {

class TrendEmulator {
 public:
  using Matrix = Eigen::MatrixXd;
  using Vector = Eigen::VectorXd;

  /// Of each output, the inputs that it depends on.
  using Heard = std::vector<std::vector<Eigen::Index>>;

  /// A row is a run, a column an input or an output; outputs are NaN where a run observed nothing.
  /// Without `heard` every output depends on every input.
  TrendEmulator(const Matrix& inputs, const Matrix& outputs, Vector scale, const Heard& heard = {});

  [[nodiscard]] Eigen::Index outputs() const { return noise_.size(); }

  /// Whether enough runs observed the output for a trend; if not, all about it is NaN.
  [[nodiscard]] bool knows(Eigen::Index output) const { return noise_(output) >= 0.0; }

  [[nodiscard]] Vector mean(const Vector& x) const;
  [[nodiscard]] Matrix jacobian(const Vector& x) const;  ///< outputs x inputs
  [[nodiscard]] Vector variance(const Vector& x) const;  ///< of the mean, a run's scatter left out
  [[nodiscard]] const Vector& noise() const { return noise_; }  ///< variance of one run

 private:
  /// Outputs that depend on the same inputs, were observed in the same runs, and share length and
  /// noise.
  struct Block {
    std::vector<Eigen::Index> outputs;
    std::vector<Eigen::Index> inputs;
    double length = 0.0;
    Matrix runs;  ///< inputs over scale
    Eigen::LLT<Matrix> root;
    Matrix basis;  ///< root^-1 [1 x]
    Eigen::LLT<Matrix> basis_root;
    Matrix trend;    ///< inputs + 1 x outputs
    Matrix weights;  ///< runs x outputs
    Vector variance;
  };

  void learn(const std::vector<Eigen::Index>& heard,
             const Matrix& runs,
             const std::vector<Eigen::Index>& columns,
             const Matrix& y);
  [[nodiscard]] static Vector correlations(const Block& block, const Vector& x);

  Vector scale_;
  Vector noise_;  ///< below zero: unknown
  std::vector<Block> blocks_;
};

}  // namespace repose::calibrator
