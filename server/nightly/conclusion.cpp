#include "server/nightly/conclusion.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "calibrator/comparison.hpp"
#include "calibrator/misfit.hpp"
#include "server/json/calibration_json.hpp"
#include "server/json/fit_json.hpp"
#include "server/json/missing_effect_request.hpp"
#include "server/json/schedule_json.hpp"
#include "server/missing_effect.hpp"
#include "server/nightly/continuation.hpp"
#include "server/nightly/promotion.hpp"

namespace repose::server {

using calibrator::Calibration;
using calibrator::Fit;
using calibrator::Measurement;
using calibrator::Published;
using calibrator::Recheck;
using calibrator::Role;
using db::NightEnd;
using db::NightRecord;

namespace {

constexpr double chance = 0.01;  // that a right model misses by so much: below it, it does not fit

/// What a night is judged by.
struct Evidence {
  Calibration study;
  Fit fit;
  std::optional<Published> incumbent;
  std::optional<Recheck> check;
};

bool fits(const Calibration& study, const Fit& fit) {
  using calibrator::StopReason;
  if (fit.stop == StopReason::failed || fit.stop == StopReason::implausible) return false;
  return calibrator::compare(study, fit).p >= chance;
}

Contender contender(const Calibration& study, const Fit& predicting, const Published& widths) {
  Contender result{.fits = fits(study, predicting), .held_out = {}, .widths = {}};
  const auto& measurements = study.measurements;
  const bool any = std::ranges::count(measurements, Role::held_out, &Measurement::role) > 0;
  for (const calibrator::Prediction& prediction : predicting.predictions) {
    const Measurement& measurement = measurements[prediction.measurement];
    if (held_out(measurement) != any) continue;
    result.held_out.push_back(
        {prediction.z, prediction.standard_error / calibrator::standard_uncertainty(measurement)});
  }
  const calibrator::SearchSpace space(widths.calibration);
  for (std::size_t k = 0; k < widths.fit.parameters.size(); ++k) {
    const auto& parameter = widths.fit.parameters[k];
    result.widths.push_back(space.coordinate(k, parameter.upper) -
                            space.coordinate(k, parameter.lower));
  }
  return result;
}

Promotion promotion_of(const Evidence& night) {
  const Contender own = contender(night.study, night.fit, {night.study, night.fit});
  if (!night.incumbent) {
    if (own.fits) return {true, "it is the first fit of the schedule"};
    return {false, "the first fit misses its measurements by more than chance"};
  }
  if (!night.check) {
    return {false, "the study has changed so that it cannot be compared with the fit in force"};
  }
  return judge(own, contender(night.study, night.check->fit, *night.incumbent));
}

/// The measurements that are not as the calibration before had them.
std::vector<ChangedMeasurement> changed(const Calibration& study,
                                        const std::optional<Calibration>& before) {
  std::vector<ChangedMeasurement> result;
  for (std::size_t j = 0; j < study.measurements.size(); ++j) {
    const Measurement& now = study.measurements[j];
    ChangedMeasurement change{j};
    bool same = false;
    for (const Measurement& old : before ? before->measurements : std::vector<Measurement>{}) {
      if (name_of(old) != name_of(now) || old.role != now.role) continue;
      change.before = old.value;
      same = old.value == now.value && old.standard_error == now.standard_error;
    }
    if (!same) result.push_back(change);
  }
  return result;
}

/// What can be followed tonight: fitted measurements that are new, and the parameters that follow
/// from them where the data determine these.
std::vector<Followed> estimates(const Evidence& night,
                                const std::vector<ChangedMeasurement>& changes) {
  std::vector<Followed> result;
  for (const ChangedMeasurement& change : changes) {
    const Measurement& now = night.study.measurements[change.measurement];
    if (now.role != Role::fit) continue;
    result.push_back({name_of(now), {now.value, now.standard_error}, {}});
  }
  if (result.empty()) return result;
  const bool kept = night.check && night.check->passed;
  for (const auto& parameter : kept ? night.check->estimate : night.fit.parameters) {
    if (!parameter.determined || !(parameter.upper > parameter.lower)) continue;
    constexpr double width = 2.0 * 1.959964;  // of a 95 % interval, in standard errors
    result.push_back({engine::to_string(parameter.key),
                      {parameter.value, (parameter.upper - parameter.lower) / width},
                      {}});
  }
  return result;
}

/// The last night's charts, each with tonight's point where there is one.
std::vector<Followed> followed(std::vector<Followed> charts, std::vector<Followed> tonight) {
  for (const Followed& point : tonight) {
    if (std::ranges::find(charts, point.name, &Followed::name) == charts.end()) {
      charts.push_back({point.name, {}, {}});
    }
  }
  const double limit = limit_for(static_cast<double>(charts.size()) * nights_to_false_alarm);
  for (Followed& chart : charts) {
    const auto point = std::ranges::find(tonight, chart.name, &Followed::name);
    if (point == tonight.end()) {
      // An alarm is told once; the chart begins anew with the next point.
      if (chart.drift.alarm) chart.drift = {};
      continue;
    }
    chart.estimate = point->estimate;
    chart.drift = advance(chart.drift, point->estimate, limit);
  }
  return charts;
}

std::vector<Followed> last_charts(const std::vector<NightRecord>& nights) {
  for (const NightRecord& night : nights) {
    if (night.state != "done" || !night.result) continue;
    auto charts = parse_followed(*night.result);
    if (!charts.empty()) return charts;
  }
  return {};
}

/// The calibration before this one whose measurements it was about.
std::optional<Calibration> last_study(const db::Store& store,
                                      const std::vector<NightRecord>& nights,
                                      const NightRecord& tonight) {
  std::optional<std::int64_t> id = tonight.incumbent;
  for (const NightRecord& night : nights) {
    if (night.state != "done" || !night.calibration || night.id == tonight.id) continue;
    id = night.calibration;
    break;
  }
  const auto record = id ? store.calibration(*id) : std::nullopt;
  if (!record) return std::nullopt;
  auto study = parse_calibration(record->request);
  return study ? std::optional(*std::move(study)) : std::nullopt;
}

/// What the night was judged by, from the store; or why there is nothing to judge.
Answer<Evidence> evidence(db::Store& store,
                          const WorkerOptions& options,
                          const NightRecord& night,
                          const std::stop_token& stop) {
  const auto record = store.calibration(*night.calibration);
  if (record->state != "done") {
    return engine::Unexpected{Refusal{Refusal::Kind::wrong_state,
                                      "calibration " + std::to_string(record->id) + " is " +
                                          record->state +
                                          (record->error ? ": " + *record->error : ""),
                                      {}}};
  }
  auto own = published(store, *night.calibration);
  if (!own) {
    return engine::Unexpected{Refusal{Refusal::Kind::wrong_state, "its fit cannot be read", {}}};
  }
  Evidence result{std::move(own->calibration), std::move(own->fit), {}, {}};
  const auto continuation = continuation_of(store, *night.calibration);
  if (!continuation) return result;
  result.incumbent = published(store, continuation->calibration);
  Workers workers(store, options);
  result.check = recheck_published(
      store, result.study, *continuation, [&](std::span<const engine::Trial> trials) {
        return workers.run(trials, stop, {});
      });
  return result;
}

std::string outcome_of(const Evidence& night) {
  if (night.check && night.check->passed) return "kept";
  if (!fits(night.study, night.fit)) return "model_no_longer_adequate";
  return night.incumbent ? "moved" : "first";
}

/// The diagnosis of a night's calibration, queued where there is none yet.
Answer<std::int64_t> diagnosis_of(db::Store& store, std::int64_t calibration) {
  const std::string request = print_diagnosis_request({});
  for (const db::DiagnosisRecord& record : store.diagnoses(calibration)) {
    if (record.request == request) return record.id;
  }
  return queue_diagnosis(store, calibration, {});
}

}  // namespace

Conclusion conclude(db::Store& store,
                    const WorkerOptions& options,
                    const NightRecord& night,
                    const std::stop_token& stop) {
  const auto begun = store.unfinished_diagnosis(*night.calibration, print_diagnosis_request({}));
  if (begun) return {.diagnosis = begun->id};
  NightReport report;
  const auto found = evidence(store, options, night, stop);
  if (!found) {
    report.reason = found.error().message;
    return {.end = NightEnd{.state = "failed", .result = print_night_report({}, report)}};
  }
  if (stop.stop_requested()) return {};
  constexpr int looked_back = 400;
  const auto nights = db::ScheduleStore(store).nights(night.schedule, looked_back, std::nullopt);
  NightEnd end{.state = "done", .outcome = outcome_of(*found)};
  report.changed = changed(found->study, last_study(store, nights, night));
  report.followed = followed(last_charts(nights), estimates(*found, report.changed));
  for (const Followed& chart : report.followed) {
    if (chart.drift.alarm) report.alarms.push_back(chart.name);
  }
  if (found->check) report.incumbent_held = found->check->passed;
  if (end.outcome == "kept") {
    report.reason = "fresh replicates of the fit in force agree with the measurements";
  } else {
    const Promotion promotion = promotion_of(*found);
    report.promoted = promotion.promoted;
    report.reason = promotion.reason;
    if (promotion.promoted) end.promotion = promotion.reason;
  }
  if (end.outcome == "model_no_longer_adequate") {
    const auto diagnosis = diagnosis_of(store, *night.calibration);
    if (!diagnosis) {
      report.reason += "; no diagnosis: " + diagnosis.error().message;
    } else if (!store.diagnosis(*diagnosis)->finished_at) {
      return {.diagnosis = *diagnosis};
    } else {
      end.diagnosis = *diagnosis;
    }
  }
  end.result = print_night_report(found->study, report);
  return {.end = std::move(end)};
}

}  // namespace repose::server
