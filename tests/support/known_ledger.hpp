/// A ledger filled from a toy study, with the emulator and targets that follow from it.
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "calibrator/design.hpp"
#include "calibrator/proposal.hpp"
#include "calibrator/surrogate.hpp"
#include "tests/support/toy_study.hpp"

namespace repose::toy {

/// Everything that an Outlook refers to, at addresses that stay.
class Known {
 public:
  Known(Study study, std::size_t points, int replicates = 2)
      : study_(std::move(study)),
        evaluator_(toy::evaluator(study_)),
        ledger_(study_.calibration, evaluator_) {
    std::vector<calibrator::Ledger::Request> requests;
    for (const UnitPoint& point :
         calibrator::spread_design(points, study_.truth.size(), study_.calibration.seed)) {
      for (int r = 0; r < replicates; ++r) {
        requests.push_back({ledger_.site_at(point), r, calibrator::Level::search});
      }
    }
    ledger_.run("start", requests);
    surrogate_.emplace(calibrator::Surrogate(ledger_, nullptr));
    for (std::size_t j = 0; j < study_.sigma.size(); ++j) {
      targets_.push_back(
          {j, study_.calibration.measurements[j].value, study_.sigma[j] * study_.sigma[j]});
    }
  }
  Known(const Known&) = delete;
  Known& operator=(const Known&) = delete;

  [[nodiscard]] calibrator::Outlook outlook() const { return {ledger_, *surrogate_, targets_}; }
  [[nodiscard]] const Study& study() const { return study_; }
  [[nodiscard]] calibrator::Ledger& ledger() { return ledger_; }

 private:
  Study study_;
  calibrator::Evaluator evaluator_;
  calibrator::Ledger ledger_;
  std::optional<calibrator::Surrogate> surrogate_;
  std::vector<calibrator::Target> targets_;
};

/// y0 = 10 u0 + u2^2, y1 = 10 u1: the third parameter is all but ignored.
inline Study two_of_three(double noise, std::uint64_t seed = 1) {
  Study study;
  study.response = [](std::span<const double> u) {
    return std::vector<double>{10.0 * u[0] + 0.1 * u[2] * u[2], 10.0 * u[1]};
  };
  study.sigma = {0.5, 0.5};
  study.truth = {0.4, 0.6, 0.5};
  study.noise = noise;
  return ask(std::move(study), seed, 60, 4);
}

}  // namespace repose::toy
