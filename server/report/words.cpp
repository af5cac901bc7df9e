#include "server/report/words.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "calibrator/phrase.hpp"
#include "server/report/label.hpp"
#include "server/report/number_text.hpp"

namespace repose::server {

using calibrator::Calibration;
using calibrator::counted;
using calibrator::Direction;
using calibrator::enumerate;
using calibrator::Fit;
using calibrator::FittedParameter;
using calibrator::joined;
using calibrator::Prediction;
using calibrator::Role;
using calibrator::StopReason;

namespace {

std::vector<const Prediction*> predictions_of(const Calibration& calibration,
                                              const Fit& fit,
                                              Role role) {
  std::vector<const Prediction*> chosen;
  for (const Prediction& prediction : fit.predictions) {
    if (calibration.measurements.at(prediction.measurement).role == role) {
      chosen.push_back(&prediction);
    }
  }
  return chosen;
}

std::ptrdiff_t within(const std::vector<const Prediction*>& predictions, double errors) {
  return std::ranges::count_if(
      predictions, [&](const Prediction* prediction) { return std::abs(prediction->z) <= errors; });
}

std::string all_met(std::size_t count, const std::string& within_what) {
  if (count == 1) return "The measurement is met within " + within_what + ".";
  if (count == 2) return "Both measurements are met within " + within_what + ".";
  return "All " + counted(count, "measurement") + " are met within " + within_what + ".";
}

std::string missed(const Calibration& calibration, const std::vector<const Prediction*>& fitted) {
  std::vector<std::string> names;
  for (const Prediction* prediction : fitted) {
    if (std::abs(prediction->z) <= 2.0) continue;
    const std::string z =
        std::isfinite(prediction->z) ? "z = " + fixed_text(prediction->z, 1) : "no prediction";
    names.push_back(measurement_label(calibration.measurements.at(prediction->measurement)) + " (" +
                    z + ")");
  }
  return std::to_string(names.size()) + " of " + counted(fitted.size(), "measurement") +
         (names.size() == 1 ? " is" : " are") +
         " missed by more than two standard errors: " + enumerate(names) + ".";
}

std::string interval_text(const Calibration& calibration, std::size_t index, const Fit& fit) {
  const FittedParameter& fitted = fit.parameters[index];
  const engine::Unit unit = calibration.free.at(index).unit;
  return number_text(fitted.lower / unit.factor, 3) + " to " +
         number_text(fitted.upper / unit.factor, 3) + unit_suffix(unit);
}

/// The parameters that make up a direction, apart by sign.
struct Parts {
  std::vector<std::string> same, opposite;  // the first one's sign, and the other

