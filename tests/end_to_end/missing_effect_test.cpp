#include <string>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/support/api.hpp"
#include "tests/support/hidden_drop.hpp"
#include "tests/support/temporary_folder.hpp"

namespace {

using Json = nlohmann::ordered_json;
using repose::tests::Api;
using repose::tests::hidden_drop_study;
using repose::tests::TemporaryFolder;

}  // namespace

TEST_CASE("a model is diagnosed and extended over the network", "[end_to_end]") {
  const TemporaryFolder folder;
  Api api(folder);
  const std::string base = api.submit(hidden_drop_study(0.0));
  REQUIRE(api.wait(base, {"done", "failed"})["state"] == "done");
  CHECK(Json::parse(api.get(base + "/comparison").body)["p"] > 0.01);

  const httplib::Response taken = api.post_to(base + "/diagnoses", "{}");
  REQUIRE(taken.status == 202);
  CHECK(taken.has_header("Retry-After"));
  const std::string address = taken.get_header_value("Location");
  const Json diagnosis = api.wait(address, {"done", "failed"});
  REQUIRE(diagnosis["state"] == "done");
  CHECK(Json::parse(api.get(base + "/diagnoses").body)["items"].size() == 1);
  CHECK(api.remove(address).status == 409);

  CHECK(api.post_to(base + "/extensions", R"({"effect":"magic"})").status == 422);
  const httplib::Response child = api.post_to(
      base + "/extensions",
      R"({"effect":"velocity_restitution","diagnosis":)" + diagnosis["id"].dump() + "}");
  REQUIRE(child.status == 202);
  REQUIRE(api.wait(child.get_header_value("Location"), {"done", "failed"})["state"] == "done");
  const Json lineage = Json::parse(api.get(base + "/lineage").body);
  REQUIRE(lineage["items"].size() == 2);
  CHECK(lineage["items"][0]["verdict"]["verdict"] == "adequate");
  CHECK(lineage["items"][1]["diagnosis"] == diagnosis["id"]);
}
