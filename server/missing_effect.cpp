#include "server/missing_effect.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "calibrator/comparison.hpp"
#include "calibrator/diagnosis/objection.hpp"
#include "engine/catalogue.hpp"
#include "server/jobs/clock.hpp"
#include "server/json/calibration_json.hpp"
#include "server/json/comparison_json.hpp"
#include "server/json/diagnosis_json.hpp"
#include "server/json/evaluation_json.hpp"
#include "server/json/fit_json.hpp"
#include "server/json/job_json.hpp"
#include "server/json/text.hpp"

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
  if (!record) {
    return Unexpected{refusal(Refusal::Kind::not_found, "there is no " + name)};
  }
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

Json document(const std::optional<std::string>& text) {
  return text ? Json::parse(*text, nullptr, false) : Json(nullptr);
}

Json print_record(const db::DiagnosisRecord& record, bool whole) {
  Json json{{"id", record.id},
            {"calibration", record.calibration},
            {"state", record.state},
            {"created_at", print_time(record.created_at)},
            {"finished_at", record.finished_at ? Json(print_time(*record.finished_at)) : nullptr},
            {"request", document(record.request)},
            {"progress", document(record.progress)},
            {"error", record.error ? Json(*record.error) : nullptr}};
  const Json result = document(record.result);
  if (whole) {
    json["result"] = result;
  } else {
    for (const char* member : {"verdict", "grade", "text"}) {
      json[member] = result.is_object() ? result.value(member, Json(nullptr)) : Json(nullptr);
    }
  }
  return json;
}

std::string print_request(const calibrator::Tolerances& stated) {
  Json tolerances = Json::object();
  for (const auto& [observable, spread] : stated) tolerances[observable] = spread;
  return to_text(Json{{"tolerances", std::move(tolerances)}});
}

std::vector<engine::Evaluation> evaluations_of(const std::vector<db::UsedEvaluation>& used) {
  std::vector<engine::Evaluation> evaluations;
  for (const db::UsedEvaluation& entry : used) {
    const auto trial = parse_trial(entry.evaluation.question);
    if (trial) evaluations.push_back(parse_answer(*trial, entry.evaluation.answer));
  }
  return evaluations;
}

}  // namespace

Answer<std::string> compare(const db::Store& store,
                            std::int64_t id,
                            const calibrator::Tolerances& stated) {
  const auto own = finished(store, id);
  if (!own) return Unexpected{own.error()};
  std::optional<calibrator::Comparison> before;
  if (own->calibration.extends) {
    const auto parent = finished(store, own->calibration.extends->calibration);
    if (parent) before = calibrator::compare(parent->calibration, parent->fit, stated);
  }
  return print_comparison(
      own->calibration, calibrator::compare(own->calibration, own->fit, stated), before);
}

Answer<std::string> diagnose(db::Store& store,
                             const WorkerOptions& options,
                             std::int64_t id,
                             const calibrator::Tolerances& stated,
                             const std::stop_token& stop,
                             const DiagnosisEvents& events) {
  const auto own = finished(store, id);
  if (!own) return Unexpected{own.error()};
  if (const auto why = calibrator::objections(own->calibration, own->fit); !why.empty()) {
    std::string message = "calibration " + std::to_string(id) + " cannot be diagnosed";
    for (const std::string& objection : why) message += "; " + objection;
    return Unexpected{refusal(Refusal::Kind::wrong_state, std::move(message))};
  }
  const std::int64_t diagnosis_id =
      store.add_diagnosis(id, print_request(stated), microseconds_now());
  Workers workers(store, options);
  std::int64_t ordinal = 0;
  bool interrupted = false;
  const calibrator::Evaluator evaluator = [&](std::span<const engine::Trial> trials) {
    auto evaluations = workers.run(trials, stop, events.trial);
    if (!workers.interrupted()) {
      store.note_used_by_diagnosis(diagnosis_id, ordinal, workers.used());
    }
    ordinal += static_cast<std::int64_t>(workers.used().size());
    interrupted |= workers.interrupted();
    return evaluations;
  };
  const auto observer = [&](const calibrator::DiagnosisProgress& progress) {
    store.set_diagnosis_progress(
        diagnosis_id,
        to_text(Json{{"stage", progress.stage}, {"evaluations_done", progress.evaluations_done}}));
    if (events.progress) events.progress(progress);
  };
  try {
    const auto question = calibrator::question_of(own->calibration, own->fit, stated);
    const auto result = calibrator::diagnose(question, evaluator, stop, observer);
    if (!result || interrupted) {
      store.finish_diagnosis(diagnosis_id, "cancelled", {}, {}, microseconds_now());
    } else {
      store.finish_diagnosis(diagnosis_id,
                             "done",
                             print_diagnosis(own->calibration, stated, *result),
                             {},
                             microseconds_now());
    }
  } catch (const std::exception& problem) {
    store.finish_diagnosis(diagnosis_id, "failed", {}, problem.what(), microseconds_now());
  }
  return diagnosis(store, diagnosis_id);
}

Answer<std::string> diagnosis(const db::Store& store, std::int64_t id) {
  const auto record = store.diagnosis(id);
  if (!record) {
    return Unexpected{
        refusal(Refusal::Kind::not_found, "there is no diagnosis " + std::to_string(id))};
  }
  return to_text(print_record(*record, true));
}

Answer<std::string> diagnoses(const db::Store& store, std::int64_t calibration) {
  if (!store.calibration(calibration)) {
    return Unexpected{refusal(Refusal::Kind::not_found,
                              "there is no calibration " + std::to_string(calibration))};
  }
  Json items = Json::array();
  for (const db::DiagnosisRecord& record : store.diagnoses(calibration)) {
    items.push_back(print_record(record, false));
  }
  return to_text(Json{{"items", std::move(items)}});
}

Answer<std::string> extension_study(const db::Store& store,
                                    std::int64_t id,
                                    const std::string& effect) {
  const auto own = finished(store, id);
  if (!own) return Unexpected{own.error()};
  const auto suspects = calibrator::suspects_of(own->calibration, own->fit.best);
  const auto found = std::ranges::find(suspects, effect, &calibrator::Suspect::name);
  if (found == suspects.end()) {
    std::string names;
    for (const auto& suspect : suspects) names += (names.empty() ? "" : ", ") + suspect.name;
    return Unexpected{refusal(Refusal::Kind::wrong_state,
                              (engine::find_effect(effect) != nullptr
                                   ? "the model has " + effect + " already, or another form of it"
                                   : "there is no effect " + effect) +
                                  (names.empty() ? "" : "; it could be extended by: " + names))};
  }
  Calibration child = own->calibration;
  child.name += " + " + effect;
  calibrator::extend(*found, own->fit.best, child);
  child.extends = calibrator::Extension{id, std::nullopt, effect};
  for (const db::DiagnosisRecord& record : store.diagnoses(id)) {
    if (record.state != "done") continue;
    child.extends->diagnosis = record.id;
    break;
  }
  return print_calibration(child);
}

std::vector<calibrator::KnownRun> inherited_runs(const db::Store& store,
                                                 const Calibration& calibration) {
  if (!calibration.extends) return {};
  std::vector<engine::Evaluation> evaluations = evaluations_of(
      store.used(calibration.extends->calibration, std::numeric_limits<int>::max(), std::nullopt));
  if (calibration.extends->diagnosis) {
    const auto more = evaluations_of(store.used_by_diagnosis(*calibration.extends->diagnosis));
    evaluations.insert(evaluations.end(), more.begin(), more.end());
  }
  return calibrator::known_runs(calibration, evaluations);
}

}  // namespace repose::server
