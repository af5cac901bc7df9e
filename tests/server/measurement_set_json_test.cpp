#include "server/json/measurement_set_json.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "server/json/csv.hpp"
#include "server/json/labels.hpp"
#include "server/json/own_material_json.hpp"

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

TEST_CASE("a table with another separator is told which it has and which is expected", "[server]") {
  for (const auto& [separator, name] : {std::pair{';', "semicolons"}, std::pair{'\t', "tabs"}}) {
    std::string table = head + good;
    std::ranges::replace(table, ',', separator);
    const auto set = repose::server::parse_measurement_table(table, "glass");
    REQUIRE_FALSE(set);
    REQUIRE(set.error().size() == 1);
    CHECK(set.error()[0].pointer == "line 1");
    CHECK(set.error()[0].message == "the cells are separated by " + std::string(name));
    CHECK(set.error()[0].allowed.starts_with("commas"));
  }
}

TEST_CASE("the empty cells that spreadsheets leave are no cells", "[server]") {
  const std::string wider = "experiment,observable,value,unit,standard_error,, \r\n";
  CHECK(places(wider + "drop,restitution,0.6,1,0.02,,\r\n,,,,,,\r\n").empty());
  CHECK(places(wider + ",,,,,,\r\n" + wrong) == std::vector<std::string>{"line 3: unit"});
  CHECK(places(",,,\n") == std::vector<std::string>{"line 1"});
  CHECK(places(wider + "drop,restitution,0.6,1,0.02,,more\n") ==
        std::vector<std::string>{"line 2"});
}

TEST_CASE("a table says each thing once", "[server]") {
  CHECK(places("value," + head + "0.7," + good) == std::vector<std::string>{"line 1"});
  const std::string settings = "experiment,observable,value,unit,standard_error,settings\n";
  CHECK(places(settings + "drop,restitution,0.6,1,0.02,height=151 mm\n").empty());
  CHECK(places(settings + "drop,restitution,0.6,1,0.02,height=151 mm;height=2 m\n") ==
        std::vector<std::string>{"line 2: settings"});
}

TEST_CASE("a table in another encoding is refused by its lines", "[server]") {
  const std::string with_source = "experiment,observable,value,unit,standard_error,source\n";
  CHECK(places(with_source + "drop,restitution,0.6,1,0.02,K\xC3\xB6ln\n").empty());
  CHECK(places(with_source + "drop,restitution,0.6,1,0.02,K\xF6ln\n") ==
        std::vector<std::string>{"line 2"});
}

TEST_CASE("a table's material and sources are as a document's", "[server]") {
  using repose::server::parse_measurement_table;
  for (const std::string& material :
       {std::string("\xff\xfe"), std::string(300, 'a'), std::string("gl\nass")}) {
    const auto set = parse_measurement_table(head + good, material);
    REQUIRE_FALSE(set);
    CHECK(set.error().front().pointer == "?material");
  }
  const std::string with_source = "experiment,observable,value,unit,standard_error,source\n";
  CHECK(places(with_source + "drop,restitution,0.6,1,0.02,\"a\x1b[2J\"\n") ==
        std::vector<std::string>{"line 2: source"});
}

TEST_CASE("what a submission is called has no control characters", "[server]") {
  using repose::server::Problems;
  const auto places_of = [](const Problems& problems) {
    std::vector<std::string> where;
    for (const auto& problem : problems) where.push_back(problem.pointer);
    return where;
  };
  using repose::server::problems_of_labels;
  using repose::server::problems_of_schedule_labels;
  CHECK(problems_of_labels(R"({"name":"lab box","material":"soja \u00e4"})").empty());
  const std::string study =
      R"({"name":"lab\nbox","material":"\r","measurements":[{"source":"\u0000"},)"
      R"({"source":"\u009b2J"}]})";
  CHECK(places_of(problems_of_labels(study)) ==
        std::vector<std::string>{
            "/name", "/material", "/measurements/0/source", "/measurements/1/source"});
  CHECK(places_of(problems_of_schedule_labels(R"({"name":"\u001b","study":)" + study + "}")) ==
        std::vector<std::string>{"/name",
                                 "/study/name",
                                 "/study/material",
                                 "/study/measurements/0/source",
                                 "/study/measurements/1/source"});
  const auto material = repose::server::parse_own_material(
      R"({"title":"a\u0007","grain":{"density":{"value":1200,"unit":"kg/m3"}}})");
  REQUIRE_FALSE(material);
  CHECK(places_of(material.error())[0] == "/title");
  // What is stored from before is read as ever.
  CHECK(repose::server::parse_submission(study));
}
