#include "calibrator/diagnosis/choice.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "calibrator/diagnosis/verdict.hpp"

namespace repose::calibrator {
namespace {

/// Departures of the screen that the data could show, by score.
std::vector<std::size_t> testable(const Screen& screen,
                                  const std::vector<std::size_t>& screened,
                                  const Diagnosis& diagnosis) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < screened.size(); ++i) {
    if (diagnosis.effects[screened[i]].status != EffectStatus::not_testable) order.push_back(i);
  }
  std::ranges::stable_sort(
      order, std::greater<>(), [&](std::size_t i) { return screen.scores()[i].value; });
  return order;
}

}  // namespace

std::vector<Additions> best_singles(const Screen& screen,
                                    const std::vector<std::size_t>& screened,
                                    const Diagnosis& diagnosis) {
  constexpr std::size_t most = 3;
  const std::vector<std::size_t> order = testable(screen, screened, diagnosis);
  std::vector<std::size_t> chosen, passed_over;
  for (const std::size_t i : order) {
    const bool stood_for =
        std::ranges::any_of(chosen, [&](std::size_t other) { return screen.same_trace(i, other); });
    (stood_for || chosen.size() == most ? passed_over : chosen).push_back(i);
  }
  for (std::size_t k = 0; chosen.size() < most && k < passed_over.size(); ++k) {
    chosen.push_back(passed_over[k]);
  }
  std::vector<Additions> result;
  for (const std::size_t i : chosen) result.push_back({screened[i]});
  return result;
}

std::vector<Additions> best_pairs(const Screen& screen,
                                  const std::vector<std::size_t>& screened,
                                  const Diagnosis& diagnosis) {
  struct Pair {
    double gain;
    Additions on;
  };
  std::vector<Pair> pairs;
  const std::vector<std::size_t> order = testable(screen, screened, diagnosis);
  for (std::size_t a = 0; a < order.size(); ++a) {
    for (std::size_t b = a + 1; b < order.size(); ++b) {
      const auto [i, j] = std::minmax(order[a], order[b]);
      pairs.push_back({screen.pair_gain(i, j), {screened[i], screened[j]}});
    }
  }
  std::ranges::stable_sort(pairs, std::greater<>(), &Pair::gain);
  std::vector<Additions> chosen;
  const std::size_t winner = diagnosis.refits.front().effects.front();
  const auto has_winner = [winner](const Additions& on) {
    return std::ranges::find(on, winner) != on.end();
  };
  for (const Pair& pair : pairs) {
    const bool wanted = chosen.size() < 2 || (chosen.size() < 3 && has_winner(pair.on) &&
                                              !std::ranges::any_of(chosen, has_winner));
    if (wanted) chosen.push_back(pair.on);
  }
  return chosen;
}

}  // namespace repose::calibrator