  [[nodiscard]] std::set<std::string> all() const {
    std::set<std::string> names(same.begin(), same.end());
    names.insert(opposite.begin(), opposite.end());
    return names;
  }
};

Parts parts_of(const Calibration& calibration, const Direction& direction) {
  constexpr double counts = 0.35;  // of a unit vector: smaller parts are not worth a word
  Parts parts;
  double sign = 0.0;
  for (std::size_t i = 0; i < direction.components.size(); ++i) {
    const double size = direction.components[i];
    if (std::abs(size) < counts) continue;
    if (sign == 0.0) sign = size;
    const std::string label = parameter_label(calibration.free.at(i).key);
    (size * sign > 0.0 ? parts.same : parts.opposite).push_back(label);
  }
  return parts;
}

/// What may be changed together without a measurement telling. Where two open directions are made
/// of the same parameters, each of these is open by itself and there is no trade to tell of.
std::vector<std::string> open_directions(const Calibration& calibration, const Fit& fit) {
  std::vector<Parts> open;
  for (const Direction& direction : fit.directions) {
    if (!direction.learnt) open.push_back(parts_of(calibration, direction));
  }
  std::vector<std::string> sentences;
  for (const Parts& parts : open) {
    const std::set<std::string> all = parts.all();
    const auto twins = std::ranges::count_if(open, [&](const Parts& p) { return p.all() == all; });
    if (all.size() < 2 || twins > 1) continue;
    const std::string how =
        parts.opposite.empty()
            ? "Raising " + enumerate(parts.same) + " together"
            : "More " + enumerate(parts.same) + " with less " + enumerate(parts.opposite);
    sentences.push_back(how + ", or the reverse, changes the measurements too little to be told.");
  }
  return sentences;
}

/// "a x b^0.5 / c^0.3": what is fixed near the best set, small powers left out.
std::string product_text(const Calibration& calibration, const Direction& direction) {
  constexpr double counts = 0.1;
  std::string over, under;
  for (std::size_t k = 0; k < direction.powers.size(); ++k) {
    const double power = std::abs(direction.powers[k]);
    if (power < counts) continue;
    std::string factor = parameter_label(calibration.free.at(k).key);
    if (power < 0.95) factor += "^" + number_text(power, 2);
    std::string& side = direction.powers[k] > 0.0 ? over : under;
    side += (side.empty() ? "" : " × ") + factor;
  }
  if (under.empty()) return over;
  return (over.empty() ? "1" : over) + " / " +
         (under.find(" × ") == std::string::npos ? under : "[" + under + "]");
}

/// The learnt directions as products of powers, best known first.
std::vector<std::string> learnt_products(const Calibration& calibration, const Fit& fit) {
  std::vector<std::string> sentences;
  for (const Direction& direction : fit.directions) {
    if (!direction.learnt || !(direction.product_error > 0.0)) continue;
    const double error = direction.product_error;
    const std::string how_well = error < 0.5 ? "to " + number_text(100.0 * error, 2) + " %"
                                             : "to a factor of " + number_text(std::exp(error), 2);
    sentences.push_back("Near the best set the data fix " + product_text(calibration, direction) +
                        " " + how_well + ".");
  }
  return sentences;
}

}  // namespace

Verdict verdict(const Calibration& calibration, const Fit& fit) {
  const auto fitted = predictions_of(calibration, fit, Role::fit);
  const auto all = static_cast<std::ptrdiff_t>(fitted.size());
  if (fitted.empty() || fit.stop == StopReason::failed) return Verdict::unfinished;
  if (within(fitted, 1.0) == all) return Verdict::hit;
  return within(fitted, 2.0) == all ? Verdict::met : Verdict::missed;
}

std::string headline(const Calibration& calibration, const Fit& fit) {
  const auto fitted = predictions_of(calibration, fit, Role::fit);
  switch (verdict(calibration, fit)) {
    case Verdict::hit:
      return all_met(fitted.size(), "one standard error");
    case Verdict::met:
      return all_met(fitted.size(), "two standard errors");
    case Verdict::missed:
      return missed(calibration, fitted);
    case Verdict::unfinished:
      break;
  }
  return "There is no confirmed prediction.";
}

std::string stop_sentence(StopReason stop) {
  switch (stop) {
    case StopReason::hit:
      return "The search stopped because fresh replicates are within one standard error of every "
             "measurement.";
    case StopReason::no_better:
      return "The search stopped because nothing better is within the emulator's reach.";
    case StopReason::implausible:
      return "The search stopped because no parameter set within the bounds comes within three "
             "standard errors of every measurement: a physical effect is missing, a bound is too "
             "narrow, or a standard error is too small.";
    case StopReason::budget:
      return "The search stopped because the budget is spent.";
    case StopReason::cancelled:
      return "The search was cancelled before it was finished.";
    case StopReason::failed:
      return "The search stopped because too few evaluations succeeded to learn from.";
    case StopReason::converged:
      return "The search stopped because its method had nothing more to try.";
  }
  return {};
}

std::vector<std::string> learnt_sentences(const Calibration& calibration, const Fit& fit) {
  std::vector<std::string> sentences, determined, open;
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    const std::string label = parameter_label(fit.parameters[i].key);
    if (fit.parameters[i].determined) determined.push_back(label);
    if (!fit.parameters[i].determined) {
      open.push_back(label + ", anything from " + interval_text(calibration, i, fit));
    }
  }
  if (!determined.empty())
    sentences.push_back("Determined by the data: " + enumerate(determined) + ".");
  if (!open.empty()) {
    sentences.push_back("Not determined by the data: " + joined(open, "; ") +
                        (open.size() == 1
                             ? ". No such value is ruled out: the best one is a choice."
                             : ". No such values are ruled out: the best ones are a choice."));
  }
  if (fit.directions.size() > 1) {
    const auto learnt = static_cast<std::size_t>(
        std::ranges::count_if(fit.directions, [](const Direction& d) { return d.learnt; }));
    sentences.push_back(counted(learnt, "combination") + " of the " +
                        counted(fit.directions.size(), "free parameter") +
                        (learnt == 1 ? " was" : " were") + " learnt.");
    std::ranges::move(learnt_products(calibration, fit), std::back_inserter(sentences));
    std::ranges::move(open_directions(calibration, fit), std::back_inserter(sentences));
  }
  const auto held_out = predictions_of(calibration, fit, Role::held_out);
  if (!held_out.empty()) {
    sentences.push_back("Set aside and predicted within two standard errors: " +
                        std::to_string(within(held_out, 2.0)) + " of " +
                        counted(held_out.size(), "measurement") + ".");
  }
  return sentences;
}

std::vector<std::string> next_sentences(const Calibration& calibration, const Fit& fit) {
  std::vector<std::string> sentences;
  for (const calibrator::NextMeasurement& next : fit.next) {
    calibrator::Measurement what;
    what.experiment = next.experiment;
    what.observable = next.observable;
    std::string name = measurement_label(what);
    const std::string settings = settings_label(next.experiment);
    if (!settings.empty()) name += " (" + settings + ")";
    const engine::Unit unit = observable_unit(calibration, next.experiment.name, next.observable);
    const auto percent = [](double learnt) { return fixed_text(100.0 * std::max(0.0, learnt), 0); };
    sentences.push_back(name + (next.again ? " once more, to ± " : ", to ± ") +
                        number_text(next.standard_error / unit.factor, 2) + unit_suffix(unit) +
                        ": most about " + parameter_label(calibration.free.at(next.parameter).key) +
                        ", learnt to " + percent(next.learnt) + " % instead of " +
                        percent(fit.parameters.at(next.parameter).learnt) + " %.");
  }
  if (sentences.empty() && !fit.posterior.samples.empty()) {
    sentences.push_back(
        "Nothing that the runs show beside the measurements, and none of these once more, would "
        "teach a hundredth more about the parameters.");
  }
  return sentences;
}

}  // namespace repose::server
