/// Study plan: which trials a published study asks for. Pure: what it names it looks up in the
/// catalogue, so a slip in the study's data is an error, not another simulation.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "calibrator/calibration.hpp"
#include "engine/experiment.hpp"
#include "server/studies/published_study.hpp"

namespace repose::server {

/// How much of a study is run.
enum class StudySize {
  full,   ///< as the paper did: fidelity `paper`, its replicates
  quick,  ///< fidelity `draft`, few replicates
};

engine::Fidelity fidelity_of(StudySize size);
int replicates_of(const StudyExperiment& experiment, StudySize size);

/// The parameters of a run, from its code. Throws std::invalid_argument where the data are wrong,
/// as all below.
engine::ParameterSet run_parameters(const PublishedStudy& study, std::string_view run);

/// The level that a run gives a factor, as printed: "0.55 / 0.37", "41.7 MPa".
std::string level_text(const PublishedStudy& study,
                       const StudyFactor& factor,
                       std::string_view run);

/// What of a run differs from the base, "restitution 0.3"; "base" where nothing does.
std::string difference_text(const PublishedStudy& study, std::string_view run);

/// Replicates of an experiment with those parameters, seeds from `first_seed` on.
std::vector<engine::Trial> replicate_trials(const engine::ParameterSet& parameters,
                                            const engine::Experiment& experiment,
                                            int replicates,
                                            std::uint64_t first_seed = 1);

/// About how long a run with those parameters takes beside others of its experiment: with the
/// number of spheres, and with the number of steps, which goes as the smallest grain's Rayleigh
/// time. For the order of runs alone.
double expected_cost(const engine::ParameterSet& parameters);

/// The base with a variant's parameters; its experiment with the variant's settings.
engine::ParameterSet variant_parameters(const PublishedStudy& study, const StudyVariant& variant);
engine::Experiment variant_experiment(const StudyVariant& variant,
                                      std::string_view experiment,
                                      StudySize size);

/// The search for the best set, of that size.
calibrator::Calibration study_search(const PublishedStudy& study, StudySize size);

}  // namespace repose::server
