#include "server/nightly/timetable.hpp"

#include <algorithm>

#include "engine/random.hpp"

namespace repose::server {

using std::chrono::seconds;
using std::chrono::sys_seconds;

std::optional<sys_seconds> next_after(const Timetable& timetable, sys_seconds time) {
  // Later local times are never earlier instants, so the search may begin at the local time now.
  std::chrono::local_seconds from = timetable.zone.local(time);
  while (const auto local = first_from(timetable.cron, from)) {
    const sys_seconds instant = timetable.zone.instant(*local);
    if (instant > time) return instant;
    from = *local + std::chrono::minutes(1);
  }
  return std::nullopt;
}

seconds delay(const Timetable& timetable, std::int64_t schedule, sys_seconds planned) {
  if (timetable.jitter <= seconds(0)) return seconds(0);
  engine::Random random(static_cast<std::uint64_t>(schedule),
                        engine::Purpose::trial,
                        static_cast<std::uint64_t>(planned.time_since_epoch().count()));
  const auto span = static_cast<std::uint64_t>(timetable.jitter.count()) + 1;
  return seconds(static_cast<std::int64_t>(random.bits() % span));
}

std::optional<Due> due(const Timetable& timetable,
                       std::int64_t schedule,
                       sys_seconds since,
                       sys_seconds now) {
  constexpr int most_missed = 1000;
  std::optional<Due> latest;
  // After a long absence only what may still be run is looked at one by one.
  const auto recent = now - timetable.catch_up - timetable.jitter - std::chrono::hours(48);
  for (auto planned = next_after(timetable, since); planned;
       planned = next_after(timetable, *planned)) {
    if (*planned + delay(timetable, schedule, *planned) > now) break;
    const int missed = latest ? std::min(latest->missed + 1, most_missed) : 0;
    latest = Due{*planned, missed, now - *planned > timetable.catch_up + timetable.jitter};
    if (missed == most_missed && *planned < recent) planned = recent;
  }
  return latest;
}

}  // namespace repose::server
