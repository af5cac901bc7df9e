#include "calibrator/baselines/baseline.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "calibrator/misfit.hpp"

namespace repose::calibrator {

BaselineSearch::BaselineSearch(Ledger& ledger, int reserve, std::stop_token stop, Listener listener)
    : ledger_(ledger),
      reserve_(reserve),
      stop_(std::move(stop)),
      listener_(std::move(listener)),
      best_seen_(ledger.space().dimensions(), 0.5),
      smallest_(std::numeric_limits<double>::infinity()),
      recommended_(best_seen_) {}

int BaselineSearch::left() const {
  return stop_.stop_requested() ? 0 : std::max(ledger_.remaining() - reserve_, 0);
}

std::vector<double> BaselineSearch::evaluate(std::span<const UnitPoint> points) {
  std::vector<Ledger::Request> requests;
  std::vector<int> next;  // replicate numbers already promised to this batch, per site
  for (const UnitPoint& point : points) {
    const std::size_t site = ledger_.site_at(point);
    next.resize(ledger_.sites().size(), -1);
    if (next[site] < 0) next[site] = ledger_.fresh_replicate(site);
    requests.push_back({site, next[site]++, Level::search});
  }
  const std::vector<SiteRun> runs = ledger_.run("search", requests);
  std::vector<double> misfits;
  misfits.reserve(runs.size());
  for (std::size_t i = 0; i < runs.size(); ++i) {
    misfits.push_back(runs[i].succeeded ? misfit(ledger_.calibration().measurements, runs[i].values)
                                        : std::numeric_limits<double>::infinity());
    if (misfits.back() < smallest_) {
      smallest_ = misfits.back();
      best_seen_ = points[i];
    }
  }
  return misfits;
}

void BaselineSearch::recommend(const UnitPoint& point) {
  recommended_ = point;
  if (listener_) listener_(*this);
}

bool search_by_baseline(BaselineSearch& search, Method method) {
  if (method == Method::cma_es) return search_by_cma_es(search);
  if (method == Method::filter) return search_by_filter(search);
  return search_by_nlopt(search, method);
}

}  // namespace repose::calibrator
