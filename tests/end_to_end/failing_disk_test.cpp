// Two of five syncs fail (libfiu): what was acknowledged is there, and no calibration is blamed.
#include <chrono>
#include <cstdlib>
#include <set>
#include <thread>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/support/example.hpp"
#include "tests/support/not_tried.hpp"
#include "tests/support/program.hpp"
#include "tests/support/served.hpp"
#include "tests/support/temporary_folder.hpp"

namespace {

using namespace repose::tests;
using Json = nlohmann::ordered_json;

httplib::Result submit(httplib::Client& client, int number) {
  Json study = Json::parse(example("valid/drop-minimal.json"));
  study["seed"] = number;
  return client.Post("/v1/calibrations",
                     {{"Idempotency-Key", "key-" + std::to_string(number)}},
                     study.dump(),
                     "application/json");
}

}  // namespace

TEST_CASE("a disk that fails to sync costs answers, but no acknowledged job and no calibration",
          "[end_to_end][slow]") {
  if (std::system("command -v fiu-run > /dev/null && command -v fiu-ctrl > /dev/null") != 0) {
    not_tried("fiu-run is not installed");
    return;
  }
  const TemporaryFolder folder;
  Served served(folder / "a.db", {"fiu-run", "-x", "-f", folder.path() / "fiu"});
  const auto control = [&](const std::string& command) {
    const std::string words = "fiu-ctrl -f '" + (folder.path() / "fiu").string() + "' -c '" +
                              command + "' " + std::to_string(served.process());
    REQUIRE(std::system(words.c_str()) == 0);
  };
  const auto client = served.client();
  std::set<int> acknowledged;
  int jobs = 0;
  int refused = 0;
  control("enable_random name=posix/io/sync/*,probability=0.4");
  while (acknowledged.size() < 4 || refused < 3) {
    const auto answer = submit(*client, ++jobs);
    REQUIRE(answer);
    INFO(answer->body);
    REQUIRE((answer->status == 202 || answer->status == 503));
    if (answer->status == 202) acknowledged.insert(jobs);
    refused += answer->status == 503 ? 1 : 0;
  }
  control("disable name=posix/io/sync/*");
  for (int number = 1; number <= jobs; ++number) {
    const auto answer = submit(*client, number);
    REQUIRE(answer);
    CHECK(answer->status == 202);
    CHECK(answer->has_header("Idempotency-Replayed") == acknowledged.contains(number));
  }
  // All end well, also those that were in the middle of it.
  int done = 0;
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(3);
  while (done < jobs && std::chrono::steady_clock::now() < end) {
    done = 0;
    const Json list = Json::parse(client->Get("/v1/calibrations?limit=200")->body);
    REQUIRE(list["items"].size() == static_cast<std::size_t>(jobs));
    for (const Json& item : list["items"]) {
      INFO(item["error"]);
      REQUIRE(item["state"] != "failed");
      done += item["state"] == "done" ? 1 : 0;
    }
    std::this_thread::yield();
  }
  CHECK(done == jobs);
  served.end(SIGTERM);
  const std::string doctor =
      "'" + repose_program + "' doctor --db " + (folder / "a.db").string() + " > /dev/null";
  CHECK(std::system(doctor.c_str()) == 0);
}
