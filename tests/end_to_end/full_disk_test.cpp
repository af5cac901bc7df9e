// The disk is full, and then it is not: the service says so, loses nothing, and goes on by itself.
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/support/example.hpp"
#include "tests/support/not_tried.hpp"
#include "tests/support/served.hpp"
#include "tests/support/temporary_folder.hpp"

namespace {

using namespace repose::tests;
using Json = nlohmann::ordered_json;

/// The minimal study with impacts resolved finely: an evaluation takes some tenths of a second.
std::string study(int seed, bool slow) {
  Json json = Json::parse(example("valid/drop-minimal.json"));
  json["seed"] = seed;
  if (slow) {
    json["measurements"][0]["settings"] = {{"steps_per_impact", {{"value", 10000}, {"unit", "1"}}}};
  }
  return json.dump();
}

httplib::Result submit(httplib::Client& client, int number, bool slow = false) {
  return client.Post("/v1/calibrations",
                     {{"Idempotency-Key", "key-" + std::to_string(number)}},
                     study(number, slow),
                     "application/json");
}

/// Asks again until that is the status, or the test ends.
bool becomes(httplib::Client& client, const char* path, int status) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
  while (std::chrono::steady_clock::now() < end) {
    const auto answer = client.Get(path);
    if (answer && answer->status == status) return true;
    std::this_thread::yield();
  }
  return false;
}

}  // namespace

TEST_CASE("a full disk is told, loses nothing, and is got over without a restart",
          "[end_to_end][slow]") {
  const TemporaryFolder folder;
  const std::string disk = folder / "disk";
  std::filesystem::create_directory(disk);
  const std::string mount = "mount -t tmpfs -o size=16m tmpfs '" + disk + "'";
  // Who is not root here may be where only he can see it.
  const std::string apart = geteuid() == 0 ? "-m" : "-rm";
  if (std::system(("unshare " + apart + " sh -c \"" + mount + "\" 2>/dev/null").c_str()) != 0) {
    not_tried("a file system cannot be mounted here");
    return;
  }
  // A disk of 16 MB that only the service sees, and goes with it.
  Served served(disk + "/a.db", {"unshare", apart, "sh", "-c", mount + " && exec \"$@\"", "sh"});
  const std::string filler =
      "/proc/" + std::to_string(served.process()) + "/root" + disk + "/filler";
  const auto client = served.client();

  const auto running = submit(*client, 0, true);  // work that meets the full disk
  REQUIRE(running);
  REQUIRE(running->status == 202);
  const std::string first = running->get_header_value("Location");

  {
    std::ofstream file(filler, std::ios::binary);
    const std::string block(4096, 'x');
    while (file.write(block.data(), 4096).flush()) {
    }
  }
  // What still fits into the log is still taken; then it is refused, and nothing is half done.
  int number = 1;
  auto answer = submit(*client, number);
  while (answer && answer->status == 202) answer = submit(*client, ++number);
  REQUIRE(answer);
  CHECK(answer->status == 503);
  CHECK(answer->get_header_value("Content-Type").find("application/problem+json") == 0);
  CHECK(answer->has_header("Retry-After"));
  CHECK(becomes(*client, "/readyz", 503));
  CHECK(client->Get("/livez")->status == 200);
  CHECK(client->Get(first.c_str())->status == 200);

  std::filesystem::remove(filler);
  CHECK(becomes(*client, "/readyz", 200));
  const auto again = submit(*client, number);
  REQUIRE(again);
  CHECK(again->status == 202);
  CHECK_FALSE(again->has_header("Idempotency-Replayed"));  // it had not been done
  const Json list = Json::parse(client->Get("/v1/calibrations?limit=200")->body);
  CHECK(list["items"].size() == static_cast<std::size_t>(number) + 1);

  // The calibration that was under way ends too.
  std::string state;
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
  while (std::chrono::steady_clock::now() < end && state != "done" && state != "failed") {
    state = Json::parse(client->Get(first.c_str())->body)["state"].get<std::string>();
    std::this_thread::yield();
  }
  CHECK(state == "done");
}
