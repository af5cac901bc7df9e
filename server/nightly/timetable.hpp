/// Timetable: the instants at which a schedule's nights are planned, and which of them is due.
///
/// A local time that the clocks skip is planned for the moment after the gap; one that they show
/// twice, for the first. So there is one night a day across both clock changes.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "server/nightly/cron.hpp"
#include "server/nightly/time_zone.hpp"

namespace repose::server {

struct Timetable {
  Cron cron;
  TimeZone zone;
  std::chrono::seconds jitter{0};        ///< a night begins up to that much after it was planned
  std::chrono::seconds catch_up{43200};  ///< one that is later than that is not run any more
};

/// The first planned instant after `time`; nothing where there is none in eight years.
std::optional<std::chrono::sys_seconds> next_after(const Timetable& timetable,
                                                   std::chrono::sys_seconds time);

/// How much after its time a night begins: evenly spread over the jitter, always the same for the
/// same night, so that many schedules do not begin at once.
std::chrono::seconds delay(const Timetable& timetable,
                           std::int64_t schedule,
                           std::chrono::sys_seconds planned);

/// The night to run now: the latest planned one that was not run, whatever was missed before it.
struct Due {
  std::chrono::sys_seconds planned;
  int missed = 0;         ///< planned ones before it that nobody ran; counted up to 1000
  bool too_late = false;  ///< by more than `catch_up`
};

/// `since`: the planned instant of the last night, or when the schedule was made.
std::optional<Due> due(const Timetable& timetable,
                       std::int64_t schedule,
                       std::chrono::sys_seconds since,
                       std::chrono::sys_seconds now);

}  // namespace repose::server
