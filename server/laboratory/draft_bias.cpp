#include "server/laboratory/draft_bias.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "server/report/number_text.hpp"

namespace repose::server {

namespace {

/// In the observable's printed unit.
struct Measured {
  std::string_view experiment, observable;
  double mean, deviation;
  int sets;
};

// What `repose bench fidelity` prints; to be measured anew when a draft's settings change.
constexpr std::array<Measured, 0> measured{};

}  // namespace

DraftBias draft_bias(const engine::ExperimentInfo& info, const engine::ObservableInfo& observable) {
  const auto found = std::ranges::find_if(measured, [&](const Measured& each) {
    return each.experiment == info.name && each.observable == observable.name;
  });
  if (found == measured.end()) return {};
  const double factor = observable.unit.factor;
  return {found->mean * factor, found->deviation * factor, found->sets};
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
