/// Axis: from values to pixels along one side of a chart.
#pragma once

#include <cmath>

namespace repose::server {

struct Axis {
  double lower, upper;       ///< values
  double from, to;           ///< pixels
  bool logarithmic = false;  ///< then all values are above zero

  double operator()(double value) const {
    const double share = logarithmic ? std::log(value / lower) / std::log(upper / lower)
                                     : (value - lower) / (upper - lower);
    return from + (to - from) * share;
  }
};

}  // namespace repose::server
