// The service is killed at random moments while clients submit with idempotency keys: what was
// acknowledged is there, once.
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <map>
#include <mutex>
#include <optional>
#include <random>
#include <set>
#include <thread>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "db/sqlite.hpp"
#include "tests/support/example.hpp"
#include "tests/support/program.hpp"
#include "tests/support/served.hpp"
#include "tests/support/temporary_folder.hpp"

namespace {

using namespace repose::tests;
using Json = nlohmann::ordered_json;

/// The minimal study, each with a seed of its own so that each has work of its own.
std::string study(int seed) {
  Json json = Json::parse(example("valid/drop-minimal.json"));
  json["seed"] = seed;
  return json.dump();
}

/// How often it is killed: few where every change is tested, many by hand.
int kills() {
  const char* asked = std::getenv("REPOSE_KILLS");
  return asked == nullptr ? 4 : std::max(1, std::atoi(asked));
}

/// Posts until somebody answers; the calibration's number.
std::int64_t submit(const std::atomic<int>& port, int number) {
  const std::string key = "key-" + std::to_string(number);
  while (true) {
    httplib::Client client("127.0.0.1", port);
    client.set_read_timeout(30);
    const auto answer = client.Post(
        "/v1/calibrations", {{"Idempotency-Key", key}}, study(number), "application/json");
    // Nobody there, cut off, or just starting: ask again.
    if (!answer || answer->status == 503) {
      std::this_thread::yield();
      continue;
    }
    if (answer->status != 202) throw std::runtime_error(answer->body);
    return Json::parse(answer->body)["id"].get<std::int64_t>();
  }
}

std::int64_t number_of(repose::db::Connection& store, std::string_view question) {
  auto row = store.prepare(question);
  REQUIRE(row.step());
  return row.integer(0);
}

/// Everything of a fit that must not depend on when it was made.
Json fit_of(const httplib::Result& answer) {
  REQUIRE(answer);
  Json document = Json::parse(answer->body);
  INFO(document["error"]);
  REQUIRE(document["state"] == "done");
  return document["fit"];
}

Json wait_for_fit(const Served& served, std::int64_t id) {
  const auto client = served.client();
  const std::string path = "/v1/calibrations/" + std::to_string(id);
  while (true) {
    const auto answer = client->Get(path);
    REQUIRE(answer);
    const Json state = Json::parse(answer->body)["state"];
    if (state != "queued" && state != "running") return fit_of(answer);
    std::this_thread::yield();
  }
}

}  // namespace

TEST_CASE("what was acknowledged is there once, whenever the service is killed",
          "[end_to_end][slow]") {
  const TemporaryFolder folder;
  const std::string database = folder / "killed.db";
  Served served(database);
  std::atomic<int> port = served.port();
  std::atomic<bool> enough = false;
  std::atomic<int> next = 1;
  std::mutex mutex;
  std::condition_variable acknowledged;
  std::map<int, std::int64_t> ids;  // of each key
  const auto work = [&] {
    while (!enough) {
      const int number = next++;
      const std::int64_t id = submit(port, number);
      const std::scoped_lock hold(mutex);
      ids[number] = id;
      acknowledged.notify_all();
    }
  };
  std::vector<std::thread> clients;
  for (int i = 0; i < 3; ++i) clients.emplace_back(work);
  std::mt19937 random(20261129);
  for (int i = 0; i < kills(); ++i) {
    {
      // Not before something was acknowledged, and then at any moment.
      std::unique_lock hold(mutex);
      const std::size_t before = ids.size();
      acknowledged.wait(hold, [&] { return ids.size() > before; });
      const std::chrono::milliseconds moment(random() % 200);
      acknowledged.wait_for(hold, moment, [] { return false; });
    }
    served.end(SIGKILL);
    served.start();
    port = served.port();
  }
  enough = true;
  for (auto& client : clients) client.join();

  const int keys = next - 1;
  REQUIRE(ids.size() == static_cast<std::size_t>(keys));
  std::set<std::int64_t> distinct;
  for (const auto& [number, id] : ids) {
    CHECK(submit(port, number) == id);  // the answer of then, again
    distinct.insert(id);
  }
  CHECK(distinct.size() == ids.size());

  // Calibrations that were cut off go on, and come to what they come to when left alone.
  const Json first = wait_for_fit(served, ids.at(1));
  const Json second = wait_for_fit(served, ids.at(2));
  Served whole(folder / "whole.db");
  std::atomic<int> other_port = whole.port();
  CHECK(first.dump() == wait_for_fit(whole, submit(other_port, 1)).dump());
  CHECK(second.dump() == wait_for_fit(whole, submit(other_port, 2)).dump());

  served.end(SIGTERM);
  repose::db::Connection store(database, repose::db::Connection::Mode::read);
  CHECK(number_of(store, "SELECT count(*) FROM calibration") == keys);
  CHECK(number_of(store, "SELECT max(id) - count(*) FROM event") == 0);
  CHECK(std::system(
            ("'" + repose_program + "' doctor --db " + database + " > /dev/null").c_str()) == 0);
  WARN(kills() << " kills, " << keys << " acknowledged");
}
