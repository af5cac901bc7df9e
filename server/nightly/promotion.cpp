#include "server/nightly/promotion.hpp"

#include <algorithm>
#include <cmath>

#include "engine/unit.hpp"
#include "server/json/place.hpp"

namespace repose::server {

namespace {

constexpr double width_slack = 0.05;
constexpr double narrowest = 1e-6;  // share of the bounds; a width is not compared below it

}  // namespace

Residual error_of(const std::vector<Residual>& residuals) {
  if (residuals.empty()) return {};
  const auto count = static_cast<double>(residuals.size());
  double squares = 0.0;
  for (const Residual& residual : residuals) squares += residual.z * residual.z;
  const double error = std::sqrt(squares / count);
  // d error / d z_j = z_j / (count error); where all are zero, any of them moves it by itself.
  double variance = 0.0;
  for (const Residual& residual : residuals) {
    const double slope = error > 0.0 ? residual.z / (count * error) : 1.0 / std::sqrt(count);
    variance += std::pow(slope * residual.standard_error, 2);
  }
  return {error, std::sqrt(variance)};
}

double width_ratio(const Contender& candidate, const Contender& incumbent) {
  const std::size_t count = std::min(candidate.widths.size(), incumbent.widths.size());
  double logarithms = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    logarithms += std::log(std::max(candidate.widths[k], narrowest) /
                           std::max(incumbent.widths[k], narrowest));
  }
  return count == 0 ? 1.0 : std::exp(logarithms / static_cast<double>(count));
}

Promotion judge(const Contender& candidate, const Contender& incumbent) {
  if (!candidate.fits) return {false, "the new fit misses its measurements by more than chance"};
  const Residual own = error_of(candidate.held_out);
  const Residual other = error_of(incumbent.held_out);
  const std::string errors = engine::short_number(own.z) + " against " +
                             engine::short_number(other.z) + " standard errors";
  if (!(own.z <= other.z + std::hypot(own.standard_error, other.standard_error))) {
    return {false, "its error is worse: " + errors};
  }
  const double ratio = width_ratio(candidate, incumbent);
  const std::string widths = engine::short_number(ratio) + " times as wide";
  if (!(ratio <= 1.0 + width_slack)) return {false, "its intervals are wider: " + widths};
  return {true, "its error is not worse (" + errors + ") and its intervals are " + widths};
}

}  // namespace repose::server
