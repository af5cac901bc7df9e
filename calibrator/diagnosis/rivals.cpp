#include "calibrator/diagnosis/rivals.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "calibrator/diagnosis/verdict.hpp"
#include "engine/random.hpp"

namespace repose::calibrator {
namespace {

using Eigen::Index;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr std::uint64_t rival_stream = std::uint64_t{1} << 33U;  // apart from other draws

}  // namespace

OpenExplanations open_explanations(const Diagnosis& diagnosis) {
  OpenExplanations open;
  if (diagnosis.refits.empty()) {
    std::vector<std::pair<double, std::size_t>> unseen;  // the nearest to being testable first
    for (std::size_t k = 0; k < diagnosis.effects.size(); ++k) {
      const EffectFinding& finding = diagnosis.effects[k];
      if (finding.status != EffectStatus::not_testable) continue;
      unseen.emplace_back(finding.detectable, k);
    }
    std::ranges::sort(unseen);
    constexpr std::size_t most = 3;
    if (unseen.size() > most) unseen.resize(most);
    if (unseen.empty()) return open;
    open.calibrated = 0.5;
    for (const auto& [detectable, k] : unseen) {
      open.imitated.emplace_back(k, 0.5 / static_cast<double>(unseen.size()));
    }
    return open;
  }
  const double best = diagnosis.refits.front().deviance;
  for (const std::size_t index : diagnosis.plausible) {
    open.refits.emplace_back(index, std::exp(0.5 * (best - diagnosis.refits[index].deviance)));
  }
  if (open.refits.empty()) open.refits.emplace_back(0, 1.0);
  if (!diagnosis.excuses.empty()) {
    const double margin = diagnosis.excuses.front().deviance - best;
    if (margin <= close_deviances) open.calibrated = std::exp(-0.5 * std::max(margin, 0.0));
  }
  if (open.refits.size() == 1 && open.calibrated == 0.0) {
    if (diagnosis.refits.size() > 1) {
      open.refits.emplace_back(1, 1.0);
    } else {
      open.calibrated = 1.0;
    }
  }
  double sum = open.calibrated;
  for (const auto& [index, weight] : open.refits) sum += weight;
  open.calibrated /= sum;
  for (auto& [index, weight] : open.refits) weight /= sum;
  return open;
}

Rival rival_of(const DiagnosisQuestion& question,
               const SuiteRuns& runs,
               const Model& model,
               double weight,
               std::uint64_t stream) {
  constexpr int draws = 5;
  engine::Random random(
      question.calibration.seed, engine::Purpose::diagnosis, rival_stream + stream);
  Rival rival{{}, weight};
  const std::size_t dimensions = runs.space().dimensions();
  for (const Vector& x : draws_of(model, draws, random)) {
    const UnitPoint point(x.data(), x.data() + dimensions);
    engine::ParameterSet parameters = runs.space().at(point);
    for (std::size_t k = 0; k < model.on.size(); ++k) {
      const Suspect& suspect = question.suspects[model.on[k]];
      suspect.apply(parameters, suspect.snapped(x(static_cast<Index>(dimensions + k))));
    }
    rival.draws.push_back(std::move(parameters));
  }
  return rival;
}

Model imitated(const Models& models,
               const Model& base,
               std::size_t suspect,
               const std::vector<double>& change) {
  Model model = base;
  model.on = {suspect};
  model.space = models.space(model.on);
  const Index d = base.fit.at.size();
  const Vector all = Eigen::Map<const Vector>(change.data(), static_cast<Index>(change.size()));
  const Vector trace = base.fit.whitener * all(models.fitted());
  const Matrix& jacobian = base.fit.jacobian;
  Matrix curvature = jacobian.transpose() * jacobian;
  curvature.diagonal() += base.space.precision.cwiseAbs2();
  const Vector moved = base.fit.at - curvature.llt().solve(jacobian.transpose() * trace);
  model.fit.at = Vector(d + 1);
  model.fit.at << moved.cwiseMax(base.space.lower).cwiseMin(base.space.upper), 1.0;
  model.fit.jacobian = Matrix(jacobian.rows(), d + 1);
  model.fit.jacobian << jacobian, trace;
  // The strength is supposed, not learnt.
  model.space.precision(d) = 1e6;
  return model;
}

}  // namespace repose::calibrator
