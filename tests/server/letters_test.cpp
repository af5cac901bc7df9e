#include "server/letters.hpp"

#include <catch2/catch.hpp>

using namespace repose;

TEST_CASE("a heading in a sentence begins small, but an abbreviation stays as it is", "[server]") {
  CHECK(server::lower_first("Grain shape") == "grain shape");
  CHECK(server::lower_first("JKR adhesion") == "JKR adhesion");
  CHECK(server::lower_first("air drag") == "air drag");
  CHECK(server::lower_first("G") == "g");
  CHECK(server::lower_first("").empty());
}
