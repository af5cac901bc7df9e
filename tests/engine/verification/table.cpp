#include "tests/engine/verification/table.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <catch2/catch.hpp>

namespace repose::tests {

namespace {

bool printing() {
  static const bool asked = std::getenv("REPOSE_VERIFICATION_TABLE") != nullptr;
  return asked;
}

void print(const std::string& name, double reference, double got, const char* tolerance) {
  static bool begun = false;
  if (!begun) std::printf("| case | reference | got | tolerance |\n|---|---|---|---|\n");
  begun = true;
  std::printf("| %s | %.5g | %.5g | %s |\n", name.c_str(), reference, got, tolerance);
}

}  // namespace

void verify(const std::string& name, double reference, double got, Tolerance tolerance) {
  if (printing()) {
    char text[32];
    if (tolerance.relative) {
      std::snprintf(text, sizeof text, "%.3g %%", 100.0 * tolerance.size);
    } else {
      std::snprintf(text, sizeof text, "%.3g", tolerance.size);
    }
    print(name, reference, got, text);
  }
  const double allowed = tolerance.relative ? tolerance.size * std::abs(reference) : tolerance.size;
  CAPTURE(name, reference, got, allowed);
  CHECK(std::abs(got - reference) <= allowed);
}

void report(const std::string& name, double reference, double got) {
  if (printing()) print(name, reference, got, "reported");
}

}  // namespace repose::tests
