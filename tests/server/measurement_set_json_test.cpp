#include "server/json/measurement_set_json.hpp"

#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "server/json/csv.hpp"

namespace {

/// Where a table's problems are.
std::vector<std::string> places(const std::string& table) {
  const auto set = repose::server::parse_measurement_table(table, "glass");
  std::vector<std::string> result;
  if (set) return result;
  for (const auto& problem : set.error()) result.push_back(problem.pointer);
  return result;
}

const std::string head = "experiment,observable,value,unit,standard_error\n";
const std::string good = "drop,restitution,0.6,1,0.02\n";
const std::string wrong = "drop,restitution,0.6,furlong,0.02\n";
const std::string long_one = "drop,restitution,0.6,1,0.02,more\n";

}  // namespace

TEST_CASE("a problem of a table names the line on which it stands", "[server]") {
  CHECK(places(head + good).empty());
  CHECK(places(head + wrong) == std::vector<std::string>{"line 2: unit"});
  CHECK(places(head + "\n" + good + "\r\n\n" + wrong) == std::vector<std::string>{"line 6: unit"});
  CHECK(places("\n" + head + "\n" + long_one) == std::vector<std::string>{"line 4"});
  CHECK(places("\n\ncolour,experiment\n").at(0) == "line 3");
}

TEST_CASE("a row begins where its first cell does, and a cell may hold lines", "[server]") {
  const auto rows = repose::server::read_csv("a,\"b\nb\"\n\nc,d\n");
  REQUIRE(rows.size() == 2);
  CHECK(rows[0].line == 1);
  CHECK(rows[0].cells == std::vector<std::string>{"a", "b\nb"});
  CHECK(rows[1].line == 4);
}
