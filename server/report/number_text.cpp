#include "server/report/number_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace repose::server {

namespace {

int magnitude(double value) {  // of the first digit; 0 of what has none
  if (value == 0.0 || !std::isfinite(value)) return 0;
  return static_cast<int>(std::floor(std::log10(std::abs(value))));
}

}  // namespace

std::string fixed_text(double value, int decimals) {
  std::array<char, 64> buffer{};
  const int length = std::snprintf(buffer.data(), buffer.size(), "%.*f", decimals, value);
  std::string text(buffer.data(), static_cast<std::size_t>(std::clamp(length, 0, 63)));
  const bool is_zero = text.find_first_of("123456789") == std::string::npos;
  return is_zero && text.starts_with('-') ? text.substr(1) : text;
}

std::string number_text(double value, int significant) {
  if (std::isnan(value)) return "-";
  const int power = magnitude(value);
  if (!std::isfinite(value) || power > 6 || power < -4) {
    std::array<char, 64> buffer{};
    std::snprintf(buffer.data(), buffer.size(), "%.*g", significant, value);
    return buffer.data();
  }
  std::string text = fixed_text(value, std::max(0, significant - 1 - power));
  if (text.find('.') == std::string::npos) return text;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text;
}

int decimals_for(double value, double error) {
  constexpr int most = 9;
  if (error > 0.0 && std::isfinite(error)) return std::clamp(1 - magnitude(error), 0, most);
  if (!std::isfinite(value)) return 0;
  return std::clamp(3 - magnitude(value), 0, most);
}

std::string with_error(double value, double error, const engine::Unit& unit) {
  if (std::isnan(value)) return "-";
  const double shown = value / unit.factor, shown_error = error / unit.factor;
  const int decimals = decimals_for(shown, shown_error);
  std::string text = fixed_text(shown, decimals);
  if (error > 0.0) text += " ± " + fixed_text(shown_error, decimals);
  return text + unit_suffix(unit);
}

std::string unit_suffix(const engine::Unit& unit) {
  return unit.symbol == "1" ? std::string() : " " + std::string(unit.symbol);
}

std::string duration_text(double seconds) {
  if (seconds < 60.0) return fixed_text(seconds, seconds < 9.95 ? 1 : 0) + " s";
  const auto whole = static_cast<long>(std::lround(seconds));
  if (whole < 3600) return std::to_string(whole / 60) + " min " + std::to_string(whole % 60) + " s";
  return std::to_string(whole / 3600) + " h " + std::to_string(whole % 3600 / 60) + " min";
}

std::string count_text(unsigned long long count) {
  std::string text = std::to_string(count);
  for (std::size_t i = text.size(); i > 3; i -= 3) text.insert(i - 3, " ");
  return text;
}

std::vector<Tick> ticks(double lower, double upper, int wanted) {
  if (!(upper > lower)) return {{lower, number_text(lower)}};
  const double rough = (upper - lower) / wanted;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  const double share = rough / power;
  const double nice = share < 1.5 ? 1.0 : share < 3.5 ? 2.0 : share < 7.5 ? 5.0 : 10.0;
  const double step = nice * power;
  const int decimals = std::max(0, -magnitude(step));
  std::vector<Tick> places;
  const auto first = static_cast<long long>(std::ceil(lower / step - 1e-9));
  const auto last = static_cast<long long>(std::floor(upper / step + 1e-9));
  for (long long i = first; i <= last; ++i) {
    const double place = static_cast<double>(i) * step;
    places.push_back({place, fixed_text(place, decimals)});
  }
  return places;
}

}  // namespace repose::server
