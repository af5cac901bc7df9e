#include "server/service.hpp"

#include <chrono>
#include <iostream>
#include <stdexcept>
#include <utility>

#include "db/attempt_store.hpp"
#include "db/event_store.hpp"
#include "db/material_store.hpp"
#include "engine/evaluate.hpp"
#include "server/access/secret.hpp"
#include "server/exports/export_fit.hpp"
#include "server/jobs/clock.hpp"
#include "server/jobs/workers.hpp"
#include "server/json/calibration_json.hpp"
#include "server/json/event_json.hpp"
#include "server/json/fit_list_json.hpp"
#include "server/json/job_json.hpp"
#include "server/json/labels.hpp"
#include "server/json/measurement_set_json.hpp"
#include "server/json/missing_effect_request.hpp"
#include "server/json/own_material_json.hpp"
#include "server/lineage.hpp"
#include "server/measurements.hpp"
#include "server/missing_effect.hpp"
#include "server/nightly/nights.hpp"
#include "server/own_materials.hpp"
#include "server/schedules.hpp"
#include "server/service_state.hpp"
#include "server/webhooks.hpp"

namespace repose::server {

using calibrator::Calibration;
using engine::Unexpected;

Service::Service(const ServiceOptions& options) : state_(std::make_unique<State>(options)) {}
Service::~Service() = default;

Refusal invalid(std::string_view what, Problems problems) {
  std::string message = std::string(what) + " has " + counted(problems);
  return {Refusal::Kind::invalid, std::move(message), std::move(problems)};
}

Refusal not_found(std::string_view what, std::int64_t id) {
  return {
      Refusal::Kind::not_found, "there is no " + std::string(what) + " " + std::to_string(id), {}};
}

namespace {

/// A study with what it names in its place, and where that is from.
struct Submitted {
  Calibration calibration;
  db::SourceRecord source;
};

/// What extends a calibration is of the same material where it names none, and of the same set as
/// long as it has that set's measurements.
void inherit_source(db::Store& store, Submitted& submitted) {
  const Calibration& own = submitted.calibration;
  if (!own.extends) return;
  const auto record = store.calibration(own.extends->calibration);
  const auto parent = record ? parse_calibration(record->request) : Unexpected{Problems{}};
  if (!parent) return;
  const db::SourceRecord source = db::MeasurementStore(store).source(record->id);
  if (!submitted.source.material) submitted.source.material = source.material;
  const bool same_material = submitted.source.material == source.material;
  if (!submitted.source.set && same_material &&
      own.measurements == with_clean_labels(*parent).measurements) {
    submitted.source.set = source.set;
  }
}

/// What a study says to extend is there, and so is the diagnosis of it: else it would begin without
/// their runs, and nobody would know.
Problems objections_to_extension(const db::Store& store, const Calibration& calibration) {
  if (!calibration.extends) return {};
  const calibrator::Extension& extends = *calibration.extends;
  const std::string parent = std::to_string(extends.calibration);
  if (!store.calibration(extends.calibration)) {
    return {{"/extends/calibration",
             "there is no calibration " + parent,
             parent,
             "the number of a calibration in this database; without \"extends\" it begins anew"}};
  }
  if (!extends.diagnosis) return {};
  const auto diagnosis = store.diagnosis(*extends.diagnosis);
  if (diagnosis && diagnosis->calibration == extends.calibration) return {};
  const std::string found = std::to_string(*extends.diagnosis);
  return {{"/extends/diagnosis",
           "calibration " + parent + " has no diagnosis " + found,
           found,
           "the number of one of its diagnoses"}};
}

Answer<Submitted> read_submission(db::Store& store, std::string_view submission) {
  if (const auto labels = problems_of_labels(submission); !labels.empty()) {
    return Unexpected{invalid("the study", labels)};
  }
  const auto resolved = resolve_submission(store, submission);
  if (!resolved) return Unexpected{resolved.error()};
  auto calibration = parse_calibration(resolved->study);
  if (!calibration) return Unexpected{invalid("the study", calibration.error())};
  if (const Problems problems = objections_to_extension(store, *calibration); !problems.empty()) {
    return Unexpected{invalid("the study", problems)};
  }
  Submitted submitted{*std::move(calibration), resolved->source};
  inherit_source(store, submitted);
  return submitted;
}

std::int64_t add_calibration(db::Store& store, const Submitted& submitted) {
  const std::string request = print_calibration(submitted.calibration);
  return db::MeasurementStore(store).add_calibration(
      submitted.calibration.name, request, digest(request), submitted.source, microseconds_now());
}

}  // namespace

Answer<std::string> Service::submit(std::string_view study) {
  const auto submitted = read_submission(state_->store, study);
  if (!submitted) return Unexpected{submitted.error()};
  const std::int64_t id = add_calibration(state_->store, *submitted);
  if (state_->scheduler) state_->scheduler->submit({Job::Kind::calibration, id});
  return this->calibration(id);
}

Answer<std::string> Service::study(std::string_view submission) const {
  const auto submitted = read_submission(state_->store, submission);
  if (!submitted) return Unexpected{submitted.error()};
  return print_calibration(submitted->calibration);
}

Answer<std::string> Service::calibrate(std::string_view study,
                                       const std::stop_token& stop,
                                       const CalibrationEvents& events) {
  const auto submitted = read_submission(state_->store, study);
  if (!submitted) return Unexpected{submitted.error()};
  const auto unfinished =
      state_->store.unfinished(digest(print_calibration(submitted->calibration)));
  const std::int64_t id = unfinished ? unfinished->id : add_calibration(state_->store, *submitted);
  if (!state_->store.start(id, microseconds_now())) {
    return Unexpected{Refusal{Refusal::Kind::wrong_state,
                              "calibration " + std::to_string(id) + " is running already",
                              {}}};
  }
  state_->run(id, submitted->calibration, stop, events);
  return this->calibration(id);
}

Answer<std::string> Service::calibration(std::int64_t id) const {
  const auto record = state_->store.calibration(id);
  if (!record) return Unexpected{not_found("calibration", id)};
  const db::MeasurementStore measurements(state_->store);
  const db::SourceRecord source = measurements.source(id);
  return print_job(
      *record, source.material, source.set ? measurements.set(*source.set) : std::nullopt);
}

Page Service::calibrations(int limit, std::optional<std::int64_t> before) const {
  return print_jobs(state_->store.calibrations(limit, before), limit);
}

Answer<Page> Service::evaluations(std::int64_t calibration,
                                  int limit,
                                  std::optional<std::int64_t> after) const {
  if (!state_->store.calibration(calibration))
    return Unexpected{not_found("calibration", calibration)};
  return print_used(state_->store.used(calibration, limit, after), limit);
}

std::string Service::best_fits(const db::FitFilter& filter) const {
  return print_best_fits(state_->listed(db::MeasurementStore(state_->store).best_fits(filter)));
}

Answer<std::string> Service::cancel(std::int64_t id) {
  const auto record = state_->store.calibration(id);
  if (!record) return Unexpected{not_found("calibration", id)};
  const auto final = [&]() -> Answer<std::string> {
    return Unexpected{Refusal{Refusal::Kind::wrong_state,
                              "calibration " + std::to_string(id) + " has ended: it is " +
                                  state_->store.calibration(id)->state,
                              {}}};
  };
  if (record->finished_at) return final();
  const auto where = state_->cancel({Job::Kind::calibration, id});
  if (where == JobQueue::Cancelled::running) return calibration(id);
  if (!state_->store.finish(id, "cancelled", {}, {}, {}, microseconds_now())) return final();
  return calibration(id);
}

Answer<std::string> Service::compare(std::int64_t id, const calibrator::Tolerances& stated) const {
  return server::compare(state_->store, id, stated);
}

Answer<std::string> Service::diagnose(std::int64_t id,
                                      const calibrator::Tolerances& stated,
                                      const std::stop_token& stop,
                                      const DiagnosisEvents& events) {
  const auto diagnosis_id = queue_diagnosis(state_->store, id, stated);
  if (!diagnosis_id) return Unexpected{diagnosis_id.error()};
  state_->run_diagnosis(*diagnosis_id, stop, events);
  return diagnosis(*diagnosis_id);
}

Answer<std::string> Service::submit_diagnosis(std::int64_t calibration, std::string_view request) {
  const auto stated = parse_diagnosis_request(request);
  if (!stated) return Unexpected{invalid("the request", stated.error())};
  const auto id = queue_diagnosis(state_->store, calibration, *stated);
  if (!id) return Unexpected{id.error()};
  if (state_->scheduler) state_->scheduler->submit({Job::Kind::diagnosis, *id});
  return diagnosis(*id);
}

Answer<std::string> Service::cancel_diagnosis(std::int64_t id) {
  const auto record = state_->store.diagnosis(id);
  if (!record) return diagnosis(id);
  const auto ended = [&](const std::string& state) -> Answer<std::string> {
    return Unexpected{Refusal{Refusal::Kind::wrong_state,
                              "diagnosis " + std::to_string(id) + " has ended: it is " + state,
                              {}}};
  };
  if (record->finished_at) return ended(record->state);
  const auto where = state_->cancel({Job::Kind::diagnosis, id});
  if (where != JobQueue::Cancelled::running &&
      !state_->store.finish_diagnosis(id, "cancelled", {}, {}, microseconds_now())) {
    return ended(state_->store.diagnosis(id)->state);
  }
  return diagnosis(id);
}

Answer<std::string> Service::diagnosis(std::int64_t id) const {
  return server::diagnosis(state_->store, id);
}

Answer<std::string> Service::diagnoses(std::int64_t calibration) const {
  return server::diagnoses(state_->store, calibration);
}

Answer<std::string> Service::extension_study(std::int64_t id,
                                             const std::string& effect,
                                             std::optional<std::int64_t> diagnosis) const {
  return server::extension_study(state_->store, id, effect, diagnosis);
}

Answer<std::string> Service::extend(std::int64_t id, std::string_view request) {
  const auto wanted = parse_extension_request(request);
  if (!wanted) return Unexpected{invalid("the request", wanted.error())};
  const auto study = extension_study(id, wanted->effect, wanted->diagnosis);
  return study ? submit(*study) : study;
}

Answer<std::string> Service::lineage(std::int64_t id) const {
  return server::lineage(state_->store, id);
}

Answer<std::string> Service::export_fit(std::int64_t id, std::string_view format) const {
  return server::export_fit(state_->store, id, format);
}

Answer<std::string> Service::add_webhook(std::string_view content) {
  return server::add_webhook(state_->store, content, state_->webhook_hosts);
}

Answer<std::string> Service::replace_webhook(std::int64_t id, std::string_view content) {
  return server::replace_webhook(state_->store, id, content, state_->webhook_hosts);
}

Answer<std::string> Service::remove_webhook(std::int64_t id) {
  return server::remove_webhook(state_->store, id);
}

Answer<std::string> Service::webhook(std::int64_t id) const {
  return server::webhook(state_->store, id);
}

std::string Service::webhooks() const { return server::webhooks(state_->store); }

Answer<std::string> Service::add_schedule(std::string_view document) {
  return server::add_schedule(state_->store, document, state_->clock());
}

Answer<std::string> Service::replace_schedule(std::int64_t id, std::string_view document) {
  return server::replace_schedule(state_->store, id, document, state_->clock());
}

Answer<std::string> Service::remove_schedule(std::int64_t id) {
  return server::remove_schedule(state_->store, id, state_->clock());
}

Answer<std::string> Service::schedule(std::int64_t id) const {
  return server::schedule(state_->store, id, state_->clock());
}

std::string Service::schedules() const { return server::schedules(state_->store, state_->clock()); }

Answer<Page> Service::nights(std::int64_t schedule,
                             int limit,
                             std::optional<std::int64_t> before) const {
  return server::nights(state_->store, schedule, limit, before);
}

Answer<std::string> Service::promotions(std::int64_t schedule) const {
  return server::promotions(state_->store, schedule);
}

Answer<std::string> Service::promote(std::int64_t schedule, std::string_view document) {
  return server::promote(state_->store, schedule, document, state_->clock());
}

void Service::run_nights(bool all, const std::stop_token& stop, const CalibrationEvents& events) {
  const Begin which = all ? Begin::all : Begin::due;
  FailureLog failures;
  for (const std::int64_t id : begin_nights(state_->store, which, state_->clock(), failures)) {
    const auto record = state_->store.calibration(id);
    const auto calibration = parse_calibration(record->request);
    if (!calibration || !state_->store.start(id, microseconds_now())) continue;
    state_->run(id, *calibration, stop, events);
    if (stop.stop_requested()) return;
  }
  const auto end = [&] {
    return end_nights(state_->store, state_->worker_options, stop, state_->clock(), failures);
  };
  for (auto ids = end(); !ids.empty() && !stop.stop_requested(); ids = end()) {
    for (const std::int64_t id : ids) state_->run_diagnosis(id, stop, {});
  }
  if (!failures.empty()) throw std::runtime_error("not every night could be run: the log says why");
}

std::vector<engine::Evaluation> Service::evaluate(const engine::Trial& trial, int replicates) {
  std::vector<engine::Trial> trials(static_cast<std::size_t>(replicates), trial);
  for (std::size_t i = 0; i < trials.size(); ++i) trials[i].seed = trial.seed + i;
  Workers workers(state_->store, state_->worker_options);
  return workers.run(trials, {}, {});
}

std::string Service::materials() const {
  return print_all_materials(db::MaterialStore(state_->store).list());
}

Answer<std::string> Service::material(const std::string& name) const {
  return server::material(state_->store, name);
}

Answer<std::string> Service::put_material(const std::string& name,
                                          std::string_view content,
                                          bool may_replace) {
  return server::put_material(state_->store, name, content, may_replace);
}

Answer<std::string> Service::remove_material(const std::string& name) {
  return server::remove_material(state_->store, name);
}

Answer<std::string> Service::put_measurement_set(const std::string& name,
                                                 std::string_view content,
                                                 const std::optional<std::string>& table_of) {
  return server::put_measurement_set(state_->store, name, content, table_of);
}

Answer<std::string> Service::measurement_set(const std::string& name,
                                             const std::optional<std::int64_t>& version,
                                             bool as_table) const {
  return server::measurement_set(state_->store, name, version, as_table);
}

Page Service::measurement_sets(int limit, const std::optional<std::string>& after) const {
  return print_measurement_sets(db::MeasurementStore(state_->store).list(limit, after), limit);
}

Page Service::fits(const db::FitFilter& filter, int limit) const {
  return print_fits(state_->listed(db::MeasurementStore(state_->store).fits(filter, limit)), limit);
}

Answer<Page> Service::events(const std::optional<std::int64_t>& calibration,
                             int limit,
                             std::int64_t after) const {
  if (calibration && !state_->store.calibration(*calibration)) {
    return Unexpected{not_found("calibration", *calibration)};
  }
  return print_events(db::EventStore(state_->store).events(calibration, after, limit), limit);
}

Answer<std::function<std::string()>> Service::event_stream(
    const std::optional<std::int64_t>& calibration,
    const std::optional<std::int64_t>& after) const {
  if (calibration && !state_->store.calibration(*calibration)) {
    return Unexpected{not_found("calibration", *calibration)};
  }
  const db::EventStore store(state_->store);
  const std::int64_t start = after ? *after : store.newest();
  return std::function([store, calibration, last = start]() mutable -> std::string {
    constexpr int page = 100;
    if (store.newest() <= last) return {};
    const auto events = store.events(calibration, last, page);
    if (!events.empty()) last = events.back().id;
    return print_event_stream(events);
  });
}

std::optional<db::KeptReply> Service::once(
    const std::string& key,
    const std::string& request_digest,
    const std::function<std::optional<std::string>()>& work) {
  constexpr std::int64_t day = 24LL * 3600 * 1'000'000;  // microseconds
  const std::int64_t now = microseconds_now();
  db::ReplyStore replies(state_->store);
  replies.forget(now - day);
  return replies.once(key, request_digest, now, work);
}

bool Service::ready() {
  Readiness& readiness = state_->readiness;
  {
    const std::scoped_lock hold(readiness.mutex);
    const auto now = std::chrono::steady_clock::now();
    if (readiness.looked && now - *readiness.looked < std::chrono::seconds(1)) {
      return readiness.writable;
    }
    readiness.looked = now;
  }
  bool writable = true;
  try {
    db::probe(state_->store);
  } catch (const db::Error& error) {
    std::clog << std::string("repose: not ready: ") + error.what() + "\n";
    writable = false;
  }
  const std::scoped_lock hold(readiness.mutex);
  readiness.writable = writable;
  return writable;
}

ServiceFigures Service::figures() const {
  return {.engine_version = std::string(engine::version()),
          .jobs = state_->store.count_by_state(),
          .attempts = db::AttemptStore(state_->store).totals(),
          .store = db::figures(state_->store),
          .webhooks = db::WebhookStore(state_->store).figures(),
          .drift_alarms = db::EventStore(state_->store).drift_alarms(),
          .drift = drift_figures(state_->store)};
}

std::string Service::health() const {
  return print_health(state_->store.file().string(), state_->store.count_by_state());
}

}  // namespace repose::server
