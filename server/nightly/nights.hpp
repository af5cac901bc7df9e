/// Nights: what a schedule does at its times. A night takes the schedule's study as it is now;
/// where nothing of it has changed, it is over. Else it holds the promoted fit against it, searches
/// on where that fails, and publishes what came of it:
///
///   unchanged                  nothing of the study has changed since the night before
///   first                      there was no fit before
///   kept                       the promoted fit still holds
///   moved                      another fits better: promoted by the rule (promotion.hpp), or a
///                              candidate that waits for a person
///   model_no_longer_adequate   none fits; a diagnosis says what the model may lack
///
/// Every step is a row before the next begins: a night that was cut off is taken up where it was.
#pragma once

#include <cstdint>
#include <stop_token>
#include <string_view>
#include <vector>

#include "db/schedule_store.hpp"
#include "db/store.hpp"
#include "server/jobs/failure_log.hpp"
#include "server/jobs/workers.hpp"
#include "server/json/schedule_json.hpp"

namespace repose::server {

/// Which schedules a look at the clock begins.
enum class Begin : std::uint8_t {
  due,  ///< those whose time has come
  all,  ///< every one, as if its time were now
};

/// A schedule's document, with the measurements that are kept now where it names a set of them.
engine::Result<NightlySchedule, Problems> read_schedule(db::Store& store,
                                                        std::string_view document);

/// The night of a schedule that is planned and has not begun, its delay still to pass, begins: it is a
/// row, and the next begin_nights() goes on with it. For a change of what is asked, which counts the
/// times from then on.
void keep_planned_night(db::Store& store, const db::ScheduleRecord& record, std::int64_t now);

/// Begins nights and takes up those that were cut off; the calibrations that are to be run for
/// them. A schedule that fails keeps no other one from beginning. `now` is microseconds since 1970
/// UTC.
std::vector<std::int64_t> begin_nights(db::Store& store,
                                       Begin which,
                                       std::int64_t now,
                                       FailureLog& failures);

/// Ends the nights whose calibrations have ended, and their diagnoses where they need one; the
/// diagnoses that are still to be run. A night that fails keeps no other one from its end.
std::vector<std::int64_t> end_nights(db::Store& store,
                                     const WorkerOptions& options,
                                     const std::stop_token& stop,
                                     std::int64_t now,
                                     FailureLog& failures);

}  // namespace repose::server
