#include "server/nightly/cron.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <span>
#include <vector>

#include "server/letters.hpp"

namespace repose::server {

namespace {

using namespace std::chrono;

constexpr std::array<std::string_view, 12> month_names{
    "jan", "feb", "mar", "apr", "may", "jun", "jul", "aug", "sep", "oct", "nov", "dec"};
constexpr std::array<std::string_view, 7> weekday_names{
    "sun", "mon", "tue", "wed", "thu", "fri", "sat"};

struct Field {
  std::string_view name;
  int least;
  int most;
  std::span<const std::string_view> names = {};  ///< of the values from `least` on
};

constexpr std::array<Field, 5> fields{{{"minute", 0, 59},
                                       {"hour", 0, 23},
                                       {"day of month", 1, 31},
                                       {"month", 1, 12, month_names},
                                       {"day of week", 0, 7, weekday_names}}};

std::vector<std::string_view> split(std::string_view text, std::string_view separators) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find_first_of(separators, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

std::optional<int> whole(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || value < 0) return std::nullopt;
  return value;
}

std::optional<int> value_of(const Field& field, std::string_view text) {
  const auto named = std::ranges::find(field.names, lower_case(text));
  if (named != field.names.end()) {
    return field.least + static_cast<int>(named - field.names.begin());
  }
  const auto value = whole(text);
  if (!value || *value < field.least || *value > field.most) return std::nullopt;
  return value;
}

/// Marks what an item such as 1-5/2 names; false where it names nothing.
bool mark(const Field& field, std::string_view item, std::bitset<60>& into) {
  const std::size_t slash = item.find('/');
  const auto step =
      slash == std::string_view::npos ? std::optional(1) : whole(item.substr(slash + 1));
  const std::string_view range = item.substr(0, slash);
  const std::size_t dash = range.find('-');
  auto first = std::optional(field.least);
  auto last = std::optional(field.most);
  if (range != "*") {
    first = value_of(field, range.substr(0, dash));
    if (dash != std::string_view::npos) {
      last = value_of(field, range.substr(dash + 1));
    } else if (slash == std::string_view::npos) {
      last = first;
    }
  }
  if (!step || *step < 1 || !first || !last || *first > *last) return false;
  for (int value = *first; value <= *last; value += *step) {
    into.set(static_cast<std::size_t>(value));
    if (*step > field.most) break;
  }
  return true;
}

std::string complaint(const Field& field, std::string_view found) {
  std::string text = "the " + std::string(field.name) + " is \"" +
                     std::string(found.substr(0, 40)) + "\"; allowed are *, numbers from " +
                     std::to_string(field.least) + " to " + std::to_string(field.most);
  if (!field.names.empty()) {
    text += " or names (" + std::string(field.names.front()) + " to " +
            std::string(field.names.back()) + ")";
  }
  return text + ", ranges 1-5, steps */2 and lists 1,3,5";
}

template <std::size_t size>
std::bitset<size> narrowed(const std::bitset<60>& bits) {
  return std::bitset<size>(bits.to_ullong());
}

bool has_day(const Cron& cron, sys_days date) {
  const year_month_day day(date);
  if (!cron.months[static_cast<unsigned>(day.month())]) return false;
  const bool of_month = cron.days[static_cast<unsigned>(day.day())];
  const bool of_week = cron.weekdays[weekday(date).c_encoding()];
  if (cron.every_day || cron.every_weekday) return of_month && of_week;
  return of_month || of_week;
}

}  // namespace

engine::Result<Cron, std::string> parse_cron(std::string_view text) {
  std::vector<std::string_view> words = split(text.substr(0, 1000), " \t");
  std::erase(words, "");
  if (words.size() != fields.size()) {
    return engine::Unexpected{
        "a cron expression has five fields, minute hour day month weekday, "
        "such as \"30 2 * * *\"; found " +
        std::to_string(words.size())};
  }
  std::array<std::bitset<60>, fields.size()> marked;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    for (const std::string_view item : split(words[i], ",")) {
      if (!mark(fields[i], item, marked[i])) {
        return engine::Unexpected{complaint(fields[i], words[i])};
      }
    }
  }
  if (marked[4][7]) marked[4].set(0);
  return Cron{.minutes = marked[0],
              .hours = narrowed<24>(marked[1]),
              .days = narrowed<32>(marked[2]),
              .months = narrowed<13>(marked[3]),
              .weekdays = narrowed<8>(marked[4]),
              .every_day = words[2].front() == '*',
              .every_weekday = words[4].front() == '*'};
}

std::optional<local_seconds> first_from(const Cron& cron, local_seconds from) {
  const local_seconds begin = ceil<minutes>(from);
  const local_days first_day = floor<days>(begin);
  for (local_days day = first_day; day < first_day + days(8 * 366); day += days(1)) {
    if (!has_day(cron, sys_days(day.time_since_epoch()))) continue;
    for (std::size_t hour = 0; hour < cron.hours.size(); ++hour) {
      if (!cron.hours[hour] || day + hours(hour + 1) <= begin) continue;
      for (std::size_t minute = 0; minute < cron.minutes.size(); ++minute) {
        const local_seconds time = day + hours(hour) + minutes(minute);
        if (cron.minutes[minute] && time >= begin) return time;
      }
    }
  }
  return std::nullopt;
}

}  // namespace repose::server
