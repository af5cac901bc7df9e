/// Cron: when something is to be done, as crontab(5) writes it: "minute hour day month weekday".
///
/// Each field is *, a number, a range 1-5, any of these with a step */15, or several with commas.
/// Months and weekdays have names (jan, mon); Sunday is 0 and 7. Where day and weekday are both
/// restricted, a day that satisfies either is one.
#pragma once

#include <bitset>
#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "engine/result.hpp"

namespace repose::server {

struct Cron {
  std::bitset<60> minutes;
  std::bitset<24> hours;
  std::bitset<32> days;  ///< 1 to 31
  std::bitset<13> months;
  std::bitset<8> weekdays;  ///< from Sunday, 0
  bool every_day = true;    ///< the day field begins with *
  bool every_weekday = true;

  bool operator==(const Cron&) const = default;
};

/// The error is a sentence that names the field.
engine::Result<Cron, std::string> parse_cron(std::string_view text);

/// The first minute from `from` on; nothing where there is none in the eight years in which every
/// date of the calendar comes once.
std::optional<std::chrono::local_seconds> first_from(const Cron& cron,
                                                     std::chrono::local_seconds from);

}  // namespace repose::server
