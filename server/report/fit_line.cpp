#include "server/report/fit_line.hpp"

#include <cmath>

#include "server/report/number_text.hpp"

namespace repose::server {

using calibrator::Measurement;
using calibrator::Prediction;

namespace {

double root_mean_square(std::span<const double> values) {
  double sum = 0.0;
  for (const double x : values) sum += x * x;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

std::string ends_text(double first, double last, const Measurement& measurement) {
  const double factor = measurement.unit.factor;
  const int decimals = decimals_for(first / factor, measurement.standard_error / factor);
  return fixed_text(first / factor, decimals) + " to " + fixed_text(last / factor, decimals) +
         unit_suffix(measurement.unit);
}

}  // namespace

double FitLine::z() const {
  if (!is_curve()) return predicted.front().z;
  std::vector<double> all;
  for (const Prediction& prediction : predicted) all.push_back(prediction.z);
  return root_mean_square(all);
}

double FitLine::difference() const {
  std::vector<double> all;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    all.push_back(predicted[i].predicted - measured[i].value);
  }
  return is_curve() ? root_mean_square(all) : all.front();
}

std::vector<FitLine> lines_of(const calibrator::Calibration& calibration,
                              const calibrator::Fit& fit) {
  std::vector<FitLine> lines;
  std::size_t first = 0;
  const std::span<const Prediction> predictions(fit.predictions);
  for (const auto& measured : calibrator::lines_of(calibration.measurements)) {
    if (first + measured.size() > predictions.size()) break;
    lines.push_back({measured, predictions.subspan(first, measured.size())});
    first += measured.size();
  }
  return lines;
}

std::string measured_text(const FitLine& line) {
  const Measurement& first = line.measured.front();
  if (!line.is_curve()) return with_error(first.value, first.standard_error, first.unit);
  return ends_text(first.value, line.measured.back().value, first);
}

std::string predicted_text(const FitLine& line) {
  const Measurement& measurement = line.measured.front();
  const Prediction& first = line.predicted.front();
  if (!line.is_curve()) return with_error(first.predicted, first.standard_error, measurement.unit);
  return ends_text(first.predicted, line.predicted.back().predicted, measurement);
}

std::string difference_text(const FitLine& line) {
  const Measurement& measurement = line.measured.front();
  const double difference = line.difference() / measurement.unit.factor;
  if (std::isnan(difference)) return "-";
  const std::string text = fixed_text(
      difference, decimals_for(difference, measurement.standard_error / measurement.unit.factor));
  if (line.is_curve()) return text + " rms";
  const bool plus = difference > 0.0 && text.find_first_of("123456789") != std::string::npos;
  return plus ? "+" + text : text;
}

std::string z_text(const FitLine& line) {
  const double z = line.z();
  if (!std::isfinite(z)) return "-";
  if (line.is_curve()) return fixed_text(z, 2) + " rms";
  return (z > 0.0 ? "+" : "") + fixed_text(z, 2);
}

}  // namespace repose::server
