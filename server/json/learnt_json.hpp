/// What a fit has learnt, as parts of its document: directions, the posterior's samples, what to
/// measure next. The readers throw where a part is none of ours; documents of earlier programs lack
/// some, which are then empty.
#pragma once

#include <vector>

#include "calibrator/calibration.hpp"
#include "calibrator/fit.hpp"
#include "server/json/text.hpp"

namespace repose::server {

Json print_directions(const calibrator::Calibration& calibration,
                      const std::vector<calibrator::Direction>& directions);
std::vector<calibrator::Direction> read_directions(const Json& fit);

/// Five digits are kept of a sample.
Json print_posterior(const calibrator::Calibration& calibration,
                     const calibrator::Posterior& posterior);
calibrator::Posterior read_posterior(const calibrator::Calibration& calibration, const Json& fit);

Json print_next(const calibrator::Calibration& calibration,
                const std::vector<calibrator::NextMeasurement>& next);
std::vector<calibrator::NextMeasurement> read_next(const calibrator::Calibration& calibration,
                                                   const Json& fit);

}  // namespace repose::server
