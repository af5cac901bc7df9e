#include "db/event_store.hpp"

#include <stdexcept>
#include <vector>

#include <catch2/catch.hpp>

#include "db/figures.hpp"
#include "db/reply_store.hpp"
#include "db/sqlite.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace repose::db;
using repose::tests::TemporaryFolder;

namespace {

std::vector<std::string> kinds(const Store& store, std::optional<std::int64_t> calibration) {
  std::vector<std::string> result;
  for (const auto& event : EventStore(store).events(calibration, 0, 100)) {
    result.push_back(event.kind);
  }
  return result;
}

}  // namespace

TEST_CASE("every change of a calibration is an event, in order and without a gap", "[db]") {
  const TemporaryFolder folder;
  Store store(folder / "a.db", Access::write);
  const auto first = store.add_calibration("one", "{}", "d", 10);
  const auto other = store.add_calibration("two", "{}", "e", 11);
  store.start(first, 20);
  store.set_progress(first,
                     R"({"stage":"search","evaluations_done":3,"predicted":[1],"best":[2]})");
  store.requeue(first);
  store.start(first, 30);
  store.finish(first, "done", "{}", 1.5, std::nullopt, 40);
  store.finish(other, "failed", std::nullopt, std::nullopt, "said \"no\"\nand went", 50);
  CHECK(kinds(store, first) == std::vector<std::string>{"calibration.queued",
                                                        "calibration.running",
                                                        "calibration.progress",
                                                        "calibration.queued",
                                                        "calibration.running",
                                                        "calibration.done"});
  const auto all = EventStore(store).events(std::nullopt, 0, 100);
  REQUIRE(all.size() == 8);
  for (std::size_t i = 0; i < all.size(); ++i) {
    CHECK(all[i].id == static_cast<std::int64_t>(i + 1));
    CHECK(all[i].created_at > 1'600'000'000'000'000);
  }
  CHECK(all[3].detail == R"({"stage":"search","evaluations_done":3})");
  CHECK(all[6].misfit == 1.5);
  CHECK(all[7].calibration == other);
  CHECK(all[7].error == "said \"no\"\nand went");
  CHECK(EventStore(store).newest() == 8);
}

TEST_CASE("events are read on from any number, so many at a time", "[db]") {
  const TemporaryFolder folder;
  Store store(folder / "a.db", Access::write);
  for (int i = 0; i < 10; ++i) store.add_calibration("n", "{}", "d", i);
  std::int64_t last = 0;
  int count = 0;
  for (auto page = EventStore(store).events(std::nullopt, last, 3); !page.empty();
       page = EventStore(store).events(std::nullopt, last, 3)) {
    for (const auto& event : page) CHECK(event.id == ++last);
    count += static_cast<int>(page.size());
  }
  CHECK(count == 10);
}

TEST_CASE("a change that is taken back leaves no event and no gap", "[db]") {
  const TemporaryFolder folder;
  Store store(folder / "a.db", Access::write);
  CHECK_THROWS_AS(ReplyStore(store).once("key",
                                         "digest",
                                         1,
                                         [&]() -> std::optional<std::string> {
                                           store.add_calibration("n", "{}", "d", 1);
                                           throw std::runtime_error("no");
                                         }),
                  std::runtime_error);
  CHECK(EventStore(store).newest() == 0);
  store.add_calibration("n", "{}", "d", 1);
  CHECK(EventStore(store).newest() == 1);
}

TEST_CASE("an event neither changes nor goes, even by hand", "[db]") {
  const TemporaryFolder folder;
  {
    Store store(folder / "a.db", Access::write);
    store.add_calibration("n", "{}", "d", 1);
  }
  Connection connection(folder / "a.db", Connection::Mode::write);
  CHECK_THROWS_AS(connection.run("UPDATE event SET kind = 'x'"), Error);
  CHECK_THROWS_AS(connection.run("DELETE FROM event"), Error);
}

TEST_CASE("what is done with a key is done once, and its reply is kept for a time", "[db]") {
  const TemporaryFolder folder;
  int done = 0;
  const auto work = [&]() -> std::optional<std::string> {
    ++done;
    return "reply";
  };
  {
    Store store(folder / "a.db", Access::write);
    CHECK_FALSE(ReplyStore(store).once("key", "digest", 100, work));
    CHECK_FALSE(ReplyStore(store).once("other", "digest", 200, work));
  }
  Store store(folder / "a.db", Access::write);  // also by the next process
  const auto kept = ReplyStore(store).once("key", "another", 300, work);
  REQUIRE(kept);
  CHECK(kept->request_digest == "digest");
  CHECK(kept->reply == "reply");
  CHECK(done == 2);
  ReplyStore(store).forget(150);
  CHECK_FALSE(ReplyStore(store).once("key", "digest", 300, work));
  CHECK(ReplyStore(store).once("other", "digest", 300, work));
  CHECK(done == 3);
}

TEST_CASE("work that keeps nothing is done again", "[db]") {
  const TemporaryFolder folder;
  Store store(folder / "a.db", Access::write);
  int done = 0;
  const auto work = [&]() -> std::optional<std::string> {
    ++done;
    return std::nullopt;
  };
  CHECK_FALSE(ReplyStore(store).once("key", "digest", 1, work));
  CHECK_FALSE(ReplyStore(store).once("key", "digest", 1, work));
  CHECK(done == 2);
}

TEST_CASE("figures count evaluations without counting them", "[db]") {
  const TemporaryFolder folder;
  Store store(folder / "a.db", Access::write);
  CHECK(figures(store).evaluations == 0);
  store.add_evaluation({"a", "{}", "{}", 1.5, "v", 1});
  store.add_evaluation({"a", "{}", "{}", 9.0, "v", 1});  // there already
  store.add_evaluation({"b", "{}", "{}", 2.0, "v", 1});
  CHECK(figures(store).evaluations == 2);
  CHECK(figures(store).seconds == Approx(3.5));
  CHECK(figures(store).database_bytes > 0);
  probe(store);
}
