/// Drift: whether a quantity that is estimated anew each night has moved: a control chart of an
/// exponentially weighted moving average that needs no history to begin with.
///
///   q_n = (x_n - m_n) / sqrt(s_n^2 + v_n),    1 / v_n = sum_{i<n} 1 / s_i^2,
///   m_n = v_n sum_{i<n} x_i / s_i^2,          e_n = (1 - w) e_{n-1} + w q_n,   e_1 = 0
///   alarm: |e_n| > L sqrt(w / (2 - w)),       after which the chart begins anew with x_{n+1}
///
///   x_n  the n-th estimate   s_n  its standard error   w  weight   L  limit
///
/// Where nothing moves, the q_n are independent and standard normal, so the mean number of points
/// to a false alarm follows from w and L alone; L is chosen for the number that is stated.
/// Source: Quesenberry 1991, J. Quality Technology 23, 213-224 (q_n); Roberts 1959, Technometrics
///         1, 239-250 (e_n); Brook & Evans 1972, Biometrika 59, 539-549 (run length as a Markov
///         chain); w = 0.2 is a usual choice for shifts of about one standard deviation (Lucas &
///         Saccucci 1990, Technometrics 32, 1-12).
#pragma once

namespace repose::server {

inline constexpr double drift_weight = 0.2;

/// On average one false alarm in so many nights, over all charts of a schedule together.
inline constexpr double nights_to_false_alarm = 1000.0;

struct Estimate {
  double value = 0.0;
  double standard_error = 0.0;
};

/// A chart after its last point: all that the next one needs.
struct Drift {
  int points = 0;          ///< since the chart began, or began anew
  double centre = 0.0;     ///< m_{n+1}: the mean of these
  double precision = 0.0;  ///< 1 / v_{n+1}
  double level = 0.0;      ///< e_n
  double limit = 0.0;      ///< of |e_n|
  bool alarm = false;      ///< at the last point
};

/// The chart after one more point, with the limit L.
Drift advance(const Drift& before, const Estimate& point, double limit);

/// Mean number of points to a false alarm, zero start.
double run_length(double limit);

/// L for a mean run length.
double limit_for(double run_length);

}  // namespace repose::server
