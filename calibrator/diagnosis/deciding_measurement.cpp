#include "calibrator/diagnosis/deciding_measurement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "calibrator/diagnosis/tolerance.hpp"
#include "calibrator/misfit.hpp"
#include "engine/catalogue.hpp"
#include "engine/random.hpp"

namespace repose::calibrator {
namespace {

constexpr double enough = 12.0;       // evidence
constexpr double worth_while = 1.0;   // evidence below which nothing would be settled
constexpr double usual_error = 0.02;  // of a measurement's size, where the study has none like it
constexpr std::string_view single_grain = "drop";  // the experiment that needs no bed

/// Conditions under which a laboratory can repeat an experiment with little trouble. Factors are of
/// the setting's default.
struct Condition {
  std::string_view experiment, setting;
  std::array<double, 2> factors;
};

constexpr std::array conditions{
    Condition{"drop", "height", {0.1, 10.0}},
    Condition{"drum", "speed", {1.0 / 3.0, 3.0}},
    Condition{"compression", "stress", {0.25, 4.0}},
    Condition{"draw_down", "slot", {0.8, 1.25}},
    Condition{"heap", "cylinder_diameter", {0.75, 1.25}},
    Condition{"tilting_box", "depth", {0.6, 1.4}},
};

/// What the study's own readings of the observable reach, else what is usual; of the size.
double relative_error(const Calibration& calibration, const Measurement& candidate) {
  double sum = 0.0;
  int count = 0;
  for (const Measurement& own : calibration.measurements) {
    if (observable_name(own) != observable_name(candidate) || size_of(own) == 0.0) continue;
    sum += own.standard_error / size_of(own);
    ++count;
  }
  return count > 0 ? sum / count : usual_error;
}

/// Of the candidates, one row per draw.
using Values = std::vector<std::vector<double>>;

std::vector<Values> simulate(const Calibration& calibration,
                             std::span<const Candidate> candidates,
                             std::span<const Rival> rivals,
                             const Evaluator& evaluator) {
  std::vector<Measurement> measurements;
  for (const Candidate& candidate : candidates) measurements.push_back(candidate.measurement);
  const Suite suite(measurements);
  std::vector<engine::Trial> trials;
  std::uint64_t stream = std::uint64_t{1} << 32U;  // apart from the diagnosis's own
  for (const Rival& rival : rivals) {
    for (const engine::ParameterSet& draw : rival.draws) {
      const std::uint64_t seed =
          engine::Random(calibration.seed, engine::Purpose::diagnosis, stream++).bits() >> 11U;
      suite.append_trials(draw, calibration.budget.fidelity, seed, trials);
    }
  }
  const std::vector<engine::Evaluation> evaluations = evaluator(trials);
  std::vector<Values> values;
  std::span rest(evaluations);
  for (const Rival& rival : rivals) {
    values.emplace_back();
    for (std::size_t d = 0; d < rival.draws.size(); ++d) {
      values.back().push_back(suite.read(rest.first(suite.size())));
      rest = rest.subspan(suite.size());
    }
  }
  return values;
}

/// A rival's predictions of one candidate.
struct Forecast {
  double mean = 0.0;
  double variance = 0.0;
};

/// Nothing where fewer than two draws could be observed.
std::optional<Forecast> forecast_of(const Values& values, std::size_t candidate) {
  double sum = 0.0, squares = 0.0;
  int count = 0;
  for (const auto& draw : values) {
    if (!std::isfinite(draw[candidate])) continue;
    sum += draw[candidate];
    ++count;
  }
  if (count < 2) return std::nullopt;
  const double mean = sum / count;
  for (const auto& draw : values) {
    if (std::isfinite(draw[candidate])) squares += std::pow(draw[candidate] - mean, 2);
  }
  return Forecast{mean, squares / (count - 1) * (1.0 + 1.0 / count)};
}

DecidingMeasurement weigh(const Candidate& candidate,
                          const std::vector<Forecast>& forecasts,
                          std::span<const Rival> rivals) {
  DecidingMeasurement next{.experiment = candidate.measurement.experiment,
                           .observable = candidate.measurement.observable,
                           .unit = candidate.measurement.unit};
  Measurement expected = candidate.measurement;
  for (const Forecast& forecast : forecasts) {
    next.predicted.push_back(forecast.mean);
    expected.value += forecast.mean / static_cast<double>(forecasts.size());
  }
  next.standard_error =
      std::hypot(expected.standard_error, candidate.relative_error * size_of(expected));
  for (std::size_t i = 0; i < forecasts.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double gap = forecasts[i].mean - forecasts[j].mean;
      const double variance =
          next.standard_error * next.standard_error + forecasts[i].variance + forecasts[j].variance;
      const double evidence = gap * gap / variance;
      next.gain += rivals[i].weight * rivals[j].weight * std::min(evidence, enough);
      next.evidence = std::max(next.evidence, evidence);
    }
  }
  return next;
}

}  // namespace

std::vector<Candidate> candidates_of(const Calibration& calibration, const Tolerances& stated) {
  std::vector<Candidate> candidates;
  const bool beds = std::ranges::any_of(calibration.measurements, [](const Measurement& own) {
    return own.experiment.name != single_grain;
  });
  for (const engine::ExperimentInfo& info : engine::experiment_catalogue()) {
    if (!beds && info.name != single_grain) continue;
    std::vector<engine::Experiment> variants{
        {std::string(info.name), calibration.budget.fidelity, {}}};
    for (const Condition& condition : conditions) {
      if (condition.experiment != info.name) continue;
      const auto field =
          std::ranges::find(info.settings, condition.setting, &engine::FieldInfo::name);
      const auto index = static_cast<std::size_t>(field - info.settings.begin());
      const double usual = engine::resolved_settings(info, variants.front())[index];
      for (const double factor : condition.factors) {
        engine::Experiment variant = variants.front();
        variant.settings[std::string(condition.setting)] =
            std::clamp(factor * usual, field->lower, field->upper);
        variants.push_back(std::move(variant));
      }
    }
    for (const engine::Experiment& variant : variants) {
      for (const engine::ObservableInfo& observable : info.observables) {
        Measurement candidate;
        candidate.experiment = variant;
        candidate.observable = observable.name;
        candidate.unit = observable.unit;
        const bool known = std::ranges::any_of(
            calibration.measurements,
            [&](const Measurement& own) { return is_same_quantity(own, candidate); });
        if (known) continue;
        const double error =
            std::hypot(relative_error(calibration, candidate), tolerance_of(candidate, stated));
        candidates.push_back({std::move(candidate), error});
      }
    }
  }
  return candidates;
}

std::vector<DecidingMeasurement> weigh_candidates(const Calibration& calibration,
                                                  std::span<const Candidate> candidates,
                                                  std::span<const Rival> rivals,
                                                  const Evaluator& evaluator) {
  const std::vector<Values> values = simulate(calibration, candidates, rivals, evaluator);
  std::vector<DecidingMeasurement> result;
  for (std::size_t q = 0; q < candidates.size(); ++q) {
    std::vector<Forecast> forecasts;
    for (const Values& own : values) {
      if (const auto forecast = forecast_of(own, q)) forecasts.push_back(*forecast);
    }
    if (forecasts.size() < rivals.size()) continue;
    DecidingMeasurement next = weigh(candidates[q], forecasts, rivals);
    if (next.evidence >= worth_while) result.push_back(std::move(next));
  }
  std::ranges::stable_sort(result, std::greater<>(), &DecidingMeasurement::gain);
  return result;
}

}  // namespace repose::calibrator
