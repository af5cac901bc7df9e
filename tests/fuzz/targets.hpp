/// What is thrown at the readers of everything that comes from outside, and what must hold whatever
/// that is: no crash, and what was read and printed reads back as the same. Kept inputs
/// are in each target's folder: what has found something goes there.
#pragma once

#include <array>
#include <chrono>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "server/api/request_reader.hpp"
#include "server/json/attempt_json.hpp"
#include "server/json/calibration_json.hpp"
#include "server/json/evaluation_json.hpp"
#include "server/json/measurement_set_json.hpp"
#include "server/nightly/cron.hpp"

namespace repose::tests {

/// Throws where something does not hold: a fuzzer takes that for a crash, a test for a failure.
inline void require(bool holds, const char* what) {
  if (!holds) throw std::logic_error(what);
}

inline void fuzz_study(std::string_view input) {
  const auto read = server::parse_calibration(input);
  if (!read) {
    require(!read.error().empty(), "a study is refused without a problem");
    return;
  }
  const std::string printed = server::print_calibration(*read);
  const auto again = server::parse_calibration(printed);
  require(again.has_value(), "a study that was read and printed is refused");
  require(server::print_calibration(*again) == printed, "a study reads back as another");
}

inline void fuzz_table(std::string_view input) {
  const auto read = server::parse_measurement_table(input, "soybean");
  if (!read) {
    require(!read.error().empty(), "a table is refused without a problem");
    return;
  }
  const std::string table =
      server::print_measurement_table({1, "set", 1, "soybean", 0, read->measurements});
  const auto again = server::parse_measurement_table(table, "soybean");
  require(again.has_value(), "a table that was read and printed is refused");
  require(again->measurements == read->measurements, "a table reads back as another");
}

inline void fuzz_cron(std::string_view input) {
  const auto cron = server::parse_cron(input);
  if (!cron) {
    require(!cron.error().empty(), "a time is refused without a problem");
    return;
  }
  const std::chrono::local_seconds from{std::chrono::seconds(1'790'000'000)};
  const auto first = server::first_from(*cron, from);
  if (!first) return;
  require(*first >= from, "the next time is in the past");
  require(server::first_from(*cron, *first) == first, "a time is not its own next");
}

/// In two parts: where a request is cut must not matter.
inline void fuzz_request(std::string_view input) {
  static const std::vector<std::string> names;
  using Progress = server::RequestReader::Progress;
  const auto read = [](std::string_view first, std::string_view second) {
    server::RequestReader reader(names);
    std::string seen;
    for (const std::string_view part : {first, second}) {
      reader.append(part);
      for (auto progress = reader.advance(); progress == Progress::whole;
           progress = reader.advance()) {
        seen += reader.take().text + "\n--\n";
      }
      if (reader.progress() == Progress::refused) {
        return seen + std::to_string(reader.refusal().status);
      }
    }
    return seen;
  };
  require(
      read(input, "") == read(input.substr(0, input.size() / 2), input.substr(input.size() / 2)),
      "a request that comes in two parts is another");
}

inline void fuzz_answer(std::string_view input) {
  const auto answer = server::parse_attempt_answer(input);
  if (answer) static_cast<void>(server::parse_answer({}, answer->answer));
  static_cast<void>(server::parse_question(input));
}

struct FuzzTarget {
  std::string_view kept;  ///< the folder of its kept inputs
  void (*run)(std::string_view input);
};

inline constexpr std::array<FuzzTarget, 5> fuzz_targets{
    {{"schemas/examples", fuzz_study},
     {"tests/fuzz/corpus/table", fuzz_table},
     {"tests/fuzz/corpus/cron", fuzz_cron},
     {"tests/fuzz/corpus/request", fuzz_request},
     {"tests/fuzz/corpus/answer", fuzz_answer}}};

}  // namespace repose::tests
