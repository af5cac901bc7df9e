/// Labels: what people call things. On a terminal or in a list of lines a control character would not
/// be what it stands for, so labels that are sent have none. What is stored may have some from before
/// that was checked: whoever reads that does not ask.
#pragma once

#include <string>
#include <string_view>

#include "calibrator/calibration.hpp"
#include "server/json/place.hpp"
#include "server/json/problem.hpp"

namespace repose::server {

/// Complains of a label that would not be printed as it is.
void check_label(const Place& place);

/// Complains of the sources of measurements, which stand at that pointer.
void check_sources(const Json& measurements, const std::string& pointer, ProblemList& problems);

/// What is wrong with the labels of a submission: name, material, and where measurements are from.
Problems problems_of_labels(std::string_view submission);

/// As well of a schedule: its name, and those of its study.
Problems problems_of_schedule_labels(std::string_view schedule);

/// The study with blanks in the place of control characters.
calibrator::Calibration with_clean_labels(calibrator::Calibration study);

}  // namespace repose::server
