#include "calibrator/diagnosis/tolerated.hpp"

#include <vector>

#include "calibrator/comparison.hpp"
#include "calibrator/diagnosis/models.hpp"
#include "calibrator/diagnosis/question.hpp"
#include "calibrator/phrase.hpp"
#include "calibrator/remarks.hpp"

namespace repose::calibrator {

std::optional<Tolerated> tolerated(const Calibration& calibration,
                                   const Fit& fit,
                                   const Tolerances& stated) {
  DiagnosisQuestion question = question_of(calibration, fit, stated);
  question.suspects.clear();
  const Evaluator nothing;  // is asked
  const SuiteRuns runs(calibration, question.suspects, nothing, fit);
  const Models models(question, runs);
  if (!models.knows_all_fitted()) return std::nullopt;
  const Model model = models.fit_calibrated();
  const std::size_t dimensions = runs.space().dimensions();
  return Tolerated{
      runs.space().at(UnitPoint(model.fit.at.data(), model.fit.at.data() + dimensions)),
      model.fit.misfit,
      model.fit.freedom,
      models.misfit_p(model.fit, model.space)};
}

std::string sentence_of(const Calibration& calibration, const Tolerated& tolerated) {
  const std::string chance = " (p " + number(tolerated.p, 2) + ")";
  if (tolerated.p < unlikely) {
    return "Nor do its runs promise any set of this model that fits within the tolerances" +
           chance + ".";
  }
  std::vector<std::string> values;
  for (const FreeParameter& parameter : calibration.free) {
    const double value = tolerated.parameters.get_or(parameter.key, 0.0);
    values.push_back(parameter_name(parameter.key) + " " + quantity(value, parameter.unit, 3));
  }
  return "The best set follows the laboratory's errors alone. Within the tolerances its runs "
         "promise a set of the same model that fits" +
         chance + ": " + enumerate(values) +
         ". To calibrate for it, let the study's measurements have \"allowance\": \"tolerance\".";
}

}  // namespace repose::calibrator
