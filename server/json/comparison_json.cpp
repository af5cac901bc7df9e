#include "server/json/comparison_json.hpp"

#include "server/json/codec.hpp"
#include "server/json/key_json.hpp"
#include "server/json/parameters_json.hpp"

namespace repose::server {

using calibrator::Calibration;
using calibrator::Comparison;
using calibrator::Measurement;

namespace {

Json print_row(const Calibration& calibration, const calibrator::ComparedMeasurement& row) {
  const Measurement& measurement = calibration.measurements.at(row.measurement);
  const engine::Unit& unit = measurement.unit;
  return {{"experiment", measurement.experiment.name},
          {"settings", print_settings(measurement.experiment)},
          {"observable", measurement.observable},
          {"role", calibrator::role_names[static_cast<std::size_t>(measurement.role)]},
          {"unit", unit.symbol},
          {"measured", in_unit(measurement.value, unit)},
          {"predicted", in_unit(row.predicted, unit)},
          {"difference", in_unit(row.difference, unit)},
          {"errors",
           {{"measurement", in_unit(row.measurement_error, unit)},
            {"tolerance", in_unit(row.tolerance, unit)},
            {"simulation", in_unit(row.simulation_error, unit)},
            {"emulator", in_unit(row.emulator_error, unit)}}},
          {"z", number_or_null(row.z)}};
}

}  // namespace

Json print_fit_quality(const Comparison& comparison) {
  return {{"misfit", number_or_null(comparison.misfit)},
          {"freedom", comparison.freedom},
          {"p", number_or_null(comparison.p)},
          {"fitted_z", number_or_null(comparison.fitted_z)},
          {"held_out_z", number_or_null(comparison.held_out_z)}};
}

std::string print_comparison(const Calibration& calibration,
                             const Comparison& comparison,
                             const std::optional<calibrator::Tolerated>& tolerated,
                             const std::optional<Comparison>& before) {
  Json document = print_fit_quality(comparison);
  document["text"] = comparison.sentences;
  document["tolerated"] = nullptr;
  if (tolerated) {
    document["text"].push_back(sentence_of(calibration, *tolerated));
    document["tolerated"] = {
        {"misfit", number_or_null(tolerated->misfit)},
        {"freedom", tolerated->freedom},
        {"p", number_or_null(tolerated->p)},
        {"parameters", print_parameter_set(calibration, tolerated->parameters)}};
  }
  Json& rows = document["measurements"] = Json::array();
  for (std::size_t i = 0; i < comparison.rows.size(); ++i) {
    rows.push_back(print_row(calibration, comparison.rows[i]));
    if (before && i < before->rows.size()) {
      rows.back()["z_before"] = number_or_null(before->rows[i].z);
    }
  }
  Json& trends = document["trends"] = Json::array();
  for (const calibrator::ResidualTrend& trend : comparison.trends) {
    trends.push_back({{"observable", trend.observable},
                      {"setting", trend.setting},
                      {"slope", number_or_null(trend.slope)},
                      {"z", number_or_null(trend.z)}});
  }
  document["before"] = before ? print_fit_quality(*before) : Json(nullptr);
  return to_text(document);
}

}  // namespace repose::server
