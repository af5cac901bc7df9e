#include "calibrator/diagnosis/verdict.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <unsupported/Eigen/SpecialFunctions>

#include "calibrator/phrase.hpp"

namespace repose::calibrator {
namespace {

constexpr double alpha_named = 0.03, alpha_unnamed = 0.015, alpha_misfit = 0.005;
constexpr double fits = 0.02;  // p of a misfit that nothing more needs to explain
constexpr double one_sided = 1.645;

std::string percent(double share) {
  char text[32];
  const int length = std::snprintf(text, sizeof text, "%+.1f %%", 100.0 * share);
  return {text, static_cast<std::size_t>(length)};
}

std::string titles(const Diagnosis& diagnosis,
                   const std::vector<std::size_t>& effects,
                   const char* last) {
  std::string text;
  for (std::size_t i = 0; i < effects.size(); ++i) {
    if (i > 0) text += i + 1 == effects.size() ? std::string(" ") + last + " " : ", ";
    std::string title = diagnosis.effects[effects[i]].suspect.title;
    if (i > 0 && !title.empty()) title[0] = static_cast<char>(std::tolower(title[0]));
    text += title;
  }
  return text;
}

std::string describe(const Excuse& excuse) {
  const std::string where = excuse.observable.substr(0, excuse.observable.find('.')) + " " +
                            excuse.observable.substr(excuse.observable.find('.') + 1);
  if (excuse.setting.empty()) return where + " is off by " + percent(excuse.size);
  return where + " has an unexplained trend with " + excuse.setting + " of " +
         percent(excuse.size) + " at its ends";
}

/// The winner and every other single effect that the data cannot tell from it.
std::vector<std::size_t> not_told_apart(const Diagnosis& diagnosis) {
  const Refit& best = diagnosis.refits.front();
  std::vector<std::size_t> names = best.effects;
  if (names.size() > 1) return names;
  const auto add = [&](std::size_t effect) {
    if (std::ranges::find(names, effect) == names.end()) names.push_back(effect);
  };
  for (const std::size_t index : diagnosis.plausible) {
    if (diagnosis.refits[index].effects.size() == 1) add(diagnosis.refits[index].effects.front());
  }
  for (const auto& family : diagnosis.families) {
    if (std::ranges::find(family, best.effects.front()) == family.end()) continue;
    for (const std::size_t effect : family) {
      // A refit that is far behind has told them apart.
      const auto own =
          std::ranges::find(diagnosis.refits, std::vector<std::size_t>{effect}, &Refit::effects);
      const bool apart =
          own != diagnosis.refits.end() && own->deviance - best.deviance >= close_deviances;
      if (!apart) add(effect);
    }
  }
  return names;
}

void conclude_adequate(Diagnosis& diagnosis) {
  const auto testable = std::ranges::count_if(diagnosis.effects, [](const EffectFinding& finding) {
    return finding.status == EffectStatus::excluded || finding.status == EffectStatus::supported;
  });
  std::string open;
  for (const EffectFinding& finding : diagnosis.effects) {
    if (finding.status == EffectStatus::excluded) continue;
    if (finding.status == EffectStatus::supported) continue;
    open += (open.empty() ? "" : ", ") + finding.suspect.name;
  }
  constexpr double least_freedom = 0.5;
  if (diagnosis.freedom < least_freedom) {
    diagnosis.verdict = DiagnosisVerdict::not_testable;
    diagnosis.sentence =
        "These data cannot tell whether anything is missing: the free parameters can follow them "
        "whatever they say. More kinds of measurement are needed than there are directions learnt.";
    return;
  }
  if (testable == 0) {
    diagnosis.verdict = DiagnosisVerdict::not_testable;
    diagnosis.sentence = "The model fits these data (p " + number(diagnosis.p_misfit, 2) +
                         "), but they cannot tell whether anything is missing: none of the effects "
                         "would show in them, however strong.";
    return;
  }
  if (diagnosis.p_held_out < alpha_misfit) {
    diagnosis.verdict = DiagnosisVerdict::not_predicted;
    diagnosis.sentence =
        "The fitted measurements show nothing missing, but what they predict of those held out is "
        "wrong (p " +
        number(diagnosis.p_held_out, 2) +
        "): something is missing that would show in them. Let them be fitted, and diagnose again.";
    return;
  }
  diagnosis.verdict = DiagnosisVerdict::adequate;
  diagnosis.sentence =
      "The model is adequate within the stated tolerance: nothing is missing that "
      "these data would show.";
  if (!open.empty()) diagnosis.sentence += " They cannot test: " + open + ".";
}

/// Effects that seemed to be asked for, until another explanation did better.
void retract(Diagnosis& diagnosis, const std::vector<std::size_t>& but) {
  for (std::size_t k = 0; k < diagnosis.effects.size(); ++k) {
    EffectStatus& status = diagnosis.effects[k].status;
    if (std::ranges::find(but, k) != but.end()) {
      status = EffectStatus::supported;
    } else if (status == EffectStatus::supported) {
      status = EffectStatus::outdone;
    }
  }
}

void conclude_outside(Diagnosis& diagnosis, const Excuse& excuse) {
  retract(diagnosis, {});
  diagnosis.verdict = DiagnosisVerdict::outside;
  diagnosis.grade = Grade::c;
  diagnosis.sentence =
      "Something outside the catalogue is missing, and it sits at one place: " + describe(excuse) +
      ". Check that apparatus, or measure the same elsewhere.";
}

void conclude_unexplained(Diagnosis& diagnosis) {
  diagnosis.verdict = DiagnosisVerdict::unexplained;
  diagnosis.grade = Grade::d;
  diagnosis.sentence =
      "Something is missing that neither the catalogue nor an error of one "
      "apparatus explains.";
  if (!diagnosis.refits.empty()) {
    diagnosis.sentence += " Of the effects, " +
                          titles(diagnosis, diagnosis.refits.front().effects, "and") +
                          " comes closest.";
  }
}

void conclude_named(Diagnosis& diagnosis,
                    const Excuse* excuse,
                    double margin,
                    const std::string& sole_witness) {
  const Refit& best = diagnosis.refits.front();
  const bool excused = margin <= close_deviances && excuse != nullptr;
  diagnosis.grade = excused || !sole_witness.empty() ? Grade::b : Grade::a;
  const std::vector<std::size_t> names = not_told_apart(diagnosis);
  retract(diagnosis, names);
  if (best.effects.size() > 1) {
    diagnosis.verdict = DiagnosisVerdict::pair;
    diagnosis.sentence = "Two effects are missing: " + titles(diagnosis, names, "and") + ".";
  } else if (names.size() > 1) {
    diagnosis.verdict = DiagnosisVerdict::family;
    diagnosis.grade = Grade::b;
    diagnosis.sentence = "One effect is missing, and these data cannot tell which of these: " +
                         titles(diagnosis, names, "or") + ".";
  } else {
    diagnosis.verdict = DiagnosisVerdict::named;
    diagnosis.sentence = titles(diagnosis, names, "") + " is missing.";
  }
  if (excused) {
    diagnosis.sentence +=
        " An error of one apparatus would explain the data as well: " + describe(*excuse) + ".";
  } else if (!sole_witness.empty()) {
    diagnosis.sentence += " The readings of one apparatus alone ask for it (" + sole_witness +
                          "): measure it with another.";
  }
}

}  // namespace

void refuse(Diagnosis& diagnosis) {
  diagnosis.verdict = DiagnosisVerdict::not_testable;
  diagnosis.sentence =
      "Nothing can be said of what is missing: too few runs of the calibrated model gave any of "
      "the fitted measurements.";
}

bool adequate(const Diagnosis& diagnosis) {
  return diagnosis.p_named >= alpha_named && diagnosis.p_unnamed >= alpha_unnamed &&
         diagnosis.p_misfit >= alpha_misfit;
}

bool wants_pairs(const Diagnosis& diagnosis) {
  if (diagnosis.refits.empty() || diagnosis.refits.front().p >= fits) return false;
  return diagnosis.excuses.empty() || diagnosis.excuses.front().misfit_p < fits;
}

void weigh(EffectFinding& finding, double power, std::size_t effects) {
  constexpr double least = 1e-9;
  const double deviation = 1.0 / std::sqrt(std::max(power, least));
  const double quantile = Eigen::numext::ndtri(
      1.0 - alpha_named / static_cast<double>(std::max<std::size_t>(effects, 1)));
  constexpr double eighty = 0.84;  // 80 % point of a normal
  finding.detectable = (quantile + eighty) * deviation;
  // Scatter in a trace makes a strength look smaller (errors in variables: Fuller 1987).
  constexpr double clearest = 0.05;
  const double strength =
      std::abs(finding.strength) / std::max(1.0 - finding.probe_noise, clearest);
  finding.strength_upper = strength + one_sided * deviation;
  if (finding.p < alpha_named) {
    finding.status = EffectStatus::supported;
  } else {
    finding.status = finding.detectable > 1.0 ? EffectStatus::not_testable : EffectStatus::excluded;
  }
}

void find_families(const Screen& screen,
                   const std::vector<std::size_t>& screened,
                   Diagnosis& diagnosis) {
  std::vector<bool> taken(screened.size(), false);
  for (std::size_t a = 0; a < screened.size(); ++a) {
    if (taken[a] || diagnosis.effects[screened[a]].status == EffectStatus::not_testable) continue;
    std::vector<std::size_t> family{screened[a]};
    for (std::size_t b = a + 1; b < screened.size(); ++b) {
      if (diagnosis.effects[screened[b]].status == EffectStatus::not_testable) continue;
      if (taken[b] || !screen.same_trace(a, b)) continue;
      family.push_back(screened[b]);
      taken[b] = true;
    }
    if (family.size() > 1) diagnosis.families.push_back(std::move(family));
  }
}

void conclude(const Calibration& calibration,
              const std::string& sole_witness,
              Diagnosis& diagnosis) {
  for (const EffectFinding& finding : diagnosis.effects) {
    if (finding.status == EffectStatus::supported && finding.probe_noise > 0.5) {
      diagnosis.remarks.push_back(finding.suspect.title +
                                  ": more than half of its trace is scatter of the probing runs.");
    }
  }
  if (calibration.free.empty()) {
    diagnosis.remarks.emplace_back(
        "No parameter is free: a wrong fixed value looks like a missing "
        "effect.");
  }
  if (adequate(diagnosis)) return conclude_adequate(diagnosis);
  const Excuse* excuse = diagnosis.excuses.empty() ? nullptr : &diagnosis.excuses.front();
  if (diagnosis.refits.empty()) {
    return excuse != nullptr && excuse->misfit_p >= fits ? conclude_outside(diagnosis, *excuse)
                                                         : conclude_unexplained(diagnosis);
  }
  const Refit& best = diagnosis.refits.front();
  for (std::size_t i = 0; i < diagnosis.refits.size(); ++i) {
    if (diagnosis.refits[i].deviance - best.deviance < close_deviances)
      diagnosis.plausible.push_back(i);
  }
  const double margin =
      excuse == nullptr ? 2.0 * close_deviances : excuse->deviance - best.deviance;
  const bool pair = best.effects.size() > 1;
  if (margin < -close_deviances && excuse->misfit_p > best.p)
    return conclude_outside(diagnosis, *excuse);
  if (best.p < fits || (pair && margin <= -2.0)) {
    return excuse != nullptr && excuse->misfit_p >= fits ? conclude_outside(diagnosis, *excuse)
                                                         : conclude_unexplained(diagnosis);
  }
  conclude_named(diagnosis, excuse, margin, sole_witness);
}

}  // namespace repose::calibrator
