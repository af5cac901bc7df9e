/// Which points to evaluate next: expected improvement of the misfit, composed from the emulators
/// of the observables.
///
///   r_j ~ N(a_j, b_j^2),  a_j = (mu_j - y_j) / sigma_j,  b_j = sd_j / sigma_j
///   E Q   = p(u) + sum (a^2 + b^2)
///   EI(u) = 1/S sum_s tau log(1 + exp((Q* - Q_s(u)) / tau)),  tau = 0.05 (1 + Q*)
///   maximised: log EI(u) + log P_ok(u) - log cost(u)
///              + sum_c log(1 - exp(-|u - c|^2 / (2 rho^2))),  rho = 0.35 sqrt(d)
///
///   mu, sd  emulator   y, sigma  target   p  misfit of the priors, where there are any
///   Q_s     p + sum r_j^2 of one of S = 64 fixed antithetic draws
///   Q*      smallest E Q over the evaluated points: the model's value, never the luckiest run's
///   P_ok    chance that a run succeeds   cost  grain-steps of an evaluation
///   c       the batch's points so far that explore; the emulator believes in its own word there
///
/// Source: composite expected improvement, Astudillo & Frazier 2019 (ICML); distribution of the
///         squared norm, Uhrenholt & Jensen 2019 (PMLR 89, 2661-2670); points of a batch kept apart,
///         after Gonzalez, Dai, Hennig & Lawrence 2016 (PMLR 51, 648-657), at a fixed distance.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "calibrator/ledger.hpp"
#include "calibrator/offset.hpp"
#include "calibrator/search_space.hpp"
#include "calibrator/surrogate.hpp"

namespace repose::calibrator {

/// What the emulator of a fitted measurement is compared with.
struct Target {
  std::size_t measurement = 0;
  double value = 0.0;     ///< SI, at the search fidelity: measured minus offset
  double variance = 0.0;  ///< SI squared: of measurement, allowance and offset
};

/// Of the fitted measurements.
std::vector<Target> targets_of(const Calibration& calibration, const Offset& offset);

/// a_j and b_j.
struct Residual {
  double mean = 0.0;
  double deviation = 0.0;
};
std::vector<Residual> residuals(const Surrogate& surrogate,
                                std::span<const Target> targets,
                                std::span<const double> point);

/// P_ok: the vote of the five nearest sites, weighted by 1 / distance^2.
class Feasibility {
 public:
  explicit Feasibility(std::span<const Site> sites);
  [[nodiscard]] double at(std::span<const double> point) const;  ///< from 0.001 to 1

 private:
  std::vector<UnitPoint> at_;
  std::vector<double> share_;  ///< of the runs there that succeeded
  bool none_failed_ = true;
};

/// log cost, relative: a linear regression of the logarithm of grain-steps on the point.
class CostModel {
 public:
  explicit CostModel(std::span<const Site> sites);
  [[nodiscard]] double logarithm_at(std::span<const double> point) const;  ///< 0 where unknown

 private:
  Eigen::VectorXd slopes_;  ///< empty: unknown
};

/// What is known when a decision is due.
struct Outlook {
  const Ledger& ledger;
  const Surrogate& surrogate;
  std::span<const Target> targets;
};

/// E Q.
double expected_misfit(const Outlook& outlook, std::span<const double> point);

/// The point of smallest expected misfit among those that can be expected to run.
UnitPoint recommend(const Outlook& outlook, std::span<const UnitPoint> starts);

/// `count` points for the next batch; one that repeats a site, or another of the batch, asks for a
/// replicate there. `round` counts the batches.
std::vector<UnitPoint> propose(const Outlook& outlook,
                               const UnitPoint& recommended,
                               int count,
                               int round);

/// The site that is as good as the point and next to it, if there is one; else the point.
UnitPoint settle(const Outlook& outlook, const UnitPoint& point);

}  // namespace repose::calibrator
