#include "calibrator/diagnosis/excuses.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "calibrator/diagnosis/tolerance.hpp"
#include "engine/catalogue.hpp"

namespace repose::calibrator {
namespace {

using Eigen::Index;
using Vector = Eigen::VectorXd;

/// Settings with which a measurement was made, by name; logarithms where they are above zero.
std::map<std::string, double> settings_of(const Measurement& measurement) {
  std::map<std::string, double> result = measurement.experiment.settings;
  if (const auto* info = engine::find_experiment(measurement.experiment.name)) {
    engine::Experiment standard = measurement.experiment;
    standard.fidelity = engine::Fidelity::standard;
    const std::vector<double> values = engine::resolved_settings(*info, standard);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!info->settings[i].choices.empty()) continue;  // a name has no more or less
      result[std::string(info->settings[i].name)] = values[i];
    }
  }
  for (auto& [name, value] : result) {
    if (value > 0.0) value = std::log(value);
  }
  return result;
}

/// The setting over the observable's measurements, about its mean, 1 at its farthest; empty where
/// they do not differ.
std::vector<double> trend_of(const std::vector<std::map<std::string, double>>& settings,
                             const std::string& name) {
  std::vector<double> values;
  for (const auto& all : settings) {
    const auto found = all.find(name);
    if (found == all.end()) return {};
    values.push_back(found->second);
  }
  double mean = 0.0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  double farthest = 0.0;
  for (double& value : values) {
    value -= mean;
    farthest = std::max(farthest, std::abs(value));
  }
  if (farthest < 1e-9) return {};
  for (double& value : values) value /= farthest;
  return values;
}

}  // namespace

std::vector<ExcuseDirection> excuse_directions(const DiagnosisQuestion& question,
                                               const std::vector<Index>& fitted) {
  std::vector<std::string> observables;  // in the order of the study
  std::map<std::string, std::vector<std::size_t>> rows;
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    const std::string name =
        observable_name(question.calibration.measurements[static_cast<std::size_t>(fitted[i])]);
    if (rows[name].empty()) observables.push_back(name);
    rows[name].push_back(i);
  }
  std::vector<ExcuseDirection> directions;
  for (const std::string& observable : observables) {
    const auto add = [&](const std::string& setting, const std::vector<double>& shape) {
      Vector change = Vector::Zero(static_cast<Index>(fitted.size()));
      for (std::size_t i = 0; i < shape.size(); ++i) {
        const std::size_t row = rows[observable][i];
        change(static_cast<Index>(row)) = shape[i] * question.sizes(fitted[row]);
      }
      directions.push_back({observable, setting, std::move(change)});
    };
    add("", std::vector<double>(rows[observable].size(), 1.0));
    std::vector<std::map<std::string, double>> settings;
    std::set<std::string> names;
    for (const std::size_t row : rows[observable]) {
      settings.push_back(
          settings_of(question.calibration.measurements[static_cast<std::size_t>(fitted[row])]));
      for (const auto& [name, value] : settings.back()) names.insert(name);
    }
    for (const std::string& name : names) {
      const std::vector<double> shape = trend_of(settings, name);
      if (!shape.empty()) add(name, shape);
    }
  }
  return directions;
}

ExcuseFit fit_excuse(const Models& models, const Model& base, const ExcuseDirection& direction) {
  const Index d = base.fit.at.size();
  const Predictor own = models.predictor(base.emulator);
  const Predictor predictor{
      [&](const Vector& x) -> Vector { return own.mean(x.head(d)) + x(d) * direction.change; },
      [&](const Vector& x) {
        Eigen::MatrixXd jacobian(direction.change.size(), d + 1);
        jacobian << own.jacobian(x.head(d)), direction.change;
        return jacobian;
      }};
  const auto extend = [d](const Vector& head, double tail) {
    Vector result(d + 1);
    result << head.head(d), tail;
    return result;
  };
  constexpr double prior_deviation = 0.3;  // of the size: an apparatus is not off by more than that
  const ModelSpace space{extend(base.space.lower, -1.0),
                         extend(base.space.upper, 1.0),
                         extend(base.space.centre, 0.0),
                         extend(base.space.precision, 1.0 / prior_deviation)};
  const std::vector<Vector> starts{
      extend(base.fit.at, 0.0), extend(base.fit.at, 0.05), extend(base.fit.at, -0.05)};
  const ModelFit fit = fit_model(
      predictor, models.targets(), models.covariance(base.emulator, base.fit.at), space, starts);
  return {fit.at(d), fit.deviance, fit.misfit, models.misfit_p(fit, space)};
}

}  // namespace repose::calibrator
