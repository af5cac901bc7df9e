// Studies as they are sent: what the schema of submissions says of them, and what the program.

#include <string>

#include <catch2/catch.hpp>

#include "server/json/openapi.hpp"
#include "server/service.hpp"
#include "tests/schemas/schema_check.hpp"
#include "tests/support/example.hpp"
#include "tests/support/temporary_folder.hpp"

namespace {

using repose::server::Service;
using repose::tests::conforms;
using repose::tests::example;
using repose::tests::Json;
using repose::tests::TemporaryFolder;
using repose::tests::violations;

Json study() { return Json::parse(example("valid/drop-minimal.json")); }

/// The example with a set in place of its measurements.
Json with_set(const Json& set) {
  Json json = study();
  json.erase("measurements");
  json["measurement_set"] = set;
  return json;
}

Json with(Json json, const char* member, const Json& value) {
  json[member] = value;
  return json;
}

Json without_grain(Json json) {
  json["materials"].erase("grain");
  return json;
}

/// A service that keeps the material "beads" and the set "may".
class Keeper {
 public:
  Keeper() : service_(options(folder_)) {
    const Json beads{{"title", "beads"}, {"grain", study()["materials"]["grain"]}};
    REQUIRE(service_.put_material("beads", beads.dump(), false));
    const Json may{{"material", "beads"}, {"measurements", study()["measurements"]}};
    REQUIRE(service_.put_measurement_set("may", may.dump(), std::nullopt));
  }

  [[nodiscard]] bool takes(const Json& submission) const {
    return service_.study(submission.dump()).has_value();
  }

 private:
  static repose::server::ServiceOptions options(const TemporaryFolder& folder) {
    repose::server::ServiceOptions result;
    result.database = folder / "a.db";
    return result;
  }

  TemporaryFolder folder_;
  Service service_;
};

std::vector<std::string> refusals(const Json& submission) {
  static const Json description =
      Json::parse(repose::server::print_openapi(repose::server::routes()));
  return violations(description, {{"$ref", "#/components/schemas/submission"}}, submission);
}

}  // namespace

TEST_CASE("what may be sent conforms to the schema of submissions", "[schemas]") {
  const Keeper keeper;
  for (const Json& submission : {study(),
                                 with(study(), "material", "beads"),
                                 without_grain(with(study(), "material", "beads")),
                                 with_set({{"name", "may"}}),
                                 with_set({{"name", "may"}, {"version", 1}}),
                                 without_grain(with_set({{"name", "may"}})),
                                 with(with_set({{"name", "may"}}), "material", "glass")}) {
    INFO(submission.dump(1));
    CHECK_THAT(refusals(submission), conforms());
    CHECK(keeper.takes(submission));
  }
}

TEST_CASE("what the schema of submissions refuses, the program refuses", "[schemas]") {
  const Keeper keeper;
  Json nameless = study();
  nameless.erase("name");
  Json unmeasured = study();
  unmeasured.erase("measurements");
  const Json bare{{"name", "a"}, {"free", Json::array()}, {"measurement_set", {{"name", "may"}}}};
  for (const Json& submission : {nameless,
                                 unmeasured,
                                 bare,
                                 with(unmeasured, "material", "beads"),
                                 with(study(), "bogus", 1),
                                 with(with_set({{"name", "may"}}), "bogus", 1),
                                 with(with_set({{"name", "may"}}), "budget", {{"evaluations", 0}}),
                                 with(study(), "measurement_set", {{"name", "may"}}),
                                 with(study(), "material", ""),
                                 with(study(), "material", std::string(101, 'm')),
                                 with_set({{"name", ""}}),
                                 with_set({{"name", std::string(65, 'm')}}),
                                 with_set({{"name", "may"}, {"version", 0}}),
                                 with_set({{"name", "may"}, {"of", "glass"}}),
                                 with_set({{"version", 1}}),
                                 with_set("may")}) {
    INFO(submission.dump(1));
    CHECK_FALSE(refusals(submission).empty());
    CHECK_FALSE(keeper.takes(submission));
  }
}
