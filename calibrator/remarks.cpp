#include "calibrator/remarks.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "calibrator/draft_help.hpp"
#include "calibrator/phrase.hpp"
#include "calibrator/plan.hpp"

namespace repose::calibrator {
namespace {

constexpr int figures = 3;

std::string quantity(double value, const Measurement& measurement) {
  return calibrator::quantity(value, measurement.unit, figures);
}

using Sentences = std::vector<std::string>;

void on_identification(const Calibration& calibration, const Fit& fit, Sentences& out) {
  if (fit.directions.empty()) return;
  const auto learnt = static_cast<std::size_t>(
      std::ranges::count_if(fit.directions, [](const Direction& d) { return d.learnt; }));
  std::vector<std::string> open;
  for (const FittedParameter& parameter : fit.parameters) {
    if (parameter.lower_at_bound && parameter.upper_at_bound) {
      open.push_back(parameter_name(parameter.key));
    }
  }
  std::string text = "The data determine " + std::to_string(learnt) + " of " +
                     counted(fit.directions.size(), "direction");
  if (!open.empty()) {
    text += "; " + enumerate(open) + (open.size() == 1 ? " is" : " are") +
            " not determined: with the others re-adjusted, the runs rule out no value within the "
            "bounds";
  }
  out.push_back(text + ".");

  const auto fitted = static_cast<std::size_t>(
      std::ranges::count(calibration.measurements, Role::fit, &Measurement::role));
  if (fitted <= learnt) {
    out.push_back("With " + counted(fitted, "fitted measurement") + " for " +
                  counted(calibration.free.size(), "free parameter") +
                  " the model cannot be tested: add observables.");
  }
}

/// A measurement that stands there twice, number for number, pulls as two.
void on_repeats(const Calibration& calibration, Sentences& out) {
  const auto& all = calibration.measurements;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (all[i].role != Role::fit || all[j].role != Role::fit || all[i].value != all[j].value ||
          all[i].standard_error != all[j].standard_error || !is_same_quantity(all[i], all[j])) {
        continue;
      }
      out.push_back("Measurements " + std::to_string(j + 1) + " and " + std::to_string(i + 1) +
                    " are the same, " + measurement_name(all[i]) + " of " +
                    quantity(all[i].value, all[i]) +
                    ", and count twice: leave one out, unless it was measured twice.");
      break;  // of three alike, the third is told of once
    }
  }
}

void on_bounds(const Calibration& calibration,
               const Outlook& outlook,
               const Fit& fit,
               Sentences& out) {
  for (std::size_t k = 0; k < fit.parameters.size(); ++k) {
    const FittedParameter& parameter = fit.parameters[k];
    const double u = outlook.ledger.space().coordinate(k, parameter.value);
    const bool at_lower = u < 0.01 && !parameter.upper_at_bound;
    const bool at_upper = u > 0.99 && !parameter.lower_at_bound;
    if (!at_lower && !at_upper) continue;
    out.push_back("The best value of " + parameter_name(calibration.free[k].key) + " lies at its " +
                  (at_lower ? "lower" : "upper") + " bound: widen it if physics allows.");
  }
}

void on_noise(const Calibration& calibration, const Fit& fit, Sentences& out) {
  for (const Prediction& prediction : fit.predictions) {
    const Measurement& measurement = calibration.measurements[prediction.measurement];
    if (prediction.scatter <= measurement.standard_error) continue;
    const double ratio = prediction.scatter / (0.5 * standard_uncertainty(measurement));
    out.push_back("One run of " + measurement_name(measurement) + " scatters by " +
                  quantity(prediction.scatter, measurement) +
                  ", more than the measurement's standard error of " +
                  quantity(measurement.standard_error, measurement) +
                  ": enlarge the virtual experiment or average " +
                  number(std::ceil(ratio * ratio), figures) + " runs.");
  }
}

/// The misfit against its promised distribution (mean and variance of a sum of squared normals).
void on_optimism(const Outlook& outlook, const Fit& fit, Sentences& out) {
  double promised = 0.0;
  double mean = 0.0;
  double variance = 0.0;
  for (const Target& target : outlook.targets) {
    const Prediction& p = fit.predictions[target.measurement];
    if (p.replicates == 0) return;
    const Measurement& m = outlook.ledger.calibration().measurements[target.measurement];
    const double error = std::hypot(standard_uncertainty(m), p.standard_error);
    const double a = (p.emulated - m.value) / error;
    const double b = std::hypot(p.emulated_deviation, p.standard_error) / error;
    promised += a * a;
    mean += a * a + b * b;
    variance += 2.0 * b * b * b * b + 4.0 * a * a * b * b;
  }
  if (fit.misfit > mean + 2.0 * std::sqrt(variance)) {
    out.push_back("Fresh replicates give a misfit of " + number(fit.misfit, figures) +
                  " where the emulator promised " + number(promised, figures) +
                  ": the replicates are to be believed.");
  }
}

void on_emulator(const Outlook& outlook, Sentences& out) {
  const auto& measurements = outlook.ledger.calibration().measurements;
  for (std::size_t j = 0; j < measurements.size(); ++j) {
    const auto& process = outlook.surrogate.process(j);
    if (!process || process->leave_one_out() <= 2.0) continue;
    out.push_back("The emulator of " + measurement_name(measurements[j]) +
                  " predicts a run it has not seen " +
                  number(std::sqrt(process->leave_one_out()), figures) +
                  " times worse than it should: its intervals were widened by that factor.");
  }
}

