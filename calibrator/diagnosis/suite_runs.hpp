/// SuiteRuns: every run that a diagnosis can learn from: the calibration's own, which lie where all
/// suspects are absent, and those that it asks for.
///
/// Incidence: a suspect that leaves an experiment as it was, to the last bit and with the same
/// seed, does not touch it (a shaken kettle is nothing to a tilting box). Where none that is on
/// touches an experiment, it is not run: what is known of it without them holds.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>
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
  std::vector<double> values;  ///< SI, one per measurement; NaN where its experiment failed or was
                               ///< not run
  std::uint64_t seed = 0;      ///< 0: one of the calibration's
};

class SuiteRuns {
 public:
  SuiteRuns(const Calibration& calibration,
            std::span<const Suspect> suspects,
            const Evaluator& evaluator,
            const Fit& fit);

  /// Every experiment that a point's suspects touch, once at each point; the runs are appended in
  /// that order. Strengths are snapped.
  struct Point {
    UnitPoint at;
    Strengths strengths;
    /// That of a run at the same point without suspects: it shows what a single one touches.
    std::optional<std::uint64_t> seed = {};
  };
  void run(std::span<const Point> points);

  /// Whether a suspect moves a measurement; taken for granted until it has been seen.
  [[nodiscard]] bool touches(std::size_t suspect, std::size_t measurement) const;

  /// The same seeds of one point at both fidelities, pair by pair: what the other gave less what
  /// the search's gave. The search's runs are kept, the other's are another quantity.
  std::vector<std::vector<double>> run_pairs(const UnitPoint& at,
                                             engine::Fidelity other,
                                             int count);

  [[nodiscard]] const std::vector<SuiteRun>& all() const { return runs_; }
  [[nodiscard]] int spent() const { return spent_; }  ///< runs of the suite, whole or in part
  [[nodiscard]] const SearchSpace& space() const { return space_; }

  /// The runs of a model in which those suspects may be on, as an emulator wants them.
  struct Table {
    Eigen::MatrixXd inputs;   ///< run x coordinates, then strengths in the order of `on`
    Eigen::MatrixXd outputs;  ///< run x measurements
    std::vector<std::vector<Eigen::Index>> heard;  ///< inputs that each measurement depends on
  };
  [[nodiscard]] Table table(std::span<const std::size_t> on) const;

 private:
  std::uint64_t next_seed();
  [[nodiscard]] bool touched(std::size_t experiment, const Strengths& strengths) const;
  void learn_incidence(SuiteRun& run);

  const Calibration& calibration_;
  std::span<const Suspect> suspects_;
  const Evaluator& evaluator_;
  SearchSpace space_;
  Suite suite_;
  std::vector<SuiteRun> runs_;
  std::set<std::pair<std::size_t, std::size_t>> untouched_;  ///< suspect, experiment
  int spent_ = 0;
};

}  // namespace repose::calibrator
