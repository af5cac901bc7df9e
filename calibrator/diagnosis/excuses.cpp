#include "calibrator/diagnosis/excuses.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "calibrator/diagnosis/screen.hpp"
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

/// Whether some of the fitted readings ask for the model's addition: by what it gains there beyond
/// chance (one-sided, 5 %), everything else free.
bool ask_for(const DiagnosisQuestion& question,
             const Models& models,
             const Model& model,
             Index addition,
             const std::vector<Index>& readings) {
  if (readings.empty()) return false;
  const Predictor own = models.predictor(model.emulator);
  const Predictor predictor{
      [&](const Vector& x) -> Vector { return own.mean(x)(readings); },
      [&](const Vector& x) -> Eigen::MatrixXd { return own.jacobian(x)(readings, Eigen::all); }};
  const Vector targets = models.targets()(readings);
  const Eigen::MatrixXd covariance =
      models.covariance(model.emulator, model.fit.at)(readings, readings);
  const auto fitted_in = [&](const ModelSpace& space) {
    return fit_model(predictor, targets, covariance, space, std::vector<Vector>{model.fit.at});
  };
  ModelSpace without = model.space;
  without.lower(addition) = without.upper(addition) = 0.0;
  without.precision(addition) = 0.0;
  const ModelFit with_it = fitted_in(model.space), base = fitted_in(without);
  const double gain = base.objective - with_it.objective;
  if (!(gain > 0.0)) return false;
  Vector bare = with_it.at;
  bare(addition) = 0.0;
  const std::vector<Departure> departure{
      {(predictor.mean(with_it.at) - predictor.mean(bare)) / with_it.at(addition),
       model.space.lower(addition) < 0.0}};
  const Vector freedom = question.error_freedom(models.fitted());
  const auto null =
      Screen(base, without, departure).draw_null(1, freedom(readings), question.calibration.seed);
  constexpr double significant = 0.05;
  return share_at_least(null, &Screen::Draw::named, gain) < significant;
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

std::string sole_witness(const DiagnosisQuestion& question,
                         const Models& models,
                         const Model& model) {
  std::map<std::string, std::vector<Index>> others;  // by apparatus, the readings of the rest
  const auto apparatus_of = [&](std::size_t row) -> const std::string& {
    const auto j = static_cast<std::size_t>(models.fitted()[row]);
    return question.calibration.measurements[j].experiment.name;
  };
  for (std::size_t i = 0; i < models.fitted().size(); ++i) others[apparatus_of(i)];
  for (std::size_t i = 0; i < models.fitted().size(); ++i) {
    for (auto& [apparatus, readings] : others) {
      if (apparatus != apparatus_of(i)) readings.push_back(static_cast<Index>(i));
    }
  }
  const auto first = model.fit.at.size() - static_cast<Index>(model.on.size());
  for (const auto& [apparatus, readings] : others) {
    for (Index addition = first; addition < model.fit.at.size(); ++addition) {
      if (!ask_for(question, models, model, addition, readings)) return apparatus;
    }
  }
  return {};
}

}  // namespace repose::calibrator
