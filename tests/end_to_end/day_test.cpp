// The transcript of a user's day is still what happens.
#include <cstdlib>

#include <catch2/catch.hpp>

#include "tests/support/not_tried.hpp"
#include "tests/support/program.hpp"

TEST_CASE("a user's day goes as its transcript expects", "[end_to_end][slow]") {
  if (std::system("command -v curl > /dev/null") != 0) {
    repose::tests::not_tried("curl is not installed");
    return;
  }
  const std::string day = "'" REPOSE_SOURCE_DIR "/tests/end_to_end/day.sh' '";
  CHECK(std::system((day + repose::tests::repose_program + "' > /dev/null").c_str()) == 0);
}
