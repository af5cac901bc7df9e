#include "calibrator/diagnosis/refits.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "calibrator/design.hpp"
#include "calibrator/misfit.hpp"

namespace repose::calibrator {
namespace {

using Eigen::Index;
using Vector = Eigen::VectorXd;

constexpr std::uint64_t refit_design = 2'000'000;  // apart by index
constexpr int least_rounds = 3;                    // for every model that stays near the front
constexpr int more_rounds = 2;                     // each for the foremost of those that still move
constexpr double far = 20.0;  // behind the best, in deviance: no later design has turned such a gap

}  // namespace

Points spread(const ModelSpace& space,
              const Additions& on,
              int count,
              std::uint64_t seed,
              std::uint64_t index,
              const std::optional<Neighbourhood>& about) {
  const auto all = static_cast<std::size_t>(space.lower.size());
  const std::size_t dimensions = all - on.size();
  Points points;
  for (const UnitPoint& u : latin_hypercube(static_cast<std::size_t>(count), all, seed, index)) {
    SuiteRuns::Point point;
    for (std::size_t k = 0; k < all; ++k) {
      const auto i = static_cast<Index>(k);
      const bool strength = k >= dimensions;
      // Strengths beyond 1, to either side, are allowed, but not looked for.
      const double lower = strength ? std::max(space.lower(i), -1.0) : space.lower(i);
      const double upper = strength ? 1.0 : space.upper(i);
      double x = lower + u[k] * (upper - lower);
      if (about) {
        const double radius = strength ? about->share * 5.0 / 3.0 : about->share;
        x = std::clamp(
            about->centre(i) + radius * (2.0 * u[k] - 1.0), space.lower(i), space.upper(i));
      }
      if (strength) {
        point.strengths[on[k - dimensions]] = x;
      } else {
        point.at.push_back(x);
      }
    }
    points.push_back(std::move(point));
  }
  return points;
}

/// Root mean square of z over the measurements with that role; NaN where there is none.
double rms_z(const DiagnosisQuestion& question, const std::vector<double>& predicted, Role role) {
  double sum = 0.0;
  int count = 0;
  for (std::size_t j = 0; j < predicted.size(); ++j) {
    const Measurement& measurement = question.calibration.measurements[j];
    if (measurement.role != role || !std::isfinite(predicted[j])) continue;
    const auto i = static_cast<Index>(j);
    const double gap = predicted[j] - measurement.value;
    sum += gap * gap / question.covariance(i, i);
    ++count;
  }
  return count == 0 ? std::numeric_limits<double>::quiet_NaN() : std::sqrt(sum / count);
}

std::vector<double> predictions_of(const DiagnosisQuestion& question, const Model& model) {
  const Vector mean = model.emulator.mean(model.fit.at);
  std::vector<double> result(mean.data(), mean.data() + mean.size());
  for (std::size_t j = 0; j < result.size(); ++j) {
    result[j] += question.offset(static_cast<Index>(j));
  }
  return result;
}

Refit summary_of(const DiagnosisQuestion& question,
                 const Models& models,
                 const SuiteRuns& runs,
                 const ModelFit& base,
                 const Model& model) {
  Refit refit;
  refit.effects = model.on;
  const std::size_t dimensions = runs.space().dimensions();
  refit.parameters =
      runs.space().at(UnitPoint(model.fit.at.data(), model.fit.at.data() + dimensions));
  for (std::size_t k = 0; k < model.on.size(); ++k) {
    const double strength = model.fit.at(static_cast<Index>(dimensions + k));
    refit.strengths.push_back(strength);
    question.suspects[model.on[k]].apply(refit.parameters, strength);
  }
  refit.predicted = predictions_of(question, model);
  refit.deviance = model.fit.deviance;
  refit.gain = base.deviance - model.fit.deviance;
  refit.misfit = model.fit.misfit;
  refit.freedom = model.fit.freedom;
  refit.p = models.misfit_p(model.fit, model.space);
  refit.at_bound = model.fit.inside.size() < static_cast<std::size_t>(model.fit.at.size());
  refit.fitted_z = rms_z(question, refit.predicted, Role::fit);
  refit.held_out_z = rms_z(question, refit.predicted, Role::held_out);
  if (model.on.size() == 1) {
    const Models::Range range = models.strength_range(model);
    refit.strength_lower = {range.lower};
    refit.strength_upper = {range.upper};
  }
  return refit;
}

Refits::Refits(const DiagnosisQuestion& question,
               const Models& models,
               Vector base,
               std::vector<double> expected,
               Ask ask)
    : question_(question),
      models_(models),
      base_(std::move(base)),
      expected_(std::move(expected)),
      ask_(std::move(ask)) {}

/// Near the calibrated set with the strength that the screen expects, where the effect is weak, and
/// half-way to the middle of the box where it is strong: the calibrated set is biased by the lack.
std::vector<Vector> Refits::starts_of(const Additions& on) const {
  const Index d = base_.size(), m = static_cast<Index>(on.size());
  const auto extended = [&](const Vector& head, double strength) {
    Vector x(d + m);
    x << head, Vector::Constant(m, strength);
    return x;
  };
  Vector expected = extended(base_, 0.1);
  for (Index k = 0; k < m; ++k) {
    expected(d + k) = std::min(expected_[on[static_cast<std::size_t>(k)]], 1.0);
  }
  std::vector<Vector> starts{
      expected, extended(base_, 0.1), extended(0.5 * base_ + Vector::Constant(d, 0.25), 0.6)};
  for (Index k = 0; k < m; ++k) {
    if (!question_.suspects[on[static_cast<std::size_t>(k)]].two_sided) continue;
    Vector other = starts.back();
    other(d + k) *= -1.0;
    starts.push_back(std::move(other));
  }
  return starts;
}

int Refits::size_of_design(const Candidate& candidate, int round) const {
  const int unknowns = static_cast<int>(base_.size()) + static_cast<int>(candidate.on.size());
  return std::clamp(3 * unknowns - (round == 0 ? 2 : 4), round == 0 ? 10 : 8, 20);
}

Points Refits::design_of(const Candidate& candidate, int round) {
  std::optional<Neighbourhood> about;
  if (candidate.model) about = {candidate.model->fit.at, round == 1 ? 0.18 : 0.12};
  return spread(models_.space(candidate.on),
                candidate.on,
                size_of_design(candidate, round),
                question_.calibration.seed,
                refit_design + designs_++,
                about);
}

/// The model from all runs so far; whether another design should follow.
bool Refits::learn(Candidate& candidate, int round) const {
  std::vector<Vector> starts;
  if (candidate.model) starts.push_back(candidate.model->fit.at);
  if (round < 2) std::ranges::copy(starts_of(candidate.on), std::back_inserter(starts));
  const Vector before = starts.front();
  candidate.model.emplace(models_.fit(candidate.on, starts));
  const Index d = base_.size();
  const Vector moved = (candidate.model->fit.at - before).cwiseAbs();
  const double way = std::max(d == 0 ? 0.0 : moved.head(d).maxCoeff() / 0.15,
                              moved.tail(moved.size() - d).maxCoeff() / 0.25);
  return round + 1 < least_rounds || way > 0.8;
}

/// Of the first designs everyone has one, whatever they cost.
std::vector<Refits::Candidate*> Refits::whose_turn(std::vector<Candidate>& all,
                                                   int round,
                                                   int runs) const {
  std::vector<Candidate*> turn;
  for (Candidate& candidate : all) {
    if (candidate.open) turn.push_back(&candidate);
  }
  if (round == 0) return turn;
  std::ranges::stable_sort(
      turn, {}, [](const Candidate* candidate) { return candidate->model->fit.deviance; });
  const std::size_t most = round < least_rounds ? turn.size() : 1;
  std::vector<Candidate*> affordable;
  for (Candidate* candidate : turn) {
    runs -= size_of_design(*candidate, round);
    if (runs >= 0 && affordable.size() < most) affordable.push_back(candidate);
  }
  return affordable;
}

std::optional<std::vector<Model>> Refits::fit(const std::vector<Additions>& candidates, int runs) {
  std::vector<Candidate> all;
  all.reserve(candidates.size());
  for (const Additions& on : candidates) all.push_back({on});
  for (int round = 0; round < least_rounds + more_rounds; ++round) {
    const std::vector<Candidate*> turn = whose_turn(all, round, runs);
    Points points;
    std::string names;
    for (const Candidate* turned : turn) {
      const Candidate& candidate = *turned;
      const Points design = design_of(candidate, round);
      points.insert(points.end(), design.begin(), design.end());
      names += names.empty() ? "" : ", ";
      for (std::size_t k = 0; k < candidate.on.size(); ++k) {
        names += (k == 0 ? "" : " + ") + question_.suspects[candidate.on[k]].name;
      }
    }
    if (points.empty()) break;
    runs -= static_cast<int>(points.size());
    if (!ask_("refit " + names, points)) return std::nullopt;
    for (Candidate* candidate : turn) candidate->open = learn(*candidate, round);
    double best = std::numeric_limits<double>::infinity();
    for (const Candidate& candidate : all) best = std::min(best, candidate.model->fit.deviance);
    for (Candidate& candidate : all) {
      if (candidate.model->fit.deviance > best + far) candidate.open = false;
    }
  }
  std::vector<Model> models;
  models.reserve(all.size());
  for (Candidate& candidate : all) {
    if (candidate.on.size() == 1) models_.deepen(*candidate.model);
    models.push_back(*std::move(candidate.model));
  }
  return models;
}

}  // namespace repose::calibrator
