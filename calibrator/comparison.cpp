#include "calibrator/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <set>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "calibrator/diagnosis/chance.hpp"
#include "calibrator/diagnosis/covariance.hpp"
#include "calibrator/phrase.hpp"
#include "engine/catalogue.hpp"

namespace repose::calibrator {
namespace {

using Eigen::Index;

constexpr double remarkable = 2.0;  // standard errors

ComparedMeasurement row_of(const Measurement& measurement,
                           const Prediction& prediction,
                           const Tolerances& stated) {
  ComparedMeasurement row;
  row.measurement = prediction.measurement;
  row.predicted = prediction.predicted;
  row.difference = prediction.predicted - measurement.value;
  row.measurement_error = measurement.standard_error;
  row.tolerance = model_error_of(measurement, stated);
  row.simulation_error = prediction.standard_error;
  row.emulator_error = prediction.emulated_deviation;
  row.z = row.difference / std::hypot(row.measurement_error, row.tolerance, row.simulation_error);
  return row;
}

/// Of the differences: the tolerances that readings of one observable share, and the scatter of the
/// confirming runs.
Eigen::MatrixXd joint_covariance(const Calibration& calibration,
                                 const std::vector<ComparedMeasurement>& rows,
                                 const Tolerances& stated) {
  Eigen::MatrixXd covariance = covariance_of(calibration.measurements, stated);
  for (const ComparedMeasurement& row : rows) {
    const auto j = static_cast<Index>(row.measurement);
    covariance(j, j) += row.simulation_error * row.simulation_error;
  }
  return covariance;
}

/// Misfit of the fitted rows, and the chance of one so large.
void weigh_together(const Calibration& calibration,
                    const Eigen::MatrixXd& covariance,
                    Index learnt,
                    Comparison& comparison) {
  std::vector<Index> fitted;
  std::vector<double> gaps;
  for (const ComparedMeasurement& row : comparison.rows) {
    const Measurement& measurement = calibration.measurements[row.measurement];
    if (measurement.role != Role::fit || !std::isfinite(row.difference)) continue;
    fitted.push_back(static_cast<Index>(row.measurement));
    gaps.push_back(row.difference);
  }
  if (fitted.empty()) return;
  const auto gap = Eigen::Map<const Eigen::VectorXd>(gaps.data(), std::ssize(gaps));
  const Eigen::MatrixXd own = covariance(fitted, fitted);
  comparison.misfit = gap.dot(own.llt().solve(gap));
  const Eigen::VectorXd freedom = freedom_of(calibration.measurements, covariance.diagonal());
  const Index taken = comparison.freedom > 0.0 ? learnt : 0;
  comparison.p = misfit_p(comparison.misfit, taken, freedom(fitted), calibration.seed);
}

double rms(const Calibration& calibration,
           const std::vector<ComparedMeasurement>& rows,
           Role role) {
  double sum = 0.0;
  int count = 0;
  for (const ComparedMeasurement& row : rows) {
    if (calibration.measurements[row.measurement].role != role || !std::isfinite(row.z)) continue;
    sum += row.z * row.z;
    ++count;
  }
  return count == 0 ? std::numeric_limits<double>::quiet_NaN() : std::sqrt(sum / count);
}

const engine::FieldInfo* setting_info(const Measurement& measurement, const std::string& name) {
  const auto* info = engine::find_experiment(measurement.experiment.name);
  if (info == nullptr) return nullptr;
  const auto found = std::ranges::find(info->settings, name, &engine::FieldInfo::name);
  return found == info->settings.end() ? nullptr : &*found;
}

using Group = std::vector<const ComparedMeasurement*>;

/// Settings that differ within the group, choices left out.
std::vector<std::string> conditions_of(const Calibration& calibration, const Group& group) {
  const Measurement& what = calibration.measurements[group.front()->measurement];
  std::vector<std::string> names =
      differing_settings(calibration.measurements, observable_name(what));
  std::erase_if(names, [&](const std::string& name) {
    const auto* info = setting_info(what, name);
    return info != nullptr && !info->choices.empty();
  });
  return names;
}

/// Straight line through z over the condition (its logarithm where all are above zero), by
/// generalised least squares: what all readings of an observable share cancels in a slope.
std::optional<ResidualTrend> trend_of(const Calibration& calibration,
                                      const Eigen::MatrixXd& covariance,
                                      const Group& group,
                                      const std::string& setting) {
  std::vector<Index> places;
  std::vector<double> x, z;
  for (const ComparedMeasurement* row : group) {
    if (!std::isfinite(row->z)) continue;
    places.push_back(static_cast<Index>(row->measurement));
    x.push_back(setting_of(calibration.measurements[row->measurement], setting));
    z.push_back(row->z);
  }
  if (x.size() < 3) return std::nullopt;
  const auto [least, most] = std::ranges::minmax(x);
  if (least == most) return std::nullopt;
  Eigen::MatrixXd line(std::ssize(x), 2);
  for (Index i = 0; i < line.rows(); ++i) {
    const double value = x[static_cast<std::size_t>(i)];
    line.row(i) << 1.0, least > 0.0 ? std::log(value) : value;
  }
  const Eigen::VectorXd sizes = covariance.diagonal().cwiseSqrt();
  const Eigen::MatrixXd own = sizes(places).cwiseInverse().asDiagonal() *
                              covariance(places, places) *
                              sizes(places).cwiseInverse().asDiagonal();
  const Eigen::LLT<Eigen::MatrixXd> root(own);
  const Eigen::Matrix2d normal = line.transpose() * root.solve(line);
  const Eigen::Matrix2d inverse = normal.inverse();
  const auto values = Eigen::Map<const Eigen::VectorXd>(z.data(), std::ssize(z));
  const double slope = (inverse * (line.transpose() * root.solve(values)))(1);
  return ResidualTrend{"", setting, slope, slope / std::sqrt(inverse(1, 1))};
}

std::string spoken(std::string name) {
  std::ranges::replace(name, '_', ' ');
  return name;
}

/// "0.06 too high at 600 mm (held out)"
std::string miss_of(const Measurement& measurement,
                    double difference,
                    const std::vector<std::string>& conditions) {
  std::string text = quantity(std::abs(difference), measurement.unit, 2) +
                     (difference > 0.0 ? " too high" : " too low");
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    const auto* info = setting_info(measurement, conditions[i]);
    text += i == 0 ? " at " : ", ";
    if (conditions.size() > 1) text += spoken(conditions[i]) + " ";
    text += quantity(
        setting_of(measurement, conditions[i]), info != nullptr ? info->unit : engine::Unit{}, 4);
  }
  return held_out(measurement) ? text + " (held out)" : text;
}

/// "The model's restitution (drop) is 0.06 too high at 600 mm and 0.05 too low at 50 mm."
std::string sentence_of(const Calibration& calibration,
                        const Group& group,
                        const std::vector<std::string>& conditions) {
  std::vector<std::string> misses;
  for (const ComparedMeasurement* row : group) {
    if (!(std::abs(row->z) > remarkable)) continue;
    misses.push_back(
        miss_of(calibration.measurements[row->measurement], row->difference, conditions));
  }
  if (misses.empty()) return {};
  const Measurement& what = calibration.measurements[group.front()->measurement];
  std::string text =
      "The model's " + spoken(what.observable) + " (" + spoken(what.experiment.name) + ") is ";
  for (std::size_t i = 0; i < misses.size(); ++i) {
    if (i > 0) text += i + 1 == misses.size() ? " and " : ", ";
    text += misses[i];
  }
  return text + ".";
}

/// Whether the model fits, all measurements together.
std::string whole_sentence(const Comparison& comparison) {
  if (comparison.freedom <= 0.0 && comparison.p >= unlikely) {
    return "As many directions were learnt as measurements fitted: that the model fits says "
           "nothing.";
  }
  const std::string chance = " (p " + number(comparison.p, 2) + ")";
  if (comparison.p >= unlikely) {
    return comparison.sentences.empty()
               ? "The model fits: no measurement is off by more than two standard errors" + chance +
                     "."
               : "Together the fitted measurements are no further off than chance has it" + chance +
                     ".";
  }
  return comparison.sentences.empty() ? "No measurement alone is off by more than two standard "
                                        "errors, but together they are "
                                        "further off than chance has it" +
                                            chance + ": the model does not fit."
                                      : "The model does not fit" + chance + ".";
}

}  // namespace

