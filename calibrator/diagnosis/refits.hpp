/// Refits: models with effects added, each fitted with everything free, in designs that follow its
/// optimum.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "calibrator/diagnosis/models.hpp"
#include "calibrator/diagnosis/question.hpp"

namespace repose::calibrator {

using Points = std::vector<SuiteRuns::Point>;

/// Runs points; false where it was asked to stop.
using Ask = std::function<bool(const std::string& stage, const Points& points)>;

/// A share of a model's box about a point.
struct Neighbourhood {
  Eigen::VectorXd centre;
  double share = 0.12;  ///< of a parameter's range, to either side; of a strength's 5/3 as much
};

/// Latin hypercube of a model's box, or of a neighbourhood; `index` tells designs apart.
Points spread(const ModelSpace& space,
              const Additions& on,
              int count,
              std::uint64_t seed,
              std::uint64_t index,
              const std::optional<Neighbourhood>& about = {});

/// SI, of every measurement, as the laboratory's apparatus would give it.
std::vector<double> predictions_of(const DiagnosisQuestion& question, const Model& model);

/// Root mean square of z over the measurements with that role; NaN where there is none.
double rms_z(const DiagnosisQuestion& question, const std::vector<double>& predicted, Role role);

/// A fitted model for people.
Refit summary_of(const DiagnosisQuestion& question,
                 const Models& models,
                 const SuiteRuns& runs,
                 const ModelFit& base,
                 const Model& model);

class Refits {
 public:
  /// `expected`: the strength of each suspect by one step from the calibrated model.
  Refits(const DiagnosisQuestion& question,
         const Models& models,
         Eigen::VectorXd base,
         std::vector<double> expected,
         Ask ask);

  /// All candidates side by side: a design over the whole box each, then designs about the running
  /// optimum that follow it; two more, one at a time, go to the foremost that has not come to rest.
  /// One that is far behind is given up, and once `runs` no longer suffice for all that are left,
  /// the foremost come first. Nothing where it was asked to stop.
  std::optional<std::vector<Model>> fit(const std::vector<Additions>& candidates, int runs);

 private:
  struct Candidate {
    Additions on;
    std::optional<Model> model = {};
    bool open = true;
  };

  [[nodiscard]] int size_of_design(const Candidate& candidate, int round) const;
  [[nodiscard]] std::vector<Candidate*> whose_turn(std::vector<Candidate>& all,
                                                   int round,
                                                   int runs) const;
  [[nodiscard]] std::vector<Eigen::VectorXd> starts_of(const Additions& on) const;
  Points design_of(const Candidate& candidate, int round);
  [[nodiscard]] bool learn(Candidate& candidate, int round) const;

  const DiagnosisQuestion& question_;
  const Models& models_;
  Eigen::VectorXd base_;
  std::vector<double> expected_;
  Ask ask_;
  std::uint64_t designs_ = 0;
};

}  // namespace repose::calibrator
