#include "calibrator/probe.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "calibrator/misfit.hpp"
#include "calibrator/search_space.hpp"

namespace repose::calibrator {
namespace {

/// The fitted measurements of one experiment, and its run in the middle of the cube.
struct Group {
  std::vector<Measurement> measurements;
  std::vector<double> before;
  std::uint64_t cost = 0;  ///< grain-steps
};

std::vector<Group> grouped(const Calibration& calibration) {
  std::vector<Group> groups;
  for (const Measurement& m : calibration.measurements) {
    if (m.role != Role::fit) continue;
    const auto same = std::ranges::find_if(groups, [&](const Group& group) {
      return Suite(group.measurements).place_of(m.experiment).has_value();
    });
    if (same == groups.end()) {
      groups.push_back({{m}, {}, 0});
    } else {
      same->measurements.push_back(m);
    }
  }
  return groups;
}

class Probe {
 public:
  Probe(const Calibration& calibration, const Evaluator& evaluator)
      : calibration_(calibration), evaluator_(evaluator), space_(calibration) {}

  /// Draft runs of a group's experiment at the points.
  [[nodiscard]] std::vector<engine::Evaluation> ask(const Group& group,
                                                    std::span<const UnitPoint> points) const {
    std::vector<engine::Trial> trials;
    const Suite suite(group.measurements);
    for (const UnitPoint& point : points) {
      suite.append_trials(space_.at(point), engine::Fidelity::draft, calibration_.seed, trials);
    }
    return evaluator_(trials);
  }

  /// Those of the parameters that leave the group's observables as they were at a bound. NaN equals
  /// nothing.
  [[nodiscard]] std::vector<std::size_t> unmoved(const Group& group,
                                                 const std::vector<std::size_t>& parameters,
                                                 double bound) const {
    std::vector<UnitPoint> points;
    for (const std::size_t k : parameters) {
      points.emplace_back(space_.dimensions(), 0.5);
      points.back()[k] = bound;
    }
    const std::vector<engine::Evaluation> evaluations = ask(group, points);
    const Suite suite(group.measurements);
    std::vector<std::size_t> unmoved;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      if (suite.read(std::span(evaluations).subspan(i, 1)) == group.before) {
        unmoved.push_back(parameters[i]);
      }
    }
    return unmoved;
  }

  [[nodiscard]] UnitPoint middle() const { return UnitPoint(space_.dimensions(), 0.5); }

 private:
  const Calibration& calibration_;
  const Evaluator& evaluator_;
  SearchSpace space_;
};

}  // namespace

std::vector<std::size_t> unfelt_parameters(const Calibration& calibration,
                                           const Evaluator& evaluator) {
  const Probe probe(calibration, evaluator);
  std::vector<Group> groups = grouped(calibration);
  for (Group& group : groups) {
    const std::vector<UnitPoint> middle{probe.middle()};
    const std::vector<engine::Evaluation> evaluations = probe.ask(group, middle);
    group.before = Suite(group.measurements).read(evaluations);
    group.cost = evaluations.front().effort.grain_steps;
  }
  std::ranges::stable_sort(groups, {}, &Group::cost);
  std::vector<std::size_t> unfelt;
  for (std::size_t k = 0; k < calibration.free.size(); ++k) unfelt.push_back(k);
  for (const Group& group : groups) {
    for (const double bound : {1.0, 0.0}) {
      if (!unfelt.empty()) unfelt = probe.unmoved(group, unfelt, bound);
    }
  }
  return unfelt;
}

}  // namespace repose::calibrator
