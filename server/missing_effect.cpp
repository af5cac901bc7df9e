#include "server/missing_effect.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "calibrator/comparison.hpp"
#include "calibrator/diagnosis/objection.hpp"
#include "calibrator/diagnosis/tolerance.hpp"
#include "engine/catalogue.hpp"
#include "engine/evaluate.hpp"
#include "server/jobs/clock.hpp"
#include "server/json/calibration_json.hpp"
#include "server/json/comparison_json.hpp"
#include "server/json/diagnosis_json.hpp"
#include "server/json/evaluation_json.hpp"
#include "server/json/fit_json.hpp"
#include "server/json/labels.hpp"
#include "server/json/missing_effect_json.hpp"
#include "server/json/missing_effect_request.hpp"
#include "server/json/place.hpp"

namespace repose::server {

using calibrator::Calibration;
using calibrator::Fit;
using engine::Unexpected;

namespace {

struct Finished {
  Calibration calibration;
  Fit fit;
};

Refusal refusal(Refusal::Kind kind, std::string message) { return {kind, std::move(message), {}}; }

/// A calibration that has a fit to be judged.
Answer<Finished> finished(const db::Store& store, std::int64_t id) {
  const auto record = store.calibration(id);
  const std::string name = "calibration " + std::to_string(id);
  if (!record) return Unexpected{not_found("calibration", id)};
  if (record->state != "done" || !record->fit) {
    return Unexpected{refusal(Refusal::Kind::wrong_state,
                              name + " is " + record->state + ": it has no fit to be judged")};
  }
  auto calibration = parse_calibration(record->request);
  if (!calibration) {
    return Unexpected{refusal(Refusal::Kind::wrong_state,
                              "the study of " + name + " cannot be read any more: " +
                                  calibration.error().front().message)};
  }
  auto fit = parse_fit(*calibration, *record->fit);
  if (!fit) return Unexpected{refusal(Refusal::Kind::wrong_state, fit.error())};
  return Finished{*std::move(calibration), *std::move(fit)};
}

std::vector<engine::Evaluation> evaluations_of(const std::vector<db::UsedEvaluation>& used) {
  std::vector<engine::Evaluation> evaluations;
  for (const db::UsedEvaluation& entry : used) {
    const auto trial = parse_trial(entry.evaluation.question);
    if (trial) evaluations.push_back(parse_answer(*trial, entry.evaluation.answer));
  }
  return evaluations;
}

/// Why the tolerances are not of this study: one names an observable that it does not measure.
std::optional<Refusal> unmeasured(const Calibration& calibration,
                                  const calibrator::Tolerances& stated) {
  std::vector<std::string> measured;
  for (const calibrator::Measurement& measurement : calibration.measurements) {
    std::string name = calibrator::observable_name(measurement);
    if (std::ranges::find(measured, name) == measured.end()) measured.push_back(std::move(name));
  }
  for (const auto& [name, spread] : stated) {
    if (std::ranges::find(measured, name) != measured.end()) continue;
    return refusal(
        Refusal::Kind::invalid,
        "a tolerance of " + name + " changes nothing: the study measures " + listed(measured));
  }
  return std::nullopt;
}

/// Why a model cannot be extended by that.
Refusal no_extension(const std::vector<calibrator::Suspect>& suspects, const std::string& effect) {
  std::vector<std::string> names;
  names.reserve(suspects.size());
  for (const calibrator::Suspect& suspect : suspects) names.push_back(suspect.name);
  if (engine::find_effect(effect) != nullptr) {
    return refusal(
        Refusal::Kind::wrong_state,
        "the model has " + effect +
            " already, or another form of it; it could be extended by: " + listed(names));
  }
  const Problem problem{"/effect",
                        "there is no such effect to add" + did_you_mean(effect, names),
                        "\"" + effect + "\"",
                        listed(names)};
  return {Refusal::Kind::invalid, "there is no effect " + effect, {problem}};
}

}  // namespace

Answer<std::string> compare(const db::Store& store,
                            std::int64_t id,
                            const calibrator::Tolerances& stated) {
  const auto own = finished(store, id);
  if (!own) return Unexpected{own.error()};
  if (auto why = unmeasured(own->calibration, stated)) return Unexpected{*std::move(why)};
  std::optional<calibrator::Comparison> before;
  if (own->calibration.extends) {
    const auto parent = finished(store, own->calibration.extends->calibration);
    if (parent) before = calibrator::compare(parent->calibration, parent->fit, stated);
  }
  const auto comparison = calibrator::compare(own->calibration, own->fit, stated);
  std::optional<calibrator::Tolerated> tolerated;
  if (comparison.p < calibrator::unlikely) {
    tolerated = calibrator::tolerated(own->calibration, own->fit, stated);
  }
  return print_comparison(own->calibration, comparison, tolerated, before);
}

Answer<std::int64_t> queue_diagnosis(db::Store& store,
                                     std::int64_t calibration,
                                     const calibrator::Tolerances& stated) {
  const auto own = finished(store, calibration);
  if (!own) return Unexpected{own.error()};
  if (const auto why = calibrator::objections(own->calibration, own->fit); !why.empty()) {
    std::string message = "calibration " + std::to_string(calibration) + " cannot be diagnosed";
    for (const std::string& objection : why) message += "; " + objection;
    return Unexpected{refusal(Refusal::Kind::wrong_state, std::move(message))};
  }
  const std::string request = print_diagnosis_request(stated);
  if (const auto begun = store.unfinished_diagnosis(calibration, request)) return begun->id;
  return store.add_diagnosis(calibration, request, microseconds_now());
}

namespace {

/// Weighs a finished calibration; false where it was asked to stop.
bool weigh(db::Store& store,
           const WorkerOptions& options,
           const db::DiagnosisRecord& record,
           const std::stop_token& stop,
           const DiagnosisEvents& events) {
  const auto own = finished(store, record.calibration);
  if (!own) throw std::runtime_error(own.error().message);
  const auto stated = parse_diagnosis_request(record.request);
  if (!stated) throw std::runtime_error(stated.error().front().message);
  Workers workers(store, options);
  std::int64_t ordinal = 0;
  bool interrupted = false;
  const calibrator::Evaluator evaluator = [&](std::span<const engine::Trial> trials) {
    auto evaluations = workers.run(trials, stop, events.trial);
    if (!workers.interrupted()) store.note_used_by_diagnosis(record.id, ordinal, workers.used());
    ordinal += static_cast<std::int64_t>(workers.used().size());
    interrupted |= workers.interrupted();
    return evaluations;
  };
  const auto observer = [&](const calibrator::DiagnosisProgress& progress) {
    store.set_diagnosis_progress(record.id, print_diagnosis_progress(progress));
    if (events.progress) events.progress(progress);
  };
  const auto result =
      calibrator::diagnose(own->calibration, own->fit, *stated, evaluator, stop, observer);
  if (!result || interrupted || stop.stop_requested()) return false;
  store.finish_diagnosis(record.id,
                         "done",
                         print_diagnosis(own->calibration, *stated, *result),
                         {},
                         microseconds_now());
  return true;
}

}  // namespace

bool run_diagnosis(db::Store& store,
                   const WorkerOptions& options,
                   std::int64_t id,
                   const std::stop_token& stop,
                   const DiagnosisEvents& events) {
  const auto record = store.diagnosis(id);
  if (!record) return true;
  try {
    return weigh(store, options, *record, stop, events);
  } catch (const db::Error&) {
    throw;  // the store fails, not the diagnosis
  } catch (const HostFailure&) {
    throw;
  } catch (const std::exception& problem) {
    store.finish_diagnosis(id, "failed", {}, problem.what(), microseconds_now());
    return true;
  }
}

Answer<std::string> diagnosis(const db::Store& store, std::int64_t id) {
  const auto record = store.diagnosis(id);
  if (!record) return Unexpected{not_found("diagnosis", id)};
  return print_diagnosis_record(*record);
}

Answer<std::string> diagnoses(const db::Store& store, std::int64_t calibration) {
  if (!store.calibration(calibration)) {
    return Unexpected{not_found("calibration", calibration)};
  }
  return print_diagnosis_records(store.diagnoses(calibration));
}

Answer<std::string> extension_study(const db::Store& store,
                                    std::int64_t id,
                                    const std::string& effect,
                                    std::optional<std::int64_t> diagnosis) {
  const auto own = finished(store, id);
  if (!own) return Unexpected{own.error()};
  Calibration any = own->calibration;
  any.suspects.clear();  // they are the diagnosis's to weigh; a user may add what they will
  const auto suspects = calibrator::suspects_of(any, own->fit.best);
  const auto found = std::ranges::find(suspects, effect, &calibrator::Suspect::name);
  if (found == suspects.end()) return Unexpected{no_extension(suspects, effect)};
  if (!found->objection.empty()) {
    return Unexpected{refusal(Refusal::Kind::wrong_state,
                              effect + " cannot be weighed by this study: " + found->objection)};
  }
  Calibration child = with_clean_labels(own->calibration);  // it is submitted anew
  child.name += " + " + effect;
  calibrator::extend(*found, own->fit.best, child);
  child.extends = calibrator::Extension{id, std::nullopt, effect};
  for (const db::DiagnosisRecord& record : store.diagnoses(id)) {
    if (record.state != "done" || (diagnosis && record.id != *diagnosis)) continue;
    child.extends->diagnosis = record.id;
    break;
  }
  if (diagnosis && !child.extends->diagnosis) {
    return Unexpected{refusal(Refusal::Kind::wrong_state,
                              "calibration " + std::to_string(id) + " has no finished diagnosis " +
                                  std::to_string(*diagnosis))};
  }
  return print_calibration(child);
}

std::vector<calibrator::KnownRun> inherited_runs(const db::Store& store,
                                                 const Calibration& calibration,
                                                 std::int64_t made_at) {
  constexpr std::size_t most = 120;  // of a warm start; the emulators grow with the cube of it
  std::vector<engine::Evaluation> evaluations;
  const auto add = [&](const std::vector<engine::Evaluation>& more) {
    evaluations.insert(evaluations.end(), more.begin(), more.end());
  };
  if (calibration.extends) {
    add(evaluations_of(store.used(
        calibration.extends->calibration, std::numeric_limits<int>::max(), std::nullopt)));
    if (calibration.extends->diagnosis) {
      add(evaluations_of(store.used_by_diagnosis(*calibration.extends->diagnosis)));
    }
  }
  if (!calibration.budget.warm_start) return calibrator::known_runs(calibration, evaluations);
  std::vector<db::UsedEvaluation> stored;
  for (db::EvaluationRecord& record :
       store.evaluations_before(std::string(engine::version()), made_at)) {
    const auto named = [&](const calibrator::Measurement& m) {  // before the dear reading of it
      return record.question.find('"' + m.experiment.name + '"') != std::string::npos;
    };
    if (std::ranges::any_of(calibration.measurements, named)) {
      stored.push_back({0, std::move(record)});
    }
  }
  add(evaluations_of(stored));
  return calibrator::closest_runs(
      calibration, calibrator::known_runs(calibration, evaluations), most);
}

}  // namespace repose::server
