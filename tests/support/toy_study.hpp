/// The analytic studies of the bench, under the name that the tests know them by.
#pragma once

#include "calibrator/bench/analytic_study.hpp"

namespace repose::toy {

using namespace calibrator::bench;
using Study = AnalyticStudy;
using calibrator::UnitPoint;

}  // namespace repose::toy
