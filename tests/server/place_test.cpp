#include "server/json/place.hpp"

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include <catch2/catch.hpp>

namespace {

using repose::server::Json;
using repose::server::Place;
using repose::server::ProblemList;

constexpr std::int64_t least = std::numeric_limits<std::int64_t>::min();
constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();

/// The whole number of a text, in its bounds; nothing where it is refused.
std::optional<std::int64_t> whole(const std::string& text,
                                  std::int64_t from = least,
                                  std::int64_t to = most) {
  ProblemList problems;
  const Json json = Json::parse(text);
  const auto value = Place(&json, "", problems).whole(from, to);
  CHECK(problems.all().empty() == value.has_value());
  return value;
}

}  // namespace

TEST_CASE("whole numbers are exact as far as 64 bits reach, and refused beyond", "[server]") {
  CHECK(whole("9223372036854775807") == most);
  CHECK(whole("-9223372036854775808") == least);
  CHECK(whole("9007199254740993") == 9007199254740993);  // 2^53 + 1: no double
  for (const char* beyond :
       {"9223372036854775808", "18446744073709551615", "18446744073709551616", "1e300"}) {
    CHECK_FALSE(whole(beyond));
  }
}

TEST_CASE("a whole number keeps its bounds exactly", "[server]") {
  constexpr std::int64_t bound = (std::int64_t{1} << 53) + 1;
  CHECK(whole("9007199254740993", 0, bound) == bound);
  CHECK_FALSE(whole("9007199254740994", 0, bound));
  CHECK_FALSE(whole("-1", 0, bound));
}

TEST_CASE("a whole number may have a point or an exponent, up to where each is exact", "[server]") {
  CHECK(whole("4.0") == 4);
  CHECK(whole("4e2") == 400);
  CHECK(whole("9007199254740992.0") == 9007199254740992);
  for (const char* text : {"4.5", "9007199254740994.0", "9223372036854775808.0", "-1e19"}) {
    CHECK_FALSE(whole(text));
  }
}
