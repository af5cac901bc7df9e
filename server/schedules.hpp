/// Schedules: the use cases around calibrations that the clock repeats. What a night does is in
/// server/nightly/.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "db/store.hpp"
#include "server/service.hpp"

namespace repose::server {

/// Keeps a schedule (schemas/schedule.schema.json); the answer is its document, with where it
/// stands. `now` is microseconds since 1970 UTC.
Answer<std::string> add_schedule(db::Store& store, std::string_view document, std::int64_t now);
/// Puts another in its place: nights and promotions stay.
Answer<std::string> replace_schedule(db::Store& store,
                                     std::int64_t id,
                                     std::string_view document,
                                     std::int64_t now);
/// No night begins any more; its history stays.
Answer<std::string> remove_schedule(db::Store& store, std::int64_t id, std::int64_t now);

/// The document, with "next_at", "promoted", "last_night" and the "fit" in force.
Answer<std::string> schedule(db::Store& store, std::int64_t id, std::int64_t now);
/// {"items":[...without study and fit...]}
std::string schedules(db::Store& store, std::int64_t now);
/// {"items","next"}, newest first.
Answer<Page> nights(db::Store& store,
                    std::int64_t id,
                    int limit,
                    std::optional<std::int64_t> before);

/// Where the charts of all schedules stand.
std::vector<DriftFigure> drift_figures(const db::Store& store);

/// {"items"}: which fit was in force from when on, newest first.
Answer<std::string> promotions(db::Store& store, std::int64_t id);
/// {"calibration": N}: puts a fit of this schedule in force by hand, a candidate or an earlier one.
Answer<std::string> promote(db::Store& store,
                            std::int64_t id,
                            std::string_view document,
                            std::int64_t now);

}  // namespace repose::server
