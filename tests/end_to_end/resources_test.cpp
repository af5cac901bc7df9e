// What users keep: sets of measurements, and the fits that come of them.

#include <set>
#include <string>

#include <catch2/catch.hpp>

#include "tests/support/api.hpp"
#include "tests/support/example.hpp"

namespace {

using namespace repose::tests;
using Json = nlohmann::ordered_json;

const std::string table =
    "experiment,observable,value,unit,standard_error,source,settings\r\n"
    "drop,restitution,0.6,1,0.02,\"ours, of \"\"May\"\"\",height=300 mm\r\n";
const std::string address = "/v1/measurement-sets/may";
const std::set<std::string> ends{"done", "failed", "cancelled"};

/// The example's study, with a set in place of its measurements.
std::string study_of(const Json& set) {
  Json study = Json::parse(example("valid/drop-minimal.json"));
  study.erase("measurements");
  study["measurement_set"] = set;
  return study.dump();
}

}  // namespace

TEST_CASE("measurements go in as a table and come out as document and table", "[end_to_end]") {
  const TemporaryFolder folder;
  Api api(folder);
  const httplib::Response put = api.put(address + "?material=glass", table, "text/csv");
  REQUIRE(put.status == 200);
  const Json document = Json::parse(put.body);
  CHECK(document["version"] == 1);
  CHECK(document["material"] == "glass");
  CHECK(document["measurements"][0]["source"] == "ours, of \"May\"");
  CHECK(document["measurements"][0]["settings"]["height"]["value"] == 300);
  CHECK(api.get(address).body == put.body);
  const httplib::Response csv = api.get(address, {{"Accept", "text/csv"}});
  CHECK(csv.get_header_value("Content-Type").starts_with("text/csv"));
  // What came out goes in again, and is the same.
  CHECK(Json::parse(api.put(address + "?material=glass", csv.body, "text/csv").body) == document);
  const Json content{{"material", "glass"}, {"measurements", document["measurements"]}};
  CHECK(Json::parse(api.put(address, content.dump(), "application/json").body) == document);
}

TEST_CASE("a changed set is a new version, and the old one stays", "[end_to_end]") {
  const TemporaryFolder folder;
  Api api(folder);
  const auto put = [&](const std::string& name, const std::string& value) {
    std::string text = table;
    text.replace(text.find("0.6"), 3, value);
    return api.put("/v1/measurement-sets/" + name + "?material=glass", text, "text/csv");
  };
  const httplib::Response first = put("may", "0.6");
  CHECK(Json::parse(put("may", "0.7").body)["version"] == 2);
  CHECK(api.get(address + "?version=1").body == first.body);
  CHECK(Json::parse(api.get(address).body)["measurements"][0]["value"] == 0.7);
  CHECK(api.get(address + "?version=3").status == 404);
  CHECK(api.get("/v1/measurement-sets/june").status == 404);
  put("april", "0.5");
  put("june", "0.5");
  Json names = Json::array();
  std::string query = "?limit=1";
  for (Json page = Json::parse(api.get("/v1/measurement-sets" + query).body);
       !page["items"].empty();
       page = Json::parse(api.get("/v1/measurement-sets" + query).body)) {
    names.push_back(page["items"][0]["name"]);
    query = "?limit=1&after=" + page["items"][0]["name"].get<std::string>();
  }
  CHECK(names == Json{"april", "june", "may"});
}

TEST_CASE("a set that was changed meanwhile is not overwritten unawares", "[end_to_end]") {
  const TemporaryFolder folder;
  Api api(folder);
  const std::string path = address + "?material=glass";
  api.put(path, table, "text/csv");
  const std::string tag = api.get(address).get_header_value("ETag");
  std::string changed = table;
  changed.replace(changed.find("0.6"), 3, "0.7");
  CHECK(api.put(path, changed, "text/csv", {{"If-Match", tag}}).status == 200);
  CHECK(api.put(path, table, "text/csv", {{"If-Match", tag}}).status == 412);
  CHECK(Json::parse(api.get(address).body)["version"] == 2);
}

TEST_CASE("a table with mistakes is refused with all of them, by line", "[end_to_end]") {
  const TemporaryFolder folder;
  Api api(folder);
  const httplib::Response refused =
      api.put(address + "?material=glass",
              "experiment,observable,value,unit,standard_error,colour\n"
              "drop,restitution,high,1,0.02,red\n"
              "drop,restitution,0.6,furlong,0.02\n"
              "drip,restitution,0.6,1,0.02\n"
              "drop,restitution,0.6,1,-1,red,more\n",
              "text/csv");
  REQUIRE(refused.status == 422);
  std::set<std::string> places;
  const Json problem = Json::parse(refused.body);
  for (const Json& error : problem["errors"]) {
    places.insert(error["pointer"].get<std::string>());
  }
  CHECK(places == std::set<std::string>{"line 1",
                                        "line 2: value",
                                        "line 3: unit",
                                        "line 4: experiment",
                                        "line 5",
                                        "line 5: standard_error"});
  CHECK(api.put(address, table, "text/csv").status == 400);  // of what?
  CHECK(api.put(address + "?material=glass", "", "text/csv").status == 422);
  CHECK(api.put(address, "[]", "application/json").status == 422);
  CHECK(api.put(address, "{}", "text/plain").status == 415);
  CHECK(api.put("/v1/measurement-sets/two%20words?material=glass", table, "text/csv").status ==
        422);
  CHECK(api.get(address).status == 404);
}

