/// SuiteRuns: every run that a diagnosis can learn from: the calibration's own, which lie where all
/// suspects are absent, and those that it asks for.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "calibrator/calibration.hpp"
#include "calibrator/diagnosis/suspect.hpp"
#include "calibrator/evaluator.hpp"
#include "calibrator/fit.hpp"
#include "calibrator/misfit.hpp"
#include "calibrator/search_space.hpp"

namespace repose::calibrator {

/// Strengths of the suspects that are on, by their index.
using Strengths = std::map<std::size_t, double>;

struct SuiteRun {
  UnitPoint at;
  Strengths strengths;
  std::vector<double> values;  ///< SI, one per measurement; NaN where its experiment failed
};

class SuiteRuns {
 public:
  SuiteRuns(const Calibration& calibration,
            std::span<const Suspect> suspects,
            const Evaluator& evaluator,
            const Fit& fit);

  /// Every experiment of the study, once at each point; the runs are appended in that order.
  /// Strengths are snapped.
  struct Point {
    UnitPoint at;
    Strengths strengths;
  };
  void run(std::span<const Point> points);

  /// The same seeds of one point at both fidelities, pair by pair: what the other gave less what
  /// the search's gave. The search's runs are kept, the other's are another quantity.
  std::vector<std::vector<double>> run_pairs(const UnitPoint& at,
                                             engine::Fidelity other,
                                             int count);

  [[nodiscard]] const std::vector<SuiteRun>& all() const { return runs_; }
  [[nodiscard]] int spent() const { return spent_; }
  [[nodiscard]] const SearchSpace& space() const { return space_; }

  /// The runs of a model in which those suspects may be on, as an emulator wants them.
  struct Table {
    Eigen::MatrixXd inputs;   ///< run x coordinates, then strengths in the order of `on`
    Eigen::MatrixXd outputs;  ///< run x measurements
  };
  [[nodiscard]] Table table(std::span<const std::size_t> on) const;

 private:
  std::uint64_t next_seed();

  const Calibration& calibration_;
  std::span<const Suspect> suspects_;
  const Evaluator& evaluator_;
  SearchSpace space_;
  Suite suite_;
  std::vector<SuiteRun> runs_;
  int spent_ = 0;
};

}  // namespace repose::calibrator
