/// FitQualities: how well the fits of finished calibrations meet their measurements. These do not
/// change any more, and the chance of a misfit may take thousands of draws: each is worked out once.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "db/store.hpp"

namespace repose::server {

class FitQualities {
 public:
  /// The document (print_fit_quality(), without stated tolerances) of a finished calibration;
  /// nothing where its study or its fit cannot be read any more.
  std::optional<std::string> of(const db::Store& store, std::int64_t calibration);

 private:
  std::mutex mutex_;  ///< held for nothing but a look or a change
  std::map<std::int64_t, std::optional<std::string>> known_;
};

}  // namespace repose::server