TEST_CASE("a calibration of a set leads to the best fit of its material", "[end_to_end]") {
  const TemporaryFolder folder;
  Api api(folder);
  api.put(address + "?material=glass", table, "text/csv");
  const std::string path = api.submit(study_of({{"name", "may"}, {"version", 1}}));
  REQUIRE(api.wait(path, ends)["state"] == "done");
  const std::string other = api.submit(example("valid/drop-minimal.json"));  // of no material
  REQUIRE(api.wait(other, ends)["state"] == "done");

  const Json page = Json::parse(api.get("/v1/fits?material=glass&latest=true").body);
  REQUIRE(page["items"].size() == 1);
  const Json& fit = page["items"][0];
  CHECK("/v1/calibrations/" + fit["calibration"].dump() == path);
  CHECK(fit["material"] == "glass");
  REQUIRE(fit["parameters"].size() == 1);
  CHECK(fit["parameters"][0]["interval"].size() == 2);
  CHECK(fit["not_determined"].size() == (fit["parameters"][0]["determined"].get<bool>() ? 0U : 1U));
  CHECK(fit["provenance"]["measurement_set"] == Json{{"name", "may"}, {"version", 1}});
  CHECK(fit["provenance"]["calibration"] == path);
  CHECK(Json::parse(api.get("/v1/fits?material=steel").body)["items"].empty());
  const Json newest = Json::parse(api.get("/v1/fits?limit=1").body);
  CHECK("/v1/calibrations/" + newest["items"][0]["calibration"].dump() == other);
  CHECK(newest["items"][0]["material"].is_null());
  const Json rest = Json::parse(api.get("/v1/fits?before=" + newest["next"].dump()).body);
  REQUIRE(rest["items"].size() == 1);
  CHECK(rest["items"][0] == fit);
}

TEST_CASE("a submission that names no set that is kept is refused", "[end_to_end]") {
  const TemporaryFolder folder;
  Api api(folder);
  for (const Json& set : {Json{{"name", "may"}},
                          Json{{"name", 3}},
                          Json{{"name", "may"}, {"version", 0}},
                          Json{{"title", "may"}},
                          Json("may")}) {
    INFO(set);
    CHECK(api.post(study_of(set)).status == 422);
  }
  Json both = Json::parse(example("valid/drop-minimal.json"));
  both["measurement_set"] = {{"name", "may"}};
  CHECK(api.post(both.dump()).status == 422);
  Json named = Json::parse(example("valid/drop-minimal.json"));
  named["material"] = "glass";
  CHECK(api.post(named.dump()).status == 202);
}

TEST_CASE("a grain of one's own is kept, replaced knowingly, and removed", "[end_to_end]") {
  const TemporaryFolder folder;
  Api api(folder);
  const std::string path = "/v1/materials/our-beads";
  const auto put = [&](const char* title, const httplib::Headers& fields = {}) {
    const Json study = Json::parse(example("valid/drop-minimal.json"));
    const Json document{{"title", title}, {"grain", study["materials"]["grain"]}};
    return api.put(path, document.dump(), "application/json", fields);
  };
  CHECK(api.get(path).status == 404);
  CHECK(put("beads").status == 200);
  CHECK(put("beads").status == 200);  // the same again changes nothing
  CHECK(put("glass beads").status == 428);
  const std::string tag = api.get(path).get_header_value("ETag");
  CHECK(put("glass beads", {{"If-Match", tag}}).status == 200);
  CHECK(put("steel beads", {{"If-Match", tag}}).status == 412);
  CHECK(Json::parse(api.get(path).body)["title"] == "glass beads");
  const Json list = Json::parse(api.get("/v1/materials").body);
  CHECK(list["items"].front()["origin"] == "published");
  CHECK(list["items"].back()["origin"] == "own");
  CHECK(list["items"].back()["name"] == "our-beads");
  CHECK(
      api.put("/v1/materials/soybean", R"({"title":"x","grain":{}})", "application/json").status ==
      409);
  CHECK(api.remove("/v1/materials/soybean").status == 409);
  const httplib::Response bad =
      api.put("/v1/materials/odd",
              R"({"title":7,"grain":{"density":{"value":-1,"unit":"s"},"x":1}})",
              "application/json");
  REQUIRE(bad.status == 422);
  CHECK(Json::parse(bad.body)["errors"].size() == 3);
  CHECK(api.remove(path).status == 200);
  CHECK(api.remove(path).status == 404);
}

TEST_CASE("a study of one's own material may leave its grain out", "[end_to_end]") {
  const TemporaryFolder folder;
  Api api(folder);
  Json study = Json::parse(example("valid/drop-minimal.json"));
  const Json grain = study["materials"]["grain"];
  study["materials"].erase("grain");
  study["material"] = "our-beads";
  CHECK(api.post(study.dump()).status == 422);  // nobody has described them yet
  api.put("/v1/materials/our-beads",
          Json{{"title", "beads"}, {"grain", grain}}.dump(),
          "application/json");
  const Json document = api.wait(api.submit(study.dump()), ends);
  CHECK(document["state"] == "done");
  CHECK(document["study"]["materials"]["grain"]["density"]["value"] == grain["density"]["value"]);
  CHECK(Json::parse(api.get("/v1/fits?material=our-beads").body)["items"].size() == 1);
}
