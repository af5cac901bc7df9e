/// Replicates of one virtual experiment -> JSON: what `repose evaluate --json` prints.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/experiment.hpp"
#include "server/json/problem.hpp"

namespace repose::server {

/// What the replicates say of one observable together.
struct MeanObservation {
  std::string name;
  double value = 0.0;           ///< SI; mean over the replicates; NaN where one was not read
  double standard_error = 0.0;  ///< SI; of that mean; NaN for one replicate
  engine::Unit unit;            ///< in which it is printed
  std::string unread = {};      ///< the first seed that was not read, and why
};

struct Replicates {
  engine::Trial trial;  ///< of the first; the others differ in seed
  std::vector<engine::Evaluation> evaluations;
  std::vector<double> wall_seconds;           ///< of each evaluation
  double elapsed = 0.0;                       ///< s of wall time for all of them
  std::vector<MeanObservation> observations;  ///< empty where one failed

  /// The first that failed.
  [[nodiscard]] const engine::Evaluation* failed() const;
  /// Sums over the replicates; overlaps: the largest; grains: of the first.
  [[nodiscard]] engine::Effort effort() const;
  /// Grains moved by one time step, per second of wall time.
  [[nodiscard]] double particle_steps_per_second() const;
};

/// What a user should know before the observations are trusted, in sentences.
std::vector<std::string> warnings(const Replicates& replicates);

std::string print_replicates(const Replicates& replicates, std::string_view engine_version);

/// {"error":{"message","problems":[...]}}
std::string print_error(const std::string& message, const Problems& problems);

}  // namespace repose::server
