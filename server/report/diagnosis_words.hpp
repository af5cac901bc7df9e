/// Diagnosis in words: the same wherever a diagnosis is shown to people.
#pragma once

#include <string>
#include <vector>

#include "calibrator/diagnosis/diagnosis.hpp"

namespace repose::server {

/// From which strength on it would be found, in strong ones; "> 10" where that tells nothing more.
std::string detectable_text(const calibrator::EffectFinding& finding);

/// The strength in the effect's own terms: "relaxation 0.12 ms"; empty where it has none.
std::string strength_text(const calibrator::EffectFinding& finding,
                          const engine::ParameterSet& parameters,
                          double strength);

/// "supported", "not testable": of one word or two.
std::string status_text(calibrator::EffectStatus status);

/// Whether it changes none of the measurements by a bit.
bool leaves_no_trace(const calibrator::EffectFinding& finding);

/// Why the effect has its status, in a sentence.
std::string reason(const calibrator::Diagnosis& diagnosis, std::size_t effect);

/// The refit with that effect alone; nothing where it was not refitted.
const calibrator::Refit* refit_of(const calibrator::Diagnosis& diagnosis, std::size_t effect);

/// Effects in the order in which people ask for them: what the data want first, what they cannot
/// tell last.
std::vector<std::size_t> ranked(const calibrator::Diagnosis& diagnosis);

/// "< 0.0003", "0.02": a probability drawn 4000 times is never 0.
std::string chance_text(double p);

/// "air drag + hysteresis"; "nothing" where there is none.
std::string names_text(const calibrator::Diagnosis& diagnosis,
                       const std::vector<std::size_t>& effects);

}  // namespace repose::server
