#include "calibrator/diagnosis/screen.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "calibrator/diagnosis/chance.hpp"
#include "engine/random.hpp"

namespace repose::calibrator {
namespace {

using Eigen::Index;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

Vector residuals_of(const ModelFit& base, const ModelSpace& space) {
  const Vector pull = space.precision.cwiseProduct(space.centre - base.at);
  Vector result(base.residuals.size() + static_cast<Index>(base.inside.size()));
  result << base.residuals, pull(base.inside);
  return result;
}

/// The best strength within its limits, and what it gains.
Score score_of(double slope, double information, bool two_sided) {
  const double lower = two_sided ? -largest_strength : 0.0;
  Score score;
  score.information = std::max(information, 1e-9);
  score.strength = std::clamp(slope / score.information, lower, largest_strength);
  score.value = std::max(0.0, (2.0 * slope - score.strength * score.information) * score.strength);
  return score;
}

}  // namespace

double power_of(const Score& score) {
  const double beyond = std::max(0.0, score.information - score.noise);
  return beyond * beyond / score.information;
}

Screen::Screen(const ModelFit& base, const ModelSpace& space, std::vector<Departure> departures)
    : departures_(std::move(departures)), projector_(projector_off(base, space)) {
  const auto count = static_cast<Index>(departures_.size());
  const Index data = base.residuals.size();
  Matrix whitened = Matrix::Zero(count, projector_.rows());
  for (Index k = 0; k < count; ++k) {
    whitened.row(k).head(data) =
        (base.whitener * departures_[static_cast<std::size_t>(k)].change).transpose();
  }
  projected_ = whitened * projector_;
  slopes_ = projected_ * residuals_of(base, space);
  const Vector weights =
      (projector_.leftCols(data) * base.whitener).colwise().squaredNorm().transpose();
  products_ = projected_ * whitened.transpose();
  similarity_ = products_;
  for (Index k = 0; k < count; ++k) {
    Score score =
        score_of(slopes_(k), products_(k, k), departures_[static_cast<std::size_t>(k)].two_sided);
    const Vector& variance = departures_[static_cast<std::size_t>(k)].variance;
    if (variance.size() > 0) score.noise = weights.dot(variance);
    const double whole = whitened.row(k).squaredNorm();
    score.absorbed = whole > 0.0 ? std::clamp(1.0 - products_(k, k) / whole, 0.0, 1.0) : 1.0;
    scores_.push_back(score);
    const double size = std::sqrt(score.information);
    similarity_.row(k) /= size;
    similarity_.col(k) /= size;
  }
}

bool Screen::same_trace(std::size_t a, std::size_t b) const {
  const double similarity = similarity_(static_cast<Index>(a), static_cast<Index>(b));
  const bool mirrored = departures_[a].two_sided || departures_[b].two_sided;
  return (mirrored ? std::abs(similarity) : similarity) > alike;
}

double share_at_least(std::span<const Screen::Draw> null, double Screen::Draw::*what, double x) {
  const auto count =
      std::ranges::count_if(null, [&](const Screen::Draw& draw) { return draw.*what >= x; });
  return static_cast<double>(count) / static_cast<double>(null.size());
}

double Screen::pair_gain(std::size_t a, std::size_t b) const {
  const auto i = static_cast<Index>(a), j = static_cast<Index>(b);
  const double aa = products_(i, i), bb = products_(j, j), ab = products_(i, j);
  const double determinant = aa * bb - ab * ab;
  if (determinant < 1e-6 * aa * bb) return -1.0;
  double x = (bb * slopes_(i) - ab * slopes_(j)) / determinant;
  double y = (aa * slopes_(j) - ab * slopes_(i)) / determinant;
  if ((x < 0.0 && !departures_[a].two_sided) || (y < 0.0 && !departures_[b].two_sided)) return -1.0;
  x = std::clamp(x, -largest_strength, largest_strength);
  y = std::clamp(y, -largest_strength, largest_strength);
  return 2.0 * (x * slopes_(i) + y * slopes_(j)) - (x * x * aa + 2.0 * x * y * ab + y * y * bb);
}

std::vector<Screen::Draw> Screen::draw_null(std::size_t named,
                                            const Vector& freedom,
                                            std::uint64_t seed,
                                            int draws) const {
  const Index data = freedom.size();
  std::vector<Draw> result;
  result.reserve(static_cast<std::size_t>(draws));
  for (int d = 0; d < draws; ++d) {
    engine::Random random(seed, engine::Purpose::diagnosis_null, static_cast<std::uint64_t>(d));
    const Vector noise = draw_errors(random, freedom, projector_.rows());
    const Vector slopes = projected_ * noise;
    Draw draw;
    for (std::size_t k = 0; k < departures_.size(); ++k) {
      double& largest = k < named ? draw.named : draw.unnamed;
      const Score score =
          score_of(slopes(static_cast<Index>(k)), scores_[k].information, departures_[k].two_sided);
      largest = std::max(largest, score.value);
    }
    draw.misfit = (projector_ * noise).head(data).squaredNorm();
    result.push_back(draw);
  }
  return result;
}

}  // namespace repose::calibrator
