#include "server/laboratory/draft_bias.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include "engine/catalogue.hpp"
#include "server/report/number_text.hpp"

namespace repose::server {

namespace {

/// In the observable's printed unit.
struct Measured {
  std::string_view observable;  ///< experiment.observable
  double mean, deviation;
  int sets;
};

// What `repose bench fidelity` prints; to be measured anew when a draft's settings change.
constexpr std::array<Measured, 10> measured{{
    {"drop.restitution", 0.0, 0.0, 12},
    {"kettle.bulk_density", -10.8, 2.3, 12},
    {"tilting_box.static_angle", 1.02, 0.97, 12},
    {"tilting_box.onset_angle", 0.603, 1.1, 12},
    {"heap.heap_angle", -2.09, 2.6, 12},
    {"draw_down.discharge_rate", -1.75, 0.34, 12},
    {"draw_down.drain_angle", -2.29, 3.8, 12},
    {"drum.dynamic_angle", 1.72, 1.2, 12},
    {"compression.secant_modulus", -0.00616, 0.0065, 12},
    {"compression.residual_strain_ratio", 0.00187, 0.018, 12},
}};

}  // namespace

DraftBias draft_bias(const engine::ExperimentInfo& info, const engine::ObservableInfo& observable) {
  const std::string name = std::string(info.name) + '.' + std::string(observable.name);
  const auto found = std::ranges::find(measured, name, &Measured::observable);
  if (found == measured.end()) return {};
  const double factor = observable.unit.factor;
  return {found->mean * factor, found->deviation * factor, found->sets};
}

bool draft_is_in_force(const engine::ExperimentInfo& info, const engine::Experiment& experiment) {
  if (experiment.fidelity != engine::Fidelity::draft) return false;
  engine::Experiment standard = experiment;
  standard.fidelity = engine::Fidelity::standard;
  return engine::resolved_settings(info, experiment) != engine::resolved_settings(info, standard);
}

std::string draft_words(const engine::ExperimentInfo& info,
                        const engine::ObservableInfo& observable) {
  const DraftBias draft = draft_bias(info, observable);
  if (draft.sets == 0) return {};
  if (draft.mean == 0.0 && draft.deviation == 0.0) return "draft reads as standard does";
  const engine::Unit& unit = observable.unit;
  return "draft reads " + number_text(std::abs(draft.mean) / unit.factor, 2) + unit_suffix(unit) +
         (draft.mean < 0.0 ? " below" : " above") + " standard (standard deviation " +
         number_text(draft.deviation / unit.factor, 2) + unit_suffix(unit) + ", " +
         std::to_string(draft.sets) + " sets)";
}

}  // namespace repose::server
