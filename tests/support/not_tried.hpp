/// Tests that need what not every machine has.
#pragma once

#include <cstdlib>
#include <string>

#include <catch2/catch.hpp>

namespace repose::tests {

/// Says why a test is not tried here. Where all must be (.ci/run sets REPOSE_REQUIRE_ALL), that fails
/// it.
inline void not_tried(const std::string& why) {
  if (std::getenv("REPOSE_REQUIRE_ALL") != nullptr) FAIL(why);
  WARN(why << ": not tried");
}

}  // namespace repose::tests
