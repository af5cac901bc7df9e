#include "server/json/missing_effect_request.hpp"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "engine/catalogue.hpp"
#include "server/json/place.hpp"

namespace repose::server {

namespace {

std::vector<std::string> names_of_observables() {
  std::vector<std::string> names;
  for (const engine::ExperimentInfo& experiment : engine::experiment_catalogue()) {
    for (const engine::ObservableInfo& observable : experiment.observables) {
      names.push_back(std::string(experiment.name) + "." + std::string(observable.name));
    }
  }
  return names;
}

void read_tolerance(const std::string& name,
                    const Place& place,
                    calibrator::Tolerances& tolerances) {
  const std::vector<std::string>& names = observable_names();
  if (std::ranges::find(names, name) == names.end()) {
    place.complain("there is no such observable" + did_you_mean(name, names), listed(names));
    return;
  }
  const auto share = place.number();
  if (!share) return;
  if (*share < 0.0 || *share > 1.0) {
    place.complain("a tolerance is a share of the observable", "0 to 1");
    return;
  }
  tolerances[name] = *share;
}

/// The document's object, read by `read`; all problems where there are any.
template <class T, class Reader>
engine::Result<T, Problems> parse_object(std::string_view text, const Reader& read) {
  ProblemList problems;
  const auto json = parse_text(text, {}, problems);
  T result{};
  if (json) {
    Members members(Place(&*json, "", problems));
    if (members.is_object()) {
      read(members, result);
      members.no_others();
    }
  }
  if (!problems.empty()) return engine::Unexpected{problems.all()};
  return result;
}

}  // namespace

const std::vector<std::string>& observable_names() {
  static const std::vector<std::string> names = names_of_observables();
  return names;
}

std::string print_diagnosis_request(const calibrator::Tolerances& stated) {
  Json tolerances = Json::object();
  for (const auto& [observable, spread] : stated) tolerances[observable] = spread;
  return to_text(Json{{"tolerances", std::move(tolerances)}});
}

engine::Result<calibrator::Tolerances, Problems> parse_diagnosis_request(std::string_view text) {
  return parse_object<calibrator::Tolerances>(text, [](Members& members, auto& tolerances) {
    const Place place = members.optional("tolerances");
    if (!place.exists()) return;
    Members named(place);
    for (const auto& [name, value] : named.all()) read_tolerance(name, value, tolerances);
  });
}

engine::Result<ExtensionRequest, Problems> parse_extension_request(std::string_view text) {
  return parse_object<ExtensionRequest>(text, [](Members& members, ExtensionRequest& request) {
    const Place effect = members.required("effect", "the name of the effect to add");
    const Place diagnosis = members.optional("diagnosis");
    if (effect.exists()) request.effect = effect.text(200).value_or("");
    if (!diagnosis.exists()) return;
    request.diagnosis = diagnosis.whole(1, std::numeric_limits<std::int64_t>::max());
  });
}

std::string print_diagnosis_progress(const calibrator::DiagnosisProgress& progress) {
  return to_text(Json{{"stage", progress.stage}, {"evaluations_done", progress.evaluations_done}});
}

}  // namespace repose::server
