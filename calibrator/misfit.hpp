/// Measurements against observations: what one evaluation asks of the simulations, and how far its
/// answers are from the laboratory's.
///
///   z_j = (f_j - y_j) / sigma_j,    sigma_j^2 = s_j^2 + t_j^2,    Q = sum over fitted j of z_j^2
///
///   f_j observed   y_j measured   s_j its standard error   t_j stated model discrepancy, all SI
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "calibrator/measurement.hpp"
#include "engine/experiment.hpp"

namespace repose::calibrator {

/// The distinct experiments behind the measurements, in the order in which they first appear.
/// Several observables of one experiment are read from one run.
class Suite {
 public:
  explicit Suite(std::span<const Measurement> measurements);

  /// Trials of one evaluation.
  [[nodiscard]] std::size_t size() const { return experiments_.size(); }

  /// Which of the experiments it is, whatever its fidelity; nothing where it is none of them.
  [[nodiscard]] std::optional<std::size_t> place_of(const engine::Experiment& experiment) const;

  /// From which of the experiments a measurement is read.
  [[nodiscard]] std::size_t experiment_of(std::size_t measurement) const {
    return readings_[measurement].experiment;
  }

  /// Appends the trials of one evaluation. Fidelity is not the experiment's but the caller's.
  void append_trials(const engine::ParameterSet& parameters,
                     engine::Fidelity fidelity,
                     std::uint64_t seed,
                     std::vector<engine::Trial>& trials) const;

  /// What one evaluation observed, SI, one value per measurement; NaN where the experiment failed
  /// or did not report the observable.
  [[nodiscard]] std::vector<double> read(std::span<const engine::Evaluation> evaluations) const;

  /// An observable that the same runs give and nobody measured.
  struct Unmeasured {
    engine::Experiment experiment;
    engine::ObservableInfo info;
  };
  [[nodiscard]] std::vector<Unmeasured> unmeasured() const;
  /// What one evaluation observed of these, as read().
  [[nodiscard]] std::vector<double> read_unmeasured(
      std::span<const engine::Evaluation> evaluations) const;

 private:
  struct Reading {
    std::size_t experiment;
    std::string observable;
    const engine::ObservableInfo* info = nullptr;  ///< of the unmeasured ones
  };
  static double read_one(const Reading& reading, std::span<const engine::Evaluation> evaluations);

  std::vector<engine::Experiment> experiments_;
  std::vector<Reading> readings_;    ///< one per measurement
  std::vector<Reading> unmeasured_;  ///< in the order of the experiments
};

/// sigma_j, SI.
double standard_uncertainty(const Measurement& measurement);

/// z of each measurement.
std::vector<double> standardised_residuals(std::span<const Measurement> measurements,
                                           std::span<const double> observed);

/// Q over the fitted measurements; NaN if one of them is.
double misfit(std::span<const Measurement> measurements, std::span<const double> observed);

}  // namespace repose::calibrator
