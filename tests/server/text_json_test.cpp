#include <string>

#include <catch2/catch.hpp>

#include "server/json/text.hpp"

namespace {

using repose::server::Json;
using repose::server::parse_text;
using repose::server::ProblemList;
using repose::server::Problems;
using repose::server::TextLimits;
using repose::server::to_text;

Problems problems_of(const std::string& text, const TextLimits& limits = {}) {
  ProblemList problems;
  parse_text(text, limits, problems);
  return problems.all();
}

}  // namespace

TEST_CASE("a million nested brackets are one problem, not a crash", "[server]") {
  for (const char* bracket : {"[", "{\"a\":"}) {
    std::string text;
    for (int i = 0; i < 1'000'000; ++i) text += bracket;
    const Problems problems = problems_of(text, {.bytes = text.size()});
    REQUIRE(problems.size() == 1);
    CHECK(problems[0].allowed == "at most 32 levels");
  }
}

TEST_CASE("thirty-two levels are read and thirty-three are not", "[server]") {
  CHECK(problems_of(std::string(32, '[') + std::string(32, ']')).empty());
  CHECK(problems_of(std::string(33, '[') + std::string(33, ']')).size() == 1);
}

TEST_CASE("a member that is there twice is named by its pointer and the first is kept",
          "[server]") {
  ProblemList problems;
  const auto json = parse_text(R"({"a":[{"b":1,"b":2,"b":3}],"c":{"b":1}})", {}, problems);
  REQUIRE(json);
  REQUIRE(problems.all().size() == 2);
  CHECK(problems.all()[0].pointer == "/a/0/b");
  CHECK((*json)["a"][0]["b"] == 1);
}

TEST_CASE("a text that is longer than allowed is refused, as value and as name", "[server]") {
  const std::string longest(64U << 10U, 'x');
  CHECK(problems_of("[\"" + longest + "\"]").empty());
  const Problems value = problems_of("[1, \"" + longest + "x\"]");
  REQUIRE(value.size() == 1);
  CHECK(value[0].pointer == "/1");
  CHECK(problems_of("{\"" + longest + "x\": 1}").size() == 1);
}

TEST_CASE("more values than allowed are refused while they are read", "[server]") {
  std::string text = "[";
  for (int i = 0; i < 100'000; ++i) text += "1,";
  const Problems problems = problems_of(text + "1]");
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].allowed == "at most 100000 values");
}

TEST_CASE("a document that is larger than the caller allows is not read", "[server]") {
  CHECK(problems_of("[1,2,3]", {.bytes = 6}).size() == 1);
  CHECK(problems_of("[1,2,3]", {.bytes = 7}).empty());
}

TEST_CASE("what is no JSON is one problem of the whole document", "[server]") {
  for (const char* text : {"", "{", "[1,]", "nul", "{\"a\" 1}", "[1e400]", "[\"\xff\"]", "1 2"}) {
    const Problems problems = problems_of(text);
    REQUIRE(problems.size() == 1);
    CHECK(problems[0].pointer.empty());
    CHECK(problems[0].message.find("json.exception") == std::string::npos);
  }
}

TEST_CASE("a long wrong text is not sent back whole", "[server]") {
  const Problems problems = problems_of("[\"" + std::string(60'000, 'x'));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].message.size() < 400);
}

TEST_CASE("whole numbers of 64 bits are exact", "[server]") {
  ProblemList problems;
  const auto json = parse_text("[18446744073709551615, -9223372036854775808]", {}, problems);
  REQUIRE(json);
  CHECK(to_text(*json) == "[18446744073709551615,-9223372036854775808]");
}

TEST_CASE("a pointer escapes what it uses itself", "[server]") {
  CHECK(repose::server::pointer_to("/a", "b/c~d") == "/a/b~1c~0d");
}

TEST_CASE("a hundred problems stand for all that follow", "[server]") {
  ProblemList problems;
  for (int i = 0; i < 150; ++i) problems.add({"", "wrong", "", ""});
  REQUIRE(problems.all().size() == 101);
  CHECK(problems.all().back().message == "50 more problems are not listed");
}
