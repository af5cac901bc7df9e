#include "server/report/study_words.hpp"

#include <algorithm>
#include <cmath>

#include "server/report/number_text.hpp"

namespace repose::server {

std::string sample_text(const Sample& sample) {
  if (sample.values.empty()) return sample.failed > 0 ? "failed" : "-";
  std::string text = fixed_text(sample.mean(), 1);
  if (sample.values.size() > 1) text += " (" + fixed_text(sample.deviation(), 1) + ")";
  return sample.failed > 0 ? text + " *" : text;
}

std::string published_text(const PublishedNumber& number) {
  return fixed_text(number.mean, 1) + " (" + fixed_text(number.deviation, 1) + ")";
}

std::string trend_text(const Trend& trend) {
  if (!trend.agrees) return "-";
  return std::string(*trend.agrees ? "agrees" : "opposite") + (trend.clear() ? "" : "?");
}

std::string known_text(double value, int decimals) {
  return std::isnan(value) ? "-" : fixed_text(value, decimals);
}

std::string signed_text(double value, int decimals) {
  const std::string text = known_text(value, decimals);
  const bool is_zero = text.find_first_of("123456789") == std::string::npos;
  return value > 0.0 && !is_zero ? "+" + text : text;
}

std::string observable_text(const StudyExperiment& what) {
  std::string text = what.observable;
  std::ranges::replace(text, '_', ' ');
  return text;
}

}  // namespace repose::server
