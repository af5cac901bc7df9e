#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <span>
#include <utility>

#include "calibrator/design.hpp"
#include "calibrator/misfit.hpp"
#include "engine/catalogue.hpp"
#include "engine/effects/sphere_clump.hpp"
#include "engine/evaluate.hpp"
#include "engine/shape_population.hpp"
#include "engine/size_population.hpp"
#include "engine/unit.hpp"
#include "server/json/codec.hpp"
#include "server/json/study.hpp"

namespace repose::server {

using calibrator::Tie;
using engine::Material;
using engine::MaterialId;
using engine::ParameterKey;

namespace {

/// Evaluations without which nothing can be learnt of that many parameters: a design of twice their
/// number, four replicates, and four to confirm.
std::size_t fewest_evaluations(std::size_t free) { return 2 * free + 8; }

/// Whether an experiment needs to know the property: walls move as they are told and have no size.
bool is_needed(MaterialId material, double Material::*property) {
  return material == MaterialId::grain ||
         (property != &Material::density && property != &Material::diameter);
}

void check_materials(const Place& document, const Study& study) {
  for (std::size_t i = 0; i < engine::material_names.size(); ++i) {
    const auto material = static_cast<MaterialId>(i);
    for (const auto& field : engine::material_fields) {
      if (!is_needed(material, field.member)) continue;
      const ParameterKey key = engine::make_key(
          std::string(Material::name) + "." + std::string(field.info.name), {material});
      if (study.claims.contains(key)) continue;
      const std::string name(engine::material_names[i]);
      const auto at = pointer_to(pointer_to("/materials", name), field.info.name);
      document.problems().add({at,
                               "the experiments need the " + std::string(field.info.name) +
                                   " of the " + name + ": give it under materials, or make " +
                                   engine::to_string(key) + " free or tied",
                               "nothing",
                               form_of_number(field.info.unit)});
    }
  }
}

const Tie* tie_of(const ParameterKey& key, const Study& study) {
  const auto found = std::ranges::find(study.calibration.tied, key, &Tie::key);
  return found == study.calibration.tied.end() ? nullptr : &*found;
}

/// Whether the ties that begin at a key come back to it.
bool goes_round(const ParameterKey& start, const Study& study) {
  std::set<ParameterKey> seen;
  ParameterKey key = start;
  while (seen.insert(key).second) {
    const Tie* tie = tie_of(key, study);
    if (tie == nullptr) return false;
    key = tie->to;
  }
  return key == start;
}

/// The values that a free or fixed parameter may take, SI.
std::pair<double, double> range_of(const ParameterKey& key, const Study& study) {
  const auto& free = study.calibration.free;
  const auto found = std::ranges::find(free, key, &calibrator::FreeParameter::key);
  if (found != free.end()) return {found->lower, found->upper};
  const double value = study.calibration.fixed.get_or(key, engine::absent);
  return {value, value};
}

void check_reach(const Study::PlacedTie& placed, const Study& study) {
  const engine::ParameterInfo* info = engine::find_parameter(placed.tie.key.field);
  const auto [from, to] = range_of(placed.tie.to, study);
  if (std::isnan(from)) return;  // has a problem of its own
  const Place factor(
      nullptr, pointer_to(placed.place.pointer(), "factor"), placed.place.problems());
  const double low = std::min(placed.tie.factor * from, placed.tie.factor * to);
  const double high = std::max(placed.tie.factor * from, placed.tie.factor * to);
  const std::string what = engine::to_string(placed.tie.key) + " (factor " +
                           engine::short_number(placed.tie.factor) + " x " +
                           engine::to_string(placed.tie.to) + ")";
  const engine::FieldInfo& field = *info->field;
  if (within_bounds(factor, high, field.unit, field, what)) {
    within_bounds(factor, low, field.unit, field, what);
  }
}

void check_tie(const Study::PlacedTie& placed, const Study& study) {
  const std::string to = engine::to_string(placed.tie.to);
  const Place at(nullptr, pointer_to(placed.place.pointer(), "to"), placed.place.problems());
  const std::string allowed = "a parameter that is free or fixed";
  if (goes_round(placed.tie.key, study)) {
    at.complain("the ties go round in a circle: none of them has a value", to, allowed);
    return;
  }
  const auto claim = study.claims.find(placed.tie.to);
  if (claim == study.claims.end()) {
    at.complain(to + " is neither free nor fixed, so nothing can follow it", to, allowed);
    return;
  }
  if (claim->second.part == Part::tied) {
    const Tie* next = tie_of(placed.tie.to, study);
    const std::string advice =
        next == nullptr ? "" : ": tie to " + engine::to_string(next->to) + " instead";
    at.complain(to + " is tied itself" + advice, to, allowed);
    return;
  }
  check_reach(placed, study);
}

/// Two measurements of one thing that no single truth explains.
void check_contradictions(const Place& document, const Study& study) {
  constexpr double most = 5.0;  // combined standard errors
  const auto& all = study.calibration.measurements;
  for (std::size_t j = 0; j < all.size(); ++j) {
    const calibrator::Suite other(std::span(&all[j], 1));
    for (std::size_t i = 0; i < j; ++i) {
      if (all[i].observable != all[j].observable || !other.place_of(all[i].experiment)) continue;
      const double apart = std::abs(all[i].value - all[j].value) /
                           std::hypot(standard_uncertainty(all[i]), standard_uncertainty(all[j]));
      if (apart <= most) continue;
      document.problems().add(
          {pointer_to(study.measured_at[j], "value"),
           "this contradicts " + study.measured_at[i] + ": the same " + all[j].observable + ", " +
               engine::short_number(apart) + " standard errors apart",
           engine::short_number(all[j].value / all[j].unit.factor),
           "within 5 standard errors of " +
               engine::short_number(all[i].value / all[j].unit.factor) +
               ", a larger standard_error, or settings that tell the two apart"});
    }
  }
}

/// Whether any parameter set within the bounds keeps every constraint. Only of a study without
/// another problem.
void check_constraints(const Place& document, const Study& study) {
  if (study.calibration.constraints.empty() || !document.problems().empty()) return;
  const auto method = study.calibration.budget.method;
  if (method != calibrator::Method::repose) {
    document.problems().add(
        {"/budget/method",
         "the baselines know no constraints",
         std::string(calibrator::method_names.at(static_cast<std::size_t>(method))),
         "repose, or no constraints"});
    return;
  }
  const calibrator::SearchSpace space(study.calibration);
  if (!calibrator::allowed_points(space, 1, study.calibration.seed).empty()) return;
  document.problems().add({"/constraints",
                           "no parameter set within the bounds was found that keeps the "
                           "constraints",
                           "0 of 100000 tried",
                           "wider bounds, or constraints that leave more"});
}

/// The shape of the grains, where nothing of it is searched for.
void check_grains(const Place& document, const Study& study) {
  const std::string effect = std::string(engine::effects::SphereClump::text.name) + ".";
  std::string pointer = "/fixed";
  for (const auto& [key, claim] : study.claims) {
    if (!key.field.starts_with(effect)) continue;
    if (claim.part == Part::free || claim.part == Part::tied) return;
    pointer = claim.pointer;
  }
  if (const std::string problem = engine::check_shape(study.calibration.fixed); !problem.empty()) {
    document.problems().add({pointer,
                             problem,
                             "a shape that is no grain",
                             "spheres that touch one another, none wholly inside another"});
  }
}

/// What is wrong with every parameter set that is looked at: the middle of the bounds, and each
/// parameter at its ends. Told of the middle; empty where one of them is fine.
std::string wrong_everywhere(
    const calibrator::SearchSpace& space,
    const std::function<std::string(const engine::ParameterSet&)>& problem_of) {
  const calibrator::UnitPoint middle(space.dimensions(), 0.5);
  const std::string problem = problem_of(space.at(middle));
  for (std::size_t k = 0; k < middle.size() && !problem.empty(); ++k) {
    for (const double end : {0.0, 1.0}) {
      calibrator::UnitPoint point = middle;
      point[k] = end;
      if (problem_of(space.at(point)).empty()) return {};
    }
  }
  return problem;
}

/// Effects that contradict each other about the grains. True if any do.
bool contradict(const Place& document, const Study& study, const calibrator::SearchSpace& space) {
  const std::string problem = wrong_everywhere(space, [](const engine::ParameterSet& parameters) {
    const std::string sizes = engine::check_sizes(parameters);
    return sizes.empty() ? engine::check_shape(parameters) : sizes;
  });
  if (problem.empty()) return false;
  std::string pointer = "/fixed";
  for (const auto& [key, claim] : study.claims) {
    if (problem.find(key.field.substr(0, key.field.find('.'))) != std::string::npos) {
      pointer = claim.pointer;
    }
  }
  document.problems().add({pointer, problem, "several effects", "one of them"});
  return true;
}

/// Experiments that no parameter set would let begin. Only of a study without another problem.
void check_apparatus(const Place& document, const Study& study) {
  if (!document.problems().empty()) return;
  const calibrator::SearchSpace space(study.calibration);
  if (contradict(document, study, space)) return;
  const auto& all = study.calibration.measurements;
  for (std::size_t j = 0; j < all.size(); ++j) {
    engine::Experiment experiment = all[j].experiment;
    if (calibrator::Suite(std::span(all).first(j)).place_of(experiment)) continue;
    experiment.fidelity = study.calibration.budget.fidelity;
    const std::string problem =
        wrong_everywhere(space, [&](const engine::ParameterSet& parameters) {
          return engine::refusal({parameters, experiment, study.calibration.seed});
        });
    if (problem.empty()) continue;
    const bool as_it_comes = experiment.settings.empty();
    document.problems().add(
        {as_it_comes ? study.measured_at[j] : pointer_to(study.measured_at[j], "settings"),
         experiment.name + ": " + problem,
         as_it_comes ? "the apparatus as it comes" : "these settings",
         "an apparatus that works with the study's grains"});
  }
}

}  // namespace

void check_study(const Place& document, const Study& study) {
  check_materials(document, study);
  check_grains(document, study);
  for (const Study::PlacedTie& tie : study.ties) check_tie(tie, study);
  check_contradictions(document, study);
  if (study.free_named == 0) {
    document.problems().add(
        {"/free",
         "nothing is free, so there is nothing to calibrate",
         "no free parameter",
         "at least one {\"field\", \"between\", \"lower\", \"upper\", \"unit\"}"});
  }
  if (study.fitted_named == 0) {
    document.problems().add({"/measurements",
                             "no measurement is fitted, so there is nothing to calibrate to",
                             "no measurement whose role is fit",
                             "at least one measurement whose role is fit"});
  }
  const std::size_t fewest = fewest_evaluations(study.free_named);
  const int spent = study.calibration.budget.evaluations;
  if (study.free_named > 0 && static_cast<std::size_t>(spent) < fewest) {
    document.problems().add({"/budget/evaluations",
                             std::to_string(study.free_named) +
                                 (study.free_named == 1 ? " free parameter needs at least "
                                                        : " free parameters need at least ") +
                                 std::to_string(fewest) +
                                 " evaluations (twice their number and eight)",
                             std::to_string(spent),
                             std::to_string(fewest) + " or more"});
  }
  check_constraints(document, study);
  check_apparatus(document, study);
}

}  // namespace repose::server
