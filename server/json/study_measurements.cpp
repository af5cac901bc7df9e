#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "calibrator/diagnosis/tolerance.hpp"
#include "engine/catalogue.hpp"
#include "server/json/codec.hpp"
#include "server/json/study.hpp"

namespace repose::server {

using calibrator::Measurement;
using engine::ExperimentInfo;
using engine::ObservableInfo;

namespace {

std::vector<std::string_view> experiment_names() {
  std::vector<std::string_view> names;
  for (const ExperimentInfo& info : engine::experiment_catalogue()) names.push_back(info.name);
  return names;
}

const ExperimentInfo* read_experiment(const Place& place) {
  if (!place.exists()) return nullptr;
  const auto index = place.one_of(experiment_names(), "experiment");
  return index ? &engine::experiment_catalogue()[*index] : nullptr;
}

const ObservableInfo* read_observable(const Place& place, const ExperimentInfo& experiment) {
  if (!place.exists()) return nullptr;
  std::vector<std::string_view> names;
  for (const ObservableInfo& info : experiment.observables) names.push_back(info.name);
  const auto index = place.one_of(names, "observable of " + std::string(experiment.name));
  return index ? &experiment.observables[*index] : nullptr;
}

/// Where a measurement's numbers stand.
struct Numbers {
  Place value, unit, standard_error, standard_deviation, replicates, allowance;
};

Numbers numbers_of(Members& members) {
  return {members.required("value", "a number"),
          members.required("unit", "the unit of the value"),
          members.optional("standard_error"),
          members.optional("standard_deviation"),
          members.optional("replicates"),
          members.optional("allowance")};
}

/// A number above zero, in the measurement's unit.
std::optional<double> read_positive(const Place& place) {
  const auto value = place.number();
  if (value && *value > 0.0) return value;
  if (value) place.complain("an uncertainty is above zero", "more than 0");
  return std::nullopt;
}

/// The standard error in the measurement's unit, and how many repetitions it comes from. Never
/// guessed.
std::optional<double> read_standard_error(const Numbers& given,
                                          const std::string& observable,
                                          int& repetitions) {
  std::optional<std::int64_t> replicates;
  if (given.replicates.exists()) replicates = given.replicates.whole(1, 1'000'000);
  if (replicates && *replicates > 1) repetitions = static_cast<int>(*replicates);
  if (given.standard_error.exists() && given.standard_deviation.exists()) {
    given.standard_deviation.complain("one uncertainty is enough",
                                      "standard_error or standard_deviation, not both");
    return std::nullopt;
  }
  if (given.standard_error.exists()) return read_positive(given.standard_error);
  if (!given.standard_deviation.exists()) {
    given.standard_error.complain(
        "how well is " + observable +
            " known? Add \"standard_error\": the standard uncertainty of the value, in its unit",
        R"("standard_error", or "standard_deviation" with "replicates")");
    return std::nullopt;
  }
  const auto deviation = read_positive(given.standard_deviation);
  if (!given.replicates.exists()) {
    given.replicates.complain(
        "a standard deviation gives a standard error by the number of repeated measurements: add "
        "\"replicates\"",
        "a whole number from 2");
    return std::nullopt;
  }
  if (replicates && *replicates < 2) {
    given.replicates.complain("one measurement has no standard deviation", "2 or more");
    return std::nullopt;
  }
  if (!deviation || !replicates) return std::nullopt;
  return *deviation / std::sqrt(static_cast<double>(*replicates));
}

/// A measurement's members that stand for themselves. False where one has a problem.
bool read_rest(Members& members, Measurement& measurement, Study& study) {
  bool good = true;
  const Place role_place = members.optional("role");
  if (role_place.exists()) {
    const auto role = role_place.one_of(calibrator::role_names, "role");
    good = role.has_value();
    measurement.role = static_cast<calibrator::Role>(role.value_or(0));
  }
  if (measurement.role == calibrator::Role::fit) ++study.fitted_named;
  const Place source_place = members.optional("source");
  if (source_place.exists()) {
    auto source = source_place.text(2000);
    good = good && source.has_value();
    measurement.source = std::move(source).value_or("");
  }
  return good;
}

/// In the measurement's unit; "tolerance": as far as right codes differ on the observable.
std::optional<double> read_allowance(const Place& place,
                                     const ObservableInfo& observable,
                                     double size) {
  if (!place.exists()) return 0.0;
  if (place.json() == "tolerance") return observable.code_spread * size;
  if (place.json().is_string()) {
    place.complain("an allowance is in the value's unit, or what right codes differ by",
                   "a number from 0, or \"tolerance\"");
    return std::nullopt;
  }
  const auto allowance = place.number();
  if (!allowance || *allowance >= 0.0) return allowance;
  place.complain("an allowance is not negative", "0 or more");
  return std::nullopt;
}

/// The value, its uncertainty and its allowance, all in one unit.
bool read_numbers(const Numbers& given,
                  const ObservableInfo& observable,
                  Measurement& measurement) {
  const std::string name(observable.name);
  const auto value = given.value.exists() ? given.value.number() : std::nullopt;
  const auto unit =
      given.unit.exists() ? read_unit(given.unit, observable.unit, name) : std::nullopt;
  const auto error = read_standard_error(given, name, measurement.replicates);
  if (value && unit) {
    measurement.observable = name;
    measurement.unit = *unit;
    measurement.value = *value * unit->factor;
  }
  const double size = calibrator::size_of(measurement) / measurement.unit.factor;
  const auto allowance = read_allowance(given.allowance, observable, size);
  if (!value || !unit || !error || !allowance) return false;
  measurement.standard_error = *error * unit->factor;
  measurement.allowance = *allowance * unit->factor;
  const bool possible = std::isfinite(measurement.value) &&
                        std::isfinite(measurement.standard_error) &&
                        std::isfinite(measurement.allowance) && measurement.standard_error > 0.0;
  if (!possible) given.value.complain("no measurement has such a size", "a finite number");
  return possible;
}

}  // namespace

void read_measurement(const Place& place, Study& study) {
  Members members(place);
  if (!members.is_object()) {
    ++study.fitted_named;  // one mistake, one problem
    return;
  }
  const Place experiment_place = members.required("experiment", listed(experiment_names()));
  const Place observable_place = members.required("observable", "the name of what was observed");
  const Place settings_place = members.optional("settings");
  const Numbers numbers = numbers_of(members);
  Measurement measurement;
  bool good = read_rest(members, measurement, study);
  members.no_others();

  const ExperimentInfo* experiment = read_experiment(experiment_place);
  if (experiment == nullptr) return;  // its settings and numbers cannot be judged
  measurement.experiment.name = experiment->name;
  const ObservableInfo* observable = read_observable(observable_place, *experiment);
  good = observable != nullptr && read_numbers(numbers, *observable, measurement) && good;
  read_fields(settings_place,
              experiment->settings,
              experiment->name,
              {.value = [&](const engine::FieldInfo& field, double value, const Place&) {
                measurement.experiment.settings[std::string(field.name)] = value;
              }});
  if (!good) return;
  study.calibration.measurements.push_back(std::move(measurement));
  study.measured_at.push_back(place.pointer());
}

void read_measurements(const Place& place, Study& study) {
  for (const Place& element : place.elements()) {
    is_curve(element) ? read_curve(element, study) : read_measurement(element, study);
  }
}

}  // namespace repose::server
