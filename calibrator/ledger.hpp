/// Ledger: every evaluation of a calibration so far, where it was made and with which seed; and the
/// scatter between replicates that follows from it.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "calibrator/calibration.hpp"
#include "calibrator/evaluator.hpp"
#include "calibrator/fit.hpp"
#include "calibrator/misfit.hpp"
#include "calibrator/search_space.hpp"

namespace repose::calibrator {

/// One evaluation at a site.
struct SiteRun {
  int replicate = 0;           ///< names the seed together with the site
  std::vector<double> values;  ///< SI, one per measurement; NaN where its experiment failed
  bool succeeded = false;      ///< every fitted measurement was observed
  double grain_steps = 0.0;    ///< of all its experiments: the cost, free of any clock
  std::vector<double> unmeasured = {};  ///< SI, of Suite::unmeasured(); empty: not known
};

/// A parameter set that was evaluated, and what came of it.
struct Site {
  UnitPoint at;
  std::vector<SiteRun> searched;      ///< at the budget's fidelity
  std::vector<SiteRun> confirmed;     ///< at its confirm fidelity, where that is another
  std::vector<SiteRun> drafted = {};  ///< at draft fidelity, beside a dearer search
};

/// Scatter of one run, per measurement, pooled over all sites with replicates.
struct Scatter {
  std::vector<double> variance;  ///< SI squared
  std::vector<int> freedom;  ///< degrees of freedom; 0: `variance` is the measurement's, a guess
};

enum class Level : std::uint8_t { search, confirm, draft };

/// A run that was made for another question, and answers this one too.
struct KnownRun {
  engine::ParameterSet parameters;
  Level level = Level::search;
  std::vector<double> values;  ///< as a SiteRun's
  double grain_steps = 0.0;
};

/// Those of the evaluations that are whole runs of this calibration's suite at parameter sets of
/// its space: what another target, or a model with one effect less, has already paid for.
std::vector<KnownRun> known_runs(const Calibration& calibration,
                                 std::span<const engine::Evaluation> evaluations);

/// The `most` of them whose misfit is smallest, in their order: emulators need no more, and what is
/// far from the targets teaches little about them.
std::vector<KnownRun> closest_runs(const Calibration& calibration,
                                   std::vector<KnownRun> known,
                                   std::size_t most);

class Ledger {
 public:
  struct Request {
    std::size_t site = 0;
    int replicate = 0;
    Level level = Level::search;
  };

  Ledger(const Calibration& calibration,
         const Evaluator& evaluator,
         std::span<const KnownRun> known = {},
         Meter meter = {});

  /// The site at a point: the one already there, or a new one.
  std::size_t site_at(const UnitPoint& point);

  /// The next seed that neither level has used at a site.
  [[nodiscard]] int fresh_replicate(std::size_t site) const;

  /// Evaluates all requests in one batch, and notes them in order. Drafts are no part of the
  /// history and are not counted.
  std::vector<SiteRun> run(std::string_view stage, std::span<const Request> requests);

  [[nodiscard]] const std::vector<Site>& sites() const { return sites_; }
  [[nodiscard]] int spent() const { return static_cast<int>(history_.size()); }
  /// Evaluations that the budget still pays for, each at the mean cost of those so far.
  [[nodiscard]] int remaining() const;
  [[nodiscard]] int failed() const { return failed_; }
  [[nodiscard]] std::string commonest_failure() const;  ///< empty if there was none
  [[nodiscard]] bool two_levels() const;
  [[nodiscard]] Scatter scatter(Level level) const;

  /// History; the members that the emulator knows are filled by the caller.
  [[nodiscard]] std::vector<HistoryPoint>& history() { return history_; }

  [[nodiscard]] const Calibration& calibration() const { return calibration_; }
  [[nodiscard]] const SearchSpace& space() const { return space_; }
  [[nodiscard]] const Suite& suite() const { return suite_; }

 private:
  std::vector<SiteRun>& runs(std::size_t site, Level level);
  [[nodiscard]] engine::Fidelity fidelity_of(Level level) const;
  SiteRun note(const Request& request,
               std::string_view stage,
               std::span<const engine::Evaluation> evaluations);

  const Calibration& calibration_;
  const Evaluator& evaluator_;
  Meter meter_;
  SearchSpace space_;
  Suite suite_;
  std::vector<Site> sites_;
  std::vector<HistoryPoint> history_;
  struct FailureCount {
    int times = 0;
    std::string message;  ///< the first one's
  };
  std::map<std::string, FailureCount> failures_;  ///< by experiment and kind
  int failed_ = 0;
};

/// Mean over the runs that observed measurement j, and how many did.
struct RunMean {
  double mean = 0.0;     ///< SI
  double squares = 0.0;  ///< sum of squared deviations from it, SI squared
  int count = 0;
};
RunMean mean_of(std::span<const SiteRun> runs,
                std::size_t measurement,
                std::vector<double> SiteRun::*values = &SiteRun::values);

/// Variance of one run at a site: its own replicates, shrunk to the pooled variance.
///
///   s_i^2 = (nu0 s_pool^2 + sum_r (y_r - mean)^2) / (nu0 + R - 1),   nu0 = 4
///
/// Source: conjugate update of a scaled inverse chi-squared prior (Gelman et al. 2013, BDA3, 2.6).
double run_variance(const RunMean& runs, double pooled);

}  // namespace repose::calibrator
