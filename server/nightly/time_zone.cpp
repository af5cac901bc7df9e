#include "server/nightly/time_zone.hpp"

#include <date/tz.h>
#include <stdexcept>

namespace repose::server {

std::optional<TimeZone> TimeZone::find(std::string_view name) {
  try {
    return TimeZone(date::locate_zone(name));
  } catch (const std::runtime_error&) {
    return std::nullopt;  // its only way to say that there is none
  }
}

std::string TimeZone::name() const { return zone_->name(); }

std::chrono::local_seconds TimeZone::local(std::chrono::sys_seconds instant) const {
  return std::chrono::local_seconds(zone_->to_local(instant).time_since_epoch());
}

std::chrono::sys_seconds TimeZone::instant(std::chrono::local_seconds local) const {
  const date::local_seconds there(local.time_since_epoch());
  const date::local_info info = zone_->get_info(there);
  // Clocks jump from the end of the first period to the beginning of the second.
  if (info.result == date::local_info::nonexistent) return info.second.begin;
  return std::chrono::sys_seconds(local.time_since_epoch() - info.first.offset);
}

}  // namespace repose::server
