#include "calibrator/diagnosis/verdict.hpp"

#include <string>

#include <catch2/catch.hpp>

using namespace repose;
using namespace repose::calibrator;

namespace {

/// Nothing beyond chance, and one effect that no data of this kind would show.
Diagnosis quiet(double freedom) {
  Diagnosis diagnosis;
  diagnosis.p_named = 0.6;
  diagnosis.p_misfit = 0.82;
  diagnosis.freedom = freedom;
  diagnosis.effects.emplace_back().status = EffectStatus::not_testable;
  conclude({}, "", diagnosis);
  return diagnosis;
}

bool says(const Diagnosis& diagnosis, const std::string& words) {
  return diagnosis.sentence.find(words) != std::string::npos;
}

/// One effect refitted, far better than the best excuse.
Diagnosis found(const std::string& sole_witness) {
  Diagnosis diagnosis;
  diagnosis.p_named = 0.0;
  diagnosis.effects.emplace_back().suspect.title = "Air drag";
  Refit& refit = diagnosis.refits.emplace_back();
  refit.effects = {0};
  refit.p = 0.5;
  diagnosis.excuses.emplace_back().deviance = 100.0;
  conclude({}, sole_witness, diagnosis);
  return diagnosis;
}

}  // namespace

TEST_CASE("that the parameters follow anything is said only where nothing is left to test",
          "[calibrator]") {
  const Diagnosis followed = quiet(0.0);
  CHECK(followed.verdict == DiagnosisVerdict::not_testable);
  CHECK(says(followed, "whatever they say"));

  const Diagnosis fitting = quiet(4.0);
  CHECK(fitting.verdict == DiagnosisVerdict::not_testable);
  CHECK_FALSE(says(fitting, "whatever they say"));
  CHECK(says(fitting, "The model fits these data (p 0.82)"));
  CHECK(says(fitting, "none of the effects would show"));
}

TEST_CASE("what one apparatus alone asks for is never surely named", "[calibrator]") {
  CHECK(found("").grade == Grade::a);
  const Diagnosis diagnosis = found("drop");
  CHECK(diagnosis.verdict == DiagnosisVerdict::named);
  CHECK(diagnosis.grade == Grade::b);
  CHECK(says(diagnosis, "one apparatus alone ask for it (drop)"));
}
