/// TimeZone: local time of a place <-> instants, by the system's time zone database (tzdata).
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

namespace date {
class time_zone;
}  // namespace date

namespace repose::server {

class TimeZone {
 public:
  /// By its IANA name, such as Europe/Berlin; nothing where the database does not have it.
  static std::optional<TimeZone> find(std::string_view name);

  [[nodiscard]] std::string name() const;
  [[nodiscard]] std::chrono::local_seconds local(std::chrono::sys_seconds instant) const;
  /// The first instant at which clocks there show that time or, where they skip it, a later one.
  [[nodiscard]] std::chrono::sys_seconds instant(std::chrono::local_seconds local) const;

 private:
  explicit TimeZone(const date::time_zone* zone) : zone_(zone) {}
  const date::time_zone* zone_;  ///< of the database, which outlives everything
};

}  // namespace repose::server