double setting_of(const Measurement& measurement, const std::string& name) {
  const auto given = measurement.experiment.settings.find(name);
  if (given != measurement.experiment.settings.end()) return given->second;
  const auto* info = engine::find_experiment(measurement.experiment.name);
  if (info == nullptr) return std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> values = engine::resolved_settings(*info, measurement.experiment);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (info->settings[i].name == name) return values[i];
  }
  return std::numeric_limits<double>::quiet_NaN();
}

std::vector<std::string> differing_settings(std::span<const Measurement> measurements,
                                            const std::string& observable) {
  std::vector<const Measurement*> like;
  std::set<std::string> named;
  for (const Measurement& measurement : measurements) {
    if (observable_name(measurement) != observable) continue;
    like.push_back(&measurement);
    for (const auto& entry : measurement.experiment.settings) named.insert(entry.first);
  }
  std::vector<std::string> result;
  for (const std::string& name : named) {
    const double first = setting_of(*like.front(), name);
    const bool differs = std::ranges::any_of(
        like, [&](const Measurement* other) { return setting_of(*other, name) != first; });
    if (differs) result.push_back(name);
  }
  return result;
}

Comparison compare(const Calibration& calibration, const Fit& fit, const Tolerances& stated) {
  Comparison comparison;
  std::vector<std::string> names;
  std::map<std::string, std::vector<std::size_t>> groups;
  for (const Prediction& prediction : fit.predictions) {
    const Measurement& measurement = calibration.measurements[prediction.measurement];
    comparison.rows.push_back(row_of(measurement, prediction, stated));
    std::vector<std::size_t>& group = groups[observable_name(measurement)];
    if (group.empty()) names.push_back(observable_name(measurement));
    group.push_back(comparison.rows.size() - 1);
  }
  const auto learnt = std::ranges::count_if(fit.directions, &Direction::learnt);
  const auto fitted = std::ranges::count(calibration.measurements, Role::fit, &Measurement::role);
  const Eigen::MatrixXd covariance = joint_covariance(calibration, comparison.rows, stated);
  comparison.freedom = static_cast<double>(fitted - learnt);
  weigh_together(calibration, covariance, learnt, comparison);
  comparison.fitted_z = rms(calibration, comparison.rows, Role::fit);
  comparison.held_out_z = rms(calibration, comparison.rows, Role::held_out);
  for (const std::string& name : names) {
    Group group;
    for (const std::size_t row : groups[name]) group.push_back(&comparison.rows[row]);
    const std::vector<std::string> conditions = conditions_of(calibration, group);
    for (const std::string& condition : conditions) {
      if (auto trend = trend_of(calibration, covariance, group, condition)) {
        trend->observable = name;
        comparison.trends.push_back(*std::move(trend));
      }
    }
    std::string sentence = sentence_of(calibration, group, conditions);
    if (!sentence.empty()) comparison.sentences.push_back(std::move(sentence));
  }
  comparison.sentences.push_back(whole_sentence(comparison));
  return comparison;
}

}  // namespace repose::calibrator
