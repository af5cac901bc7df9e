/// Baselines: other ways to search, chosen by Budget::method. For comparison, and for whoever wants
/// one of them. Each asks for simulations through the same Ledger, so that they are stored, shared
/// and replayed like any other; none looks at an emulator. What each would recommend by now is said
/// after every step: the best run seen (NLopt's), the mean (CMA-ES, filter).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <stop_token>
#include <vector>

#include "calibrator/ledger.hpp"
#include "calibrator/search_space.hpp"

namespace repose::calibrator {

/// What a baseline searches with.
class BaselineSearch {
 public:
  /// Told after every step.
  using Listener = std::function<void(const BaselineSearch&)>;

  /// `reserve` evaluations of the budget are not the baseline's to spend.
  BaselineSearch(Ledger& ledger, int reserve, std::stop_token stop, Listener listener);

  /// Evaluations that may still be made; none once the search is cancelled.
  [[nodiscard]] int left() const;

  [[nodiscard]] std::size_t dimensions() const { return ledger_.space().dimensions(); }
  [[nodiscard]] std::uint64_t seed() const { return ledger_.calibration().seed; }

  /// Runs each point once, with a seed of its own, in one batch. The misfits; infinity where a
  /// fitted measurement was not observed. At most left() points.
  std::vector<double> evaluate(std::span<const UnitPoint> points);

  /// The step is over, and this is what would be recommended.
  void recommend(const UnitPoint& point);

  [[nodiscard]] const UnitPoint& best_seen() const { return best_seen_; }
  [[nodiscard]] double smallest() const {
    return smallest_;
  }  ///< misfit; infinity before the first
  [[nodiscard]] const UnitPoint& recommended() const { return recommended_; }

 private:
  Ledger& ledger_;
  int reserve_;
  std::stop_token stop_;
  Listener listener_;
  UnitPoint best_seen_;
  double smallest_;
  UnitPoint recommended_;
};

/// Searches until nothing is left to spend, or the method has converged: then true.
bool search_by_baseline(BaselineSearch& search, Method method);

bool search_by_nlopt(BaselineSearch& search, Method method);
bool search_by_cma_es(BaselineSearch& search);
bool search_by_filter(BaselineSearch& search);

}  // namespace repose::calibrator
