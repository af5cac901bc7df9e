/// Diagnosis: whether a calibrated model lacks a physical effect, which one, and how sure that is.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calibrator/diagnosis/suspect.hpp"
#include "engine/experiment.hpp"
#include "engine/parameter_set.hpp"

namespace repose::calibrator {

enum class DiagnosisVerdict : std::uint8_t {
  adequate,       ///< nothing is missing that these data would show
  named,          ///< one effect is missing
  family,         ///< one of several that leave the same trace in these data
  pair,           ///< two effects are missing
  outside,        ///< something the catalogue lacks, located at one apparatus
  unexplained,    ///< something is missing that neither the catalogue nor one apparatus explains
  not_testable,   ///< whatever is missing would not show in these data
  not_predicted,  ///< only the measurements held out show that something is missing
};

inline constexpr std::array<std::string_view, 8> diagnosis_verdict_names{"adequate",
                                                                         "named",
                                                                         "family",
                                                                         "pair",
                                                                         "outside",
                                                                         "unexplained",
                                                                         "not_testable",
                                                                         "not_predicted"};

/// How well a name is founded.
enum class Grade : std::uint8_t {
  none,
  a,  ///< several apparatus agree, and no excuse of a single one does as well
  b,  ///< one apparatus alone asks for it, or an error of one would explain as much
  c,  ///< an error of one apparatus explains more
  d,  ///< nothing explains the data
};

inline constexpr std::array<std::string_view, 5> grade_names{"", "A", "B", "C", "D"};

enum class EffectStatus : std::uint8_t {
  supported,     ///< the data ask for it
  excluded,      ///< above the stated strength
  not_testable,  ///< even a strong one would leave no trace in these data
  not_probed,    ///< its runs failed, or the study lacks what it needs
  outdone,       ///< it would explain something, but another explanation does so better
};

inline constexpr std::array<std::string_view, 5> effect_status_names{
    "supported", "excluded", "not_testable", "not_probed", "outdone"};

/// A model with effects added, refitted with all of them free.
struct Refit {
  std::vector<std::size_t> effects;  ///< indices into Diagnosis::effects
  std::vector<double> strengths;
  std::vector<double> strength_lower, strength_upper;  ///< 95 %, by its profile
  engine::ParameterSet parameters;                     ///< complete
  std::vector<double> predicted;                       ///< SI, one per measurement
  double deviance = 0.0;                               ///< -2 log likelihood but for a constant
  double gain = 0.0;                                   ///< the base model's deviance less its own
  double misfit = 0.0;                                 ///< Q
  double freedom = 0.0;
  double p = 1.0;  ///< of the misfit where nothing more is missing
  bool at_bound = false;
  double fitted_z = 0.0, held_out_z = 0.0;  ///< root mean square; NaN where none is held out
};

/// What is known of one effect.
struct EffectFinding {
  Suspect suspect;
  EffectStatus status = EffectStatus::not_probed;
  double score = 0.0;               ///< what the deviance would fall by, one step
  double p = 1.0;                   ///< that any effect scores so high where nothing is missing
  double strength = 0.0;            ///< one step; a refit's is better
  double strength_upper = 0.0;      ///< larger ones are excluded, 95 %
  double detectable = 0.0;          ///< the strength found with a chance of 80 %
  double absorbed = 0.0;            ///< share of its trace that the free parameters imitate
  double probe_noise = 0.0;         ///< share of the scatter of the probing runs in its trace
  std::vector<double> change = {};  ///< SI, of each measurement per unit of strength
  std::vector<double> trace = {};   ///< in standard errors, what the free parameters cannot imitate
};

/// Something that is no effect of the catalogue: an apparatus is off, or off along a condition.
struct Excuse {
  std::string observable;  ///< "kettle.bulk_density"
  std::string setting;     ///< along which it changes; empty: an offset
  double score = 0.0;
  double p = 1.0;
  double size = 0.0;  ///< relative: of the observable, or at the ends of the setting's range
  double deviance = 0.0;
  double misfit = 0.0;
  double misfit_p = 1.0;
};

/// A measurement that would tell rival explanations apart.
struct DecidingMeasurement {
  engine::Experiment experiment;
  std::string observable;
  engine::Unit unit;
  double standard_error = 0.0;         ///< SI; expected, the tolerance of the code included
  std::vector<double> predicted = {};  ///< SI, by each of Diagnosis::rivals
  double evidence = 0.0;               ///< most between two rivals, in squared standard errors
  double gain = 0.0;                   ///< by which measurements are ranked
};

struct Diagnosis {
  DiagnosisVerdict verdict = DiagnosisVerdict::adequate;
  Grade grade = Grade::none;
  std::string sentence;     ///< the verdict for people
  double p_named = 1.0;     ///< of the largest score of an effect
  double p_unnamed = 1.0;   ///< of the largest score of an excuse
  double p_misfit = 1.0;    ///< of the calibrated model's misfit
  double p_held_out = 1.0;  ///< of its misfit to what is held out; 1 where nothing is
  double misfit = 0.0;      ///< its Q
  double freedom = 0.0;     ///< targets less fitted directions
  double fitted_z = 0.0, held_out_z = 0.0;  ///< root mean square before anything is added
  engine::ParameterSet parameters;          ///< where it was probed: the most probable set
  std::vector<double> predicted;            ///< SI, one per measurement, there
  std::vector<EffectFinding> effects;
  std::vector<Excuse> excuses;         ///< best first
  std::vector<Refit> refits;           ///< best first
  std::vector<std::size_t> plausible;  ///< indices into `refits` that the data cannot tell apart
  std::vector<std::vector<std::size_t>> families;  ///< effects with the same trace
  std::vector<std::vector<std::size_t>> rivals;  ///< explanations that are open, by their effects;
                                                 ///< none: the calibrated model
  std::vector<DecidingMeasurement> next;         ///< what would settle it, best first
  int evaluations = 0;                           ///< spent by the diagnosis
  std::vector<std::string> remarks;
};

/// "tilting_box.static_angle" -> relative spread between codes, 1.
using Tolerances = std::map<std::string, double>;

/// Told while the work goes on.
struct DiagnosisProgress {
  std::string stage;  ///< "offset", "anchor", "probe", "refit NAME, NAME", "next"
  int evaluations_done = 0;
};
using DiagnosisObserver = std::function<void(const DiagnosisProgress&)>;

}  // namespace repose::calibrator
