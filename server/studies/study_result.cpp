#include "server/studies/study_result.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

namespace repose::server {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
/// A change counts as clear above so many of its standard errors.
constexpr double clear_errors = 2.0;

/// Standard error of a printed mean.
double printed_error(const PublishedNumber& number, int replicates) {
  return number.deviation / std::sqrt(replicates);
}

bool is_clear(double change, double error, double other_error) {
  return std::abs(change) > clear_errors * std::hypot(error, other_error);
}

double steps_a_second(const Sample& sample) {
  return sample.simulated_seconds > 0.0 ? sample.grain_steps / sample.simulated_seconds : none;
}

}  // namespace

double Sample::mean() const {
  if (values.empty()) return none;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double Sample::deviation() const {
  if (values.size() < 2) return none;
  const double middle = mean();
  double squares = 0.0;
  for (const double value : values) squares += (value - middle) * (value - middle);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

double Sample::error() const { return deviation() / std::sqrt(static_cast<double>(values.size())); }

const Sample& StudyResult::sample(const std::string& run, const std::string& experiment) const {
  static const Sample nothing;
  const auto samples = runs.find(run);
  if (samples == runs.end()) return nothing;
  const auto found = samples->second.find(experiment);
  return found == samples->second.end() ? nothing : found->second;
}

Trend trend(const StudyResult& result, const std::string& run, const StudyExperiment& experiment) {
  const PublishedStudy& study = *result.study;
  const auto& printed = study.run(run).printed;
  const auto& base = study.run(study.base).printed;
  const auto here = printed.find(experiment.experiment), there = base.find(experiment.experiment);
  const Sample& ours = result.sample(run, experiment.experiment);
  const Sample& ours_base = result.sample(study.base, experiment.experiment);
  Trend trend{none, ours.mean() - ours_base.mean(), {}, false, false};
  trend.ours_clear = is_clear(trend.ours, ours.error(), ours_base.error());
  if (here == printed.end() || there == base.end()) return trend;
  trend.paper = here->second.mean - there->second.mean;
  trend.paper_clear = is_clear(trend.paper,
                               printed_error(here->second, experiment.replicates),
                               printed_error(there->second, experiment.replicates));
  if (!std::isnan(trend.ours) && trend.ours * trend.paper != 0.0) {
    trend.agrees = trend.ours * trend.paper > 0.0;
  }
  return trend;
}

TrendCount count_trends(const StudyResult& result,
                        const StudyTable& table,
                        const StudyExperiment& experiment) {
  std::set<std::string> seen{result.study->base};
  TrendCount count;
  for (const StudyGroup& group : table.groups) {
    for (const std::string& run : group.runs) {
      if (!seen.insert(run).second) continue;
      const Trend here = trend(result, run, experiment);
      if (!here.agrees) continue;
      ++(*here.agrees ? count.agree : count.opposite);
      if (!here.clear()) continue;
      if (*here.agrees) {
        ++count.clear_agree;
      } else {
        count.clearly_opposite.push_back(run);
      }
    }
  }
  return count;
}

CostRatio cost_ratio(const StudyResult& result,
                     const std::string& run,
                     const std::string& experiment) {
  const PublishedStudy& study = *result.study;
  const auto hours = [&](const std::string& name) {
    const auto found = std::ranges::find(study.computing_hours, name, &StudyRun::run);
    if (found == study.computing_hours.end() || !found->printed.contains(experiment)) return none;
    return found->printed.at(experiment).mean;
  };
  return {hours(run) / hours(study.base),
          steps_a_second(result.sample(run, experiment)) /
              steps_a_second(result.sample(study.base, experiment))};
}

}  // namespace repose::server
