#include "server/report/diagnosis_words.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/catalogue.hpp"
#include "server/letters.hpp"
#include "server/report/number_text.hpp"

namespace repose::server {

using calibrator::Diagnosis;
using calibrator::EffectFinding;
using calibrator::EffectStatus;
using calibrator::Refit;

namespace {

std::string parameter_name(const engine::ParameterKey& key) {
  std::string name = key.field.substr(key.field.find('.') + 1);
  std::ranges::replace(name, '_', ' ');
  return name;
}

constexpr double in_sight = 10.0;  // times a strong one: so far a probed step may be thought on

std::string percent(double share) { return fixed_text(100.0 * share, 0) + " %"; }

std::string of_supported(const Diagnosis& diagnosis, std::size_t effect) {
  const Refit* refit = refit_of(diagnosis, effect);
  const EffectFinding& finding = diagnosis.effects[effect];
  if (refit == nullptr) {
    return "One step towards it lowers the misfit by " + fixed_text(finding.score, 1) +
           "; it was not among those refitted.";
  }
  std::string text = "With it the misfit falls from " + fixed_text(diagnosis.misfit, 1) + " to " +
                     fixed_text(refit->misfit, 1) + " on " + fixed_text(refit->freedom, 1) +
                     " degrees of freedom";
  const std::string strength =
      strength_text(finding, diagnosis.parameters, refit->strengths.front());
  return text + (strength.empty() ? "." : ", at " + strength + ".");
}

std::string of_untestable(const EffectFinding& finding) {
  if (leaves_no_trace(finding)) return "It changes none of these measurements.";
  constexpr double nearly_all = 0.9;
  if (finding.absorbed > nearly_all) {
    return "The free parameters imitate " + percent(finding.absorbed) +
           " of what it does to these measurements.";
  }
  const std::string too_little = "Even a strong one changes these measurements too little";
  if (!(finding.detectable < in_sight)) return too_little + ".";
  return too_little + ": it would be found from " + fixed_text(finding.detectable, 1) +
         " times the strong value on.";
}

}  // namespace

bool leaves_no_trace(const EffectFinding& finding) {
  return std::ranges::none_of(finding.change,
                              [](double change) { return std::isfinite(change) && change != 0.0; });
}

std::string detectable_text(const EffectFinding& finding) {
  return finding.detectable < in_sight ? fixed_text(finding.detectable, 2)
                                       : "> " + fixed_text(in_sight, 0);
}

std::string strength_text(const EffectFinding& finding,
                          const engine::ParameterSet& parameters,
                          double strength) {
  if (finding.suspect.levers.empty()) return {};
  const calibrator::Lever& lever = finding.suspect.levers.front();
  const engine::ParameterInfo* info = engine::find_parameter(lever.key.field);
  const engine::Unit unit = info != nullptr ? info->field->unit : engine::Unit{};
  return parameter_name(lever.key) + " " +
         number_text(lever.value(parameters, strength) / unit.factor, 2) + unit_suffix(unit);
}

std::string status_text(EffectStatus status) {
  std::string text(calibrator::effect_status_names[static_cast<std::size_t>(status)]);
  std::ranges::replace(text, '_', ' ');
  return text;
}

std::string reason(const Diagnosis& diagnosis, std::size_t effect) {
  const EffectFinding& finding = diagnosis.effects[effect];
  switch (finding.status) {
    case EffectStatus::supported:
      return of_supported(diagnosis, effect);
    case EffectStatus::not_testable:
      return of_untestable(finding);
    case EffectStatus::not_probed:
      return finding.suspect.objection.empty() ? "Its runs failed."
                                               : finding.suspect.objection + ".";
    case EffectStatus::excluded: {
      const std::string beyond =
          strength_text(finding, diagnosis.parameters, finding.strength_upper);
      return beyond.empty() ? "These data leave no room for it."
                            : "Beyond " + beyond + " it would have shown.";
    }
    default:
      return "It would explain something, but another explanation does so better.";
  }
}

const Refit* refit_of(const Diagnosis& diagnosis, std::size_t effect) {
  const auto found =
      std::ranges::find(diagnosis.refits, std::vector<std::size_t>{effect}, &Refit::effects);
  return found == diagnosis.refits.end() ? nullptr : &*found;
}

std::vector<std::size_t> ranked(const Diagnosis& diagnosis) {
  std::vector<std::size_t> order(diagnosis.effects.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto rank = [&](std::size_t effect) {
    switch (diagnosis.effects[effect].status) {
      case EffectStatus::supported:
        return 0;
      case EffectStatus::excluded:
        return 2;
      case EffectStatus::not_testable:
        return 3;
      case EffectStatus::not_probed:
        return 4;
      default:
        return 1;
    }
  };
  const auto evidence = [&](std::size_t effect) {
    const Refit* refit = refit_of(diagnosis, effect);
    return refit != nullptr ? refit->gain : diagnosis.effects[effect].score;
  };
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    if (rank(a) != rank(b)) return rank(a) < rank(b);
    return evidence(a) > evidence(b);
  });
  return order;
}

std::string chance_text(double p) {
  constexpr double least = 0.00025;  // one of 4000 draws
  return p < least ? "< 0.0003" : number_text(p, 2);
}

std::string names_text(const Diagnosis& diagnosis, const std::vector<std::size_t>& effects) {
  std::string text;
  for (const std::size_t effect : effects) {
    text += (text.empty() ? "" : " + ") + lower_first(diagnosis.effects[effect].suspect.title);
  }
  return text.empty() ? "nothing added" : text;
}

}  // namespace repose::server
