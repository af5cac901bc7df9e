#include "db/backup.hpp"

#include <atomic>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include <catch2/catch.hpp>

#include "db/sqlite.hpp"
#include "db/store.hpp"
#include "tests/support/database_rows.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace repose::db;
using repose::tests::all_rows;
using repose::tests::TemporaryFolder;

namespace {

EvaluationRecord evaluation(int number) {
  const std::string name = std::to_string(number);
  return {"key " + name, "question " + name, std::string(2000, 'x'), 1.5, "v1", 42};
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  return bytes.str();
}

void write(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

}  // namespace

TEST_CASE("a backup holds every row, and is restored in the place of the database", "[db]") {
  const TemporaryFolder folder;
  {
    Store store(folder / "a.db", Access::write);
    const auto id = store.add_calibration("n", "{}", "d", 1);
    for (int i = 0; i < 50; ++i) store.add_evaluation(evaluation(i));
    store.note_used(id, 0, {"key 1", "key 2"});
    back_up(folder / "a.db", folder / "copy");  // while the store is open
    store.add_evaluation(evaluation(99));
  }
  const std::string before = all_rows(folder / "copy");
  CHECK(before.size() > 100000);
  CHECK(all_rows(folder / "a.db").size() > before.size());
  const auto kept = restore(folder / "copy", folder / "a.db");
  CHECK(all_rows(folder / "a.db") == before);
  CHECK(kept == folder / "a.db.replaced-1");
  CHECK(all_rows(kept).find("key 99") != std::string::npos);
  CHECK(Store(folder / "a.db", Access::write).evaluation("key 3").has_value());
  CHECK(restore(folder / "copy", folder / "another.db").empty());
}

TEST_CASE("a backup taken under load is whole: all of each transaction or nothing", "[db]") {
  const TemporaryFolder folder;
  Store store(folder / "a.db", Access::write);
  const auto id = store.add_calibration("n", "{}", "d", 1);
  std::atomic<bool> enough = false;
  std::atomic<int> written = 0;
  {
    const std::jthread writer([&] {
      for (int i = 0; !enough; ++i) {
        store.add_evaluation(evaluation(2 * i));
        store.add_evaluation(evaluation(2 * i + 1));
        store.note_used(
            id, 2 * i, {"key " + std::to_string(2 * i), "key " + std::to_string(2 * i + 1)});
        ++written;
      }
    });
    for (int copy = 0; copy < 5; ++copy) {
      const int before = written;
      while (written < before + 5) std::this_thread::yield();
      back_up(folder / "a.db", folder / ("copy" + std::to_string(copy)));
    }
    enough = true;
  }
  for (int copy = 0; copy < 5; ++copy) {
    const auto file = folder / ("copy" + std::to_string(copy));
    CHECK(examine(file).empty());
    restore(file, folder / "restored.db");
    CHECK(all_rows(folder / "restored.db") == all_rows(file));
    Store restored(folder / "restored.db", Access::write);
    CHECK(restored.used(id, 1'000'000, std::nullopt).size() % 2 == 0);
    CHECK(restored.used(id, 1'000'000, std::nullopt).size() >= 10);
  }
}

TEST_CASE("a backup is restored over whatever stands there, and that is kept as it was", "[db]") {
  const TemporaryFolder folder;
  const auto database = folder / "a.db";
  std::string log;
  {
    Store store(database, Access::write);
    for (int i = 0; i < 50; ++i) store.add_evaluation(evaluation(i));
    back_up(database, folder / "copy");
    log = bytes_of(folder / "a.db-wal");
  }
  const std::string rows = all_rows(folder / "copy");
  const std::string sound = bytes_of(database);
  REQUIRE(sound.size() > 20 * 4096);
  REQUIRE(!log.empty());
  const std::string zeros = sound.substr(0, 4096) + std::string(sound.size() - 4096, '\0');
  const std::string cut = sound.substr(0, sound.size() / 2);
  const std::string text(sound.size(), 'x');
  int number = 0;
  for (const std::string& there : {zeros, cut, text, std::string()}) {
    INFO("damaged file " << ++number);
    write(database, there);
    write(folder / "a.db-wal", log);
    const auto kept = restore(folder / "copy", database);
    CHECK(kept == folder / ("a.db.replaced-" + std::to_string(number)));
    CHECK((bytes_of(kept) == there));  // too long to be printed
    CHECK((bytes_of(kept.string() + "-wal") == log));
    CHECK_FALSE(std::filesystem::exists(folder / "a.db-wal"));
    CHECK_FALSE(std::filesystem::exists(folder / "a.db.part"));
    CHECK(all_rows(database) == rows);
    CHECK(examine(database).empty());
  }
}

TEST_CASE("the log of a database that is gone is not taken for that of a backup", "[db]") {
  const TemporaryFolder folder;
  const auto database = folder / "a.db";
  std::string log;
  {
    Store store(database, Access::write);
    back_up(database, folder / "copy");
    for (int i = 0; i < 50; ++i) store.add_evaluation(evaluation(i));
    log = bytes_of(folder / "a.db-wal");
  }
  std::filesystem::remove(database);
  write(folder / "a.db-wal", log);
  restore(folder / "copy", database);
  CHECK(all_rows(database) == all_rows(folder / "copy"));
}

TEST_CASE("a backup that cannot be put in its place leaves nothing behind", "[db]") {
  const TemporaryFolder folder;
  { const Store store(folder / "a.db", Access::write); }
  back_up(folder / "a.db", folder / "copy");
  // A name so long that there may be one with .part-journal, but none with .replaced-1-wal.
  const auto database = folder / std::string(242, 'n');
  write(database, "old");
  CHECK_THROWS_WITH(restore(folder / "copy", database), Catch::Contains(".replaced-1-wal"));
  CHECK(bytes_of(database) == "old");
  CHECK_FALSE(std::filesystem::exists(database.string() + ".part"));
}

TEST_CASE("a backup does not replace a file, and a database in use is not replaced", "[db]") {
  const TemporaryFolder folder;
  const Store store(folder / "a.db", Access::write);
  back_up(folder / "a.db", folder / "copy");
  CHECK_THROWS_WITH(back_up(folder / "a.db", folder / "copy"), Catch::Contains("there already"));
  CHECK_THROWS_WITH(restore(folder / "copy", folder / "a.db"), Catch::Contains("in use"));
  CHECK_THROWS_WITH(back_up(folder / "b.db", folder / "c"), Catch::Contains("no database"));
  CHECK_THROWS_WITH(restore(folder / "none", folder / "b.db"), Catch::Contains("no backup"));
  std::ofstream(folder / "strange") << "this is no database, but a text that is long enough";
  CHECK_THROWS_AS(restore(folder / "strange", folder / "b.db"), Error);
  std::ofstream(folder / "empty");
  CHECK_THROWS_WITH(restore(folder / "empty", folder / "b.db"), Catch::Contains("is empty"));
  CHECK_FALSE(std::filesystem::exists(folder / "b.db"));
}

TEST_CASE("a sound database has no problems, and each that is made is found", "[db]") {
  const TemporaryFolder folder;
  {
    Store store(folder / "a.db", Access::write);
    const auto id = store.add_calibration("n", "{}", "d", 10);
    for (int i = 0; i < 3; ++i) store.add_evaluation(evaluation(i));
    store.note_used(id, 0, {"key 0", "key 1", "key 2"});
    store.start(id, 20);
    store.finish(id, "done", "{}", 1.0, std::nullopt, 30);
  }
  CHECK(examine(folder / "a.db").empty());
  {
    Connection hand(folder / "a.db", Connection::Mode::write);
    hand.run("DELETE FROM calibration_evaluation WHERE ordinal = 1");
    hand.run(
        "INSERT INTO calibration (name, state, created_at, finished_at, request, "
        "request_digest) VALUES ('n', 'done', 50, 40, '{}', 'd')");
    hand.run(
        "INSERT INTO calibration (name, state, created_at, started_at, request, "
        "request_digest) VALUES ('n', 'running', 50, 40, '{}', 'd')");
  }
  CHECK(examine(folder / "a.db") ==
        std::vector<std::string>{"done without a fit: calibration 2",
                                 "ended before it began: calibration 3",
                                 "evaluations missing between those used by calibration 1"});
}

TEST_CASE("a damaged file is named as such, and is not opened for writing", "[db]") {
  const TemporaryFolder folder;
  {
    Store store(folder / "a.db", Access::write);
    for (int i = 0; i < 200; ++i) store.add_evaluation(evaluation(i));
  }
  {
    std::fstream file(folder / "a.db", std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(40 * 4096);
    file << std::string(20 * 4096, 'z');
  }
  CHECK_FALSE(examine(folder / "a.db").empty());
  CHECK_THROWS_WITH(Store(folder / "a.db", Access::write), Catch::Contains("damaged"));
  CHECK_THROWS_AS(back_up(folder / "a.db", folder / "copy"), Error);
  CHECK_FALSE(std::filesystem::exists(folder / "copy"));
  CHECK_FALSE(std::filesystem::exists(folder / "copy.part"));
}