void on_fidelity(const Calibration& calibration, const Fit& fit, Sentences& out) {
  std::vector<std::string> coarse;
  for (std::size_t j = 0; j < fit.offset_error.size(); ++j) {
    const Measurement& measurement = calibration.measurements[j];
    if (fit.offset_error[j] <= measurement.standard_error) continue;
    coarse.push_back(measurement_name(measurement) + " (" +
                     quantity(fit.offset_error[j], measurement) + ")");
  }
  if (coarse.empty()) return;
  out.push_back("What the confirming fidelity adds is known less well than was measured, of " +
                enumerate(coarse) + ": search at the confirming fidelity.");
}

void on_time(const Calibration& calibration, const Fit& fit, Sentences& out) {
  const bool limited = calibration.budget.core_seconds || calibration.budget.wall_seconds;
  if (!limited || fit.stop != StopReason::budget ||
      fit.evaluations >= calibration.budget.evaluations) {
    return;
  }
  out.emplace_back(
      "The limit of time ended the search. Run again from the start, on another day or another "
      "machine, it may end elsewhere; a replay from the store ends here.");
}

/// A best set that nobody looked for is the best of the start.
void on_search(const Calibration& calibration, const Fit& fit, Sentences& out) {
  if (calibration.free.empty() || calibration.budget.method != Method::repose ||
      fit.stop != StopReason::budget ||
      std::ranges::count(fit.history, "search", &HistoryPoint::stage) > 0) {
    return;
  }
  const int more = std::max(searching_budget(calibration) - calibration.budget.evaluations,
                            std::max(calibration.budget.batch, 1));
  out.push_back(
      "No search took place: the start, its replicates and the confirmation took the whole "
      "budget. " +
      counted(static_cast<std::size_t>(more), "more evaluation") +
      " would pay for a first batch of it.");
}

void on_verdict(const Calibration& calibration, const Fit& fit, Sentences& out) {
  if (fit.stop == StopReason::implausible) {
    out.emplace_back(
        "No parameter set within the bounds comes within three standard errors of the "
        "measurements: physics is missing, or a bound or a standard error is wrong.");
  }
  if (fit.stop == StopReason::cancelled) {
    out.emplace_back("The search was cancelled before fresh replicates confirmed its best set.");
  }
  for (const Prediction& prediction : fit.predictions) {
    const Measurement& measurement = calibration.measurements[prediction.measurement];
    if (!held_out(measurement) || prediction.replicates == 0) continue;
    if (std::abs(prediction.z) <= 2.0) continue;
    out.push_back("The held-out " + measurement_name(measurement) +
                  " is not predicted: " + quantity(prediction.predicted, measurement) +
                  " against " + quantity(measurement.value, measurement) + " measured, " +
                  number(std::abs(prediction.z), figures) + " standard errors apart.");
  }
}

}  // namespace

std::string parameter_name(const engine::ParameterKey& key) {
  std::string text = engine::to_string(key);
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) return text;
  return text.substr(colon + 1) + " " + text.substr(0, colon);
}

std::string measurement_name(const Measurement& measurement) {
  return measurement.experiment.name + " " + measurement.observable;
}

std::vector<std::string> remarks(const Outlook& outlook, const Fit& fit) {
  const Calibration& calibration = outlook.ledger.calibration();
  Sentences out;
  const Method method = calibration.budget.method;
  if (method != Method::repose) {
    out.push_back(
        "Searched by the baseline " + std::string(method_names[static_cast<std::size_t>(method)]) +
        "; intervals and directions are the emulator's, learnt afterwards from its runs.");
  }
  on_verdict(calibration, fit, out);
  on_search(calibration, fit, out);
  on_identification(calibration, fit, out);
  on_repeats(calibration, out);
  on_bounds(calibration, outlook, fit, out);
  on_optimism(outlook, fit, out);
  on_noise(calibration, fit, out);
  on_fidelity(calibration, fit, out);
  on_emulator(outlook, out);
  for (std::string& sentence : draft_remarks(outlook.ledger)) out.push_back(std::move(sentence));
  on_time(calibration, fit, out);
  if (fit.failed > 0) {
    out.push_back(std::to_string(fit.failed) + " of " +
                  counted(static_cast<std::size_t>(fit.evaluations), "evaluation") +
                  " failed, most often with " + outlook.ledger.commonest_failure() + ".");
  }
  return out;
}

std::string too_few_succeeded(const Ledger& ledger, int succeeded, int needed) {
  std::string text = "Only " + std::to_string(succeeded) + " of " +
                     counted(static_cast<std::size_t>(ledger.spent()), "evaluation") +
                     " succeeded, and " + std::to_string(needed) + " are needed to learn from";
  const std::string failure = ledger.commonest_failure();
  if (!failure.empty()) text += "; the commonest failure: " + failure;
  return text + ".";
}

std::string budget_too_small(const Calibration& calibration, int needed) {
  return "The budget of " +
         counted(static_cast<std::size_t>(std::max(calibration.budget.evaluations, 0)),
                 "evaluation") +
         " is too small: " + counted(calibration.free.size(), "free parameter") +
         " need at least " + std::to_string(needed) + ".";
}

}  // namespace repose::calibrator
