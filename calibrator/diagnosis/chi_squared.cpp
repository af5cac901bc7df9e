#include "calibrator/diagnosis/chi_squared.hpp"

#include <unsupported/Eigen/SpecialFunctions>

namespace repose::calibrator {

double chi_squared_tail(double value, double freedom) {
  if (!(freedom > 0.0)) return 1.0;  // as many parameters as data: nothing can be said
  if (value <= 0.0) return 1.0;
  return Eigen::numext::igammac(0.5 * freedom, 0.5 * value);
}

}  // namespace repose::calibrator
