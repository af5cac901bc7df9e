#include "calibrator/draft_help.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "calibrator/phrase.hpp"
#include "calibrator/remarks.hpp"

namespace repose::calibrator {
namespace {

constexpr double least_r_squared = 0.9;
constexpr double most_cost = 0.2;

/// The runs of one site that share a seed: draft, then the search's.
std::vector<std::pair<const SiteRun*, const SiteRun*>> pairs_of(const Site& site) {
  std::vector<std::pair<const SiteRun*, const SiteRun*>> pairs;
  for (const SiteRun& draft : site.drafted) {
    const auto other = std::ranges::find(site.searched, draft.replicate, &SiteRun::replicate);
    if (other != site.searched.end()) pairs.emplace_back(&draft, &*other);
  }
  return pairs;
}

DraftHelp regression(const std::vector<std::pair<double, double>>& points, double cost) {
  DraftHelp help;
  help.cost = cost;
  help.pairs = static_cast<int>(points.size());
  if (points.size() < 4) return help;
  const auto n = static_cast<double>(points.size());
  double mean = 0.0;
  for (const auto& [x, y] : points) {
    help.mean += x / n;
    mean += y / n;
  }
  double products = 0.0, squares = 0.0;
  for (const auto& [x, y] : points) {
    help.spread += (x - help.mean) * (x - help.mean);
    products += (x - help.mean) * (y - mean);
    squares += (y - mean) * (y - mean);
  }
  if (!(help.spread > 0.0) || !(squares > 0.0)) return help;
  help.slope = products / help.spread;
  help.offset = mean - help.slope * help.mean;
  help.residual = std::max(0.0, squares - help.slope * products) / (n - 2.0);
  help.r_squared = 1.0 - help.residual / (squares / (n - 1.0));
  help.proven = help.r_squared >= least_r_squared && cost <= most_cost;
  return help;
}

}  // namespace

double DraftHelp::variance(double draft) const {
  const double away = draft - mean;
  return residual * (1.0 + 1.0 / pairs + away * away / spread);
}

std::vector<DraftHelp> learn_draft_help(const Ledger& ledger) {
  double draft_cost = 0.0, other_cost = 0.0;
  bool any = false;
  for (const Site& site : ledger.sites()) {
    any = any || !site.drafted.empty();
    for (const auto& [draft, other] : pairs_of(site)) {
      draft_cost += draft->grain_steps;
      other_cost += other->grain_steps;
    }
  }
  std::vector<DraftHelp> result;
  if (!any) return result;
  const double cost = other_cost > 0.0 ? draft_cost / other_cost : 1.0;
  for (std::size_t j = 0; j < ledger.calibration().measurements.size(); ++j) {
    std::vector<std::pair<double, double>> points;
    for (const Site& site : ledger.sites()) {
      for (const auto& [draft, other] : pairs_of(site)) {
        const bool whole = std::isfinite(draft->values[j]) && std::isfinite(other->values[j]);
        if (whole) points.emplace_back(draft->values[j], other->values[j]);
      }
    }
    result.push_back(regression(points, cost));
  }
  return result;
}

std::vector<std::string> draft_remarks(const Ledger& ledger) {
  std::vector<std::string> sentences;
  const std::vector<DraftHelp> all = learn_draft_help(ledger);
  for (std::size_t j = 0; j < all.size(); ++j) {
    const DraftHelp& help = all[j];
    const std::string evidence = std::to_string(help.pairs) +
                                 " paired runs give R2 = " + number(help.r_squared, 2) + " at " +
                                 number(help.cost, 2) + " of the cost";
    const std::string name = measurement_name(ledger.calibration().measurements[j]);
    sentences.push_back(help.proven ? "Draft runs helped with " + name + ": " + evidence + "."
                                    : "Draft runs were left out of " + name + ": " + evidence +
                                          ", where R2 of 0.9 or more at 0.2 or less is asked.");
  }
  return sentences;
}

}  // namespace repose::calibrator
