/// Promotion: whether a new fit takes the place of the one that users get.
///
/// The rule: it fits, its held-out error is not worse than the incumbent's, and its intervals are
/// not wider. "Not worse" is judged on the same measurements, both from fresh replicates, up to the
/// standard error that these replicates leave; without held-out measurements the fitted ones take
/// their place. "Not wider" is the geometric mean over the free parameters of the ratio of the
/// intervals' widths, up to 5 %.
#pragma once

#include <string>
#include <vector>

namespace repose::server {

/// One measurement as a fit predicts it.
struct Residual {
  double z = 0.0;               ///< (predicted - measured) / standard uncertainty
  double standard_error = 0.0;  ///< of z, by the replicates' scatter
};

struct Contender {
  bool fits = true;                ///< its misfit is no more than chance
  std::vector<Residual> held_out;  ///< the fitted ones where none is held out
  std::vector<double> widths;      ///< of the 95 % intervals, shares of the search bounds
};

struct Promotion {
  bool promoted = false;
  std::string reason;  ///< a sentence
};

Promotion judge(const Contender& candidate, const Contender& incumbent);

/// Root mean square of z, and the standard error of that.
Residual error_of(const std::vector<Residual>& residuals);

/// Geometric mean of the ratio of widths, candidate over incumbent; 1 where there are none.
double width_ratio(const Contender& candidate, const Contender& incumbent);

}  // namespace repose::server
