#include "server/fit_qualities.hpp"

#include <utility>

#include "calibrator/comparison.hpp"
#include "server/json/comparison_json.hpp"
#include "server/nightly/continuation.hpp"

namespace repose::server {

namespace {

std::optional<std::string> quality_of(const db::Store& store, std::int64_t calibration) {
  const auto own = published(store, calibration);
  if (!own) return std::nullopt;
  return to_text(print_fit_quality(calibrator::compare(own->calibration, own->fit)));
}

}  // namespace

std::optional<std::string> FitQualities::of(const db::Store& store, std::int64_t calibration) {
  {
    const std::scoped_lock hold(mutex_);
    const auto known = known_.find(calibration);
    if (known != known_.end()) return known->second;
  }
  auto quality = quality_of(store, calibration);
  const std::scoped_lock hold(mutex_);
  return known_.emplace(calibration, std::move(quality)).first->second;
}

}  // namespace repose::server
