/// Count: how often something happened among so many cases, with its confidence limits.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ostream>
#include <string_view>

namespace repose {

struct Count {
  int hits = 0;
  int cases = 0;

  void add(bool hit) {
    hits += hit ? 1 : 0;
    ++cases;
  }
  [[nodiscard]] double share() const { return cases > 0 ? static_cast<double>(hits) / cases : 0.0; }
};

/// "12 of 200 = 6.0 % (3.5 to 10.2)": 95 % (Wilson 1927, J. Am. Stat. Assoc. 22, 209-212).
inline std::ostream& operator<<(std::ostream& out, const Count& count) {
  const double n = count.cases, p = count.share(), z2 = 1.96 * 1.96;
  const auto tenths = [](double share) { return std::round(1000.0 * share) / 10.0; };
  out << count.hits << " of " << count.cases << " = " << tenths(p) << " %";
  if (count.cases == 0) return out;
  const double middle = p + z2 / (2.0 * n);
  const double reach = 1.96 * std::sqrt(p * (1.0 - p) / n + z2 / (4.0 * n * n));
  return out << " (" << tenths(std::max(0.0, (middle - reach) / (1.0 + z2 / n))) << " to "
             << tenths((middle + reach) / (1.0 + z2 / n)) << ")";
}

/// The fewest hits that a rate is exceeded by with a chance of about 1.2 %: the limit of a test
/// whose true rate is `rate`.
inline int limit_of(int cases, double rate) {
  double term = std::pow(1.0 - rate, cases), sum = term;
  int k = 0;
  while (sum < 0.987 && k < cases) {
    ++k;
    term *= rate / (1.0 - rate) * (cases - k + 1) / k;
    sum += term;
  }
  return k;
}

/// Whether REPOSE_ACCEPTANCE=full asks for the acceptance table at its full size.
inline bool in_full() {
  const char* asked = std::getenv("REPOSE_ACCEPTANCE");
  return asked != nullptr && std::string_view(asked) == "full";
}

inline int cases_of(int full, int few) { return in_full() ? full : few; }

/// At least that share: as it stands in the full table; of a few cases, not below it by more than
/// chance (1.2 %).
inline bool at_least(const Count& count, double share) {
  if (in_full()) return count.share() >= share;
  return count.cases - count.hits <= limit_of(count.cases, 1.0 - share);
}
inline bool at_most(const Count& count, double share) {
  if (in_full()) return count.share() <= share;
  return count.hits <= limit_of(count.cases, share);
}

}  // namespace repose
