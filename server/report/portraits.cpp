#include "server/report/portraits.hpp"

#include <algorithm>
#include <atomic>
#include <optional>
#include <thread>
#include <utility>

#include "engine/evaluate.hpp"
#include "server/report/label.hpp"
#include "server/report/number_text.hpp"
#include "server/report/picture.hpp"
#include "server/report/stored_frame.hpp"

namespace repose::server {

using engine::Experiment;

namespace {

constexpr std::size_t fewest_grains = 30;  // below, there is no bed to look at

std::vector<Experiment> experiments_of(const calibrator::Calibration& calibration) {
  std::vector<Experiment> distinct;
  for (const calibrator::Measurement& measurement : calibration.measurements) {
    Experiment experiment = measurement.experiment;
    experiment.fidelity = calibration.budget.fidelity;
    if (std::ranges::find(distinct, experiment) == distinct.end()) {
      distinct.push_back(std::move(experiment));
    }
  }
  return distinct;
}

std::optional<ReportPicture> portrait(const engine::Trial& trial, std::stop_token stop) {
  StoredFrame last;
  engine::Run run;
  run.stop = std::move(stop);
  run.frames = [&](const engine::Frame& frame) {
    if (frame.stage != "running" && frame.grains.size() >= fewest_grains) last = store(frame);
  };
  engine::evaluate(trial, run);
  if (last.grains.empty()) return std::nullopt;
  const Experiment& experiment = trial.experiment;
  std::string name = experiment.name;
  std::ranges::replace(name, '_', ' ');
  std::string caption =
      count_text(last.grains.size()) + " grains, " +
      std::string(engine::fidelity_names[static_cast<std::size_t>(experiment.fidelity)]) +
      " fidelity, seed " + std::to_string(trial.seed);
  const std::string settings = settings_label(experiment);
  if (!settings.empty()) caption += "; " + settings;
  return ReportPicture{name + ", " + last.stage, caption, picture(last.view())};
}

}  // namespace

std::vector<ReportPicture> portraits(const calibrator::Calibration& calibration,
                                     const calibrator::Fit& fit,
                                     std::stop_token stop) {
  const std::vector<Experiment> experiments = experiments_of(calibration);
  std::vector<std::optional<ReportPicture>> drawn(experiments.size());
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < experiments.size(); i = next++) {
      drawn[i] = portrait({fit.best, experiments[i], calibration.seed}, stop);
    }
  };
  {
    std::vector<std::jthread> threads;
    const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
    for (std::size_t i = 0; i < std::min(cores, experiments.size()); ++i)
      threads.emplace_back(work);
  }
  std::vector<ReportPicture> pictures;
  for (auto& picture : drawn) {
    if (picture) pictures.push_back(std::move(*picture));
  }
  return pictures;
}

}  // namespace repose::server
