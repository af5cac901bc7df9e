#include "db/store.hpp"

#include <csignal>
#include <filesystem>
#include <fstream>
#include <sys/resource.h>
#include <thread>

#include <catch2/catch.hpp>

#include "db/backup.hpp"
#include "db/migrate.hpp"
#include "db/sqlite.hpp"
#include "tests/support/database_rows.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace repose::db;
using repose::tests::TemporaryFolder;

namespace {

EvaluationRecord evaluation(const std::string& key) {
  return {key, "question of " + key, "answer of " + key, 1.5, "v1", 42};
}

/// While it lives, no file of this process grows beyond so many bytes: to write there fails.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &former_);
    const rlimit limited{bytes, former_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limited);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &former_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit former_{};
  void (*handler_)(int);
};

}  // namespace

TEST_CASE("a calibration goes through its states and keeps its documents", "[db]") {
  const TemporaryFolder folder;
  Store store(folder / "a.db", Access::write);
  const auto id = store.add_calibration("soybean", "{\"study\":1}", "digest", 10);
  CHECK(store.calibration(id)->state == "queued");
  CHECK(store.start(id, 20));
  CHECK_FALSE(store.start(id, 21));
  store.set_progress(id, "{\"p\":1}");
  CHECK(store.unfinished("digest")->id == id);
  CHECK(store.finish(id, "done", "{\"fit\":1}", 2.5, std::nullopt, 30));
  const auto record = store.calibration(id);
  CHECK(record->state == "done");
  CHECK(record->request == "{\"study\":1}");
  CHECK(record->progress == "{\"p\":1}");
  CHECK(record->fit == "{\"fit\":1}");
  CHECK(record->misfit == 2.5);
  CHECK(record->created_at == 10);
  CHECK(record->started_at == 20);
  CHECK(record->finished_at == 30);
  CHECK_FALSE(record->error.has_value());
  CHECK_FALSE(store.unfinished("digest").has_value());
  CHECK_FALSE(store.finish(id, "failed", std::nullopt, std::nullopt, "late", 40));
  CHECK_FALSE(store.calibration(id + 1).has_value());
}

TEST_CASE("what is finished cannot be changed, even by hand", "[db]") {
  const TemporaryFolder folder;
  {
    Store store(folder / "a.db", Access::write);
    store.finish(store.add_calibration("n", "{}", "d", 1), "done", "{}", 1.0, std::nullopt, 2);
    store.add_evaluation(evaluation("k"));
  }
  Connection connection(folder / "a.db", Connection::Mode::write);
  CHECK_THROWS_AS(connection.run("UPDATE calibration SET fit = 'x'"), Error);
  CHECK_THROWS_AS(connection.run("UPDATE evaluation SET answer = 'x'"), Error);
  CHECK_THROWS_AS(connection.run("UPDATE calibration SET state = 'odd'"), Error);
}

TEST_CASE("an interrupted calibration waits again after a restart", "[db]") {
  const TemporaryFolder folder;
  std::int64_t id = 0;
  {
    Store store(folder / "a.db", Access::write);
    id = store.add_calibration("n", "{}", "d", 1);
    store.start(id, 2);
  }
  Store store(folder / "a.db", Access::write);
  CHECK(store.calibration(id)->state == "running");
  store.requeue_all();
  CHECK(store.in_state("queued") == std::vector{id});
  CHECK(store.count_by_state() == std::map<std::string, std::int64_t>{{"queued", 1}});
}

TEST_CASE("lists are newest first and page by id", "[db]") {
  const TemporaryFolder folder;
  Store store(folder / "a.db", Access::write);
  for (int i = 0; i < 5; ++i) store.add_calibration("n" + std::to_string(i), "{}", "d", i);
  const auto first = store.calibrations(2, std::nullopt);
  REQUIRE(first.size() == 2);
  CHECK(first[0].name == "n4");
  store.add_calibration("late", "{}", "d", 9);  // must not shift the next page
  const auto second = store.calibrations(2, first[1].id);
  CHECK(second[0].name == "n2");
  CHECK(store.calibrations(10, 1).empty());
}

TEST_CASE("the calibrations that extend one are found without reading the others", "[db]") {
  const TemporaryFolder folder;
  {
    Store store(folder / "a.db", Access::write);
    const auto parent = store.add_calibration("parent", "{}", "d", 1);
    const std::string extends =
        R"({"extends":{"calibration":)" + std::to_string(parent) + R"(,"effect":"e"}})";
    const auto first = store.add_calibration("first", extends, "d", 1);
    store.add_calibration("stranger", "no document", "d", 1);
    const auto second = store.add_calibration("second", extends, "d", 1);
    const auto children = store.children(parent);
    REQUIRE(children.size() == 2);
    CHECK(children[0].id == first);
    CHECK(children[1].id == second);
    CHECK(store.children(first).empty());
  }
  Connection connection(folder / "a.db", Connection::Mode::read);
  auto plan =
      connection.prepare("EXPLAIN QUERY PLAN SELECT id FROM calibration WHERE parent_id = 1");
  REQUIRE(plan.step());
  CHECK_THAT(plan.text(3), Catch::Contains("calibration_by_parent"));
}

TEST_CASE("the first answer to a question stays", "[db]") {
  const TemporaryFolder folder;
  Store store(folder / "a.db", Access::write);
  CHECK(store.add_evaluation(evaluation("k")));
  EvaluationRecord other = evaluation("k");
  other.answer = "another";
  CHECK_FALSE(store.add_evaluation(other));
  CHECK(store.evaluation("k")->answer == "answer of k");
  CHECK(store.evaluation("k")->seconds == 1.5);
  CHECK_FALSE(store.evaluation("l").has_value());
}

TEST_CASE("a calibration's evaluations come in the order of work", "[db]") {
  const TemporaryFolder folder;
  Store store(folder / "a.db", Access::write);
  const auto id = store.add_calibration("n", "{}", "d", 1);
  for (const char* key : {"a", "b", "c"}) store.add_evaluation(evaluation(key));
  store.note_used(id, 0, {"c", "a"});
  store.note_used(id, 0, {"c", "a", "b"});  // replayed
  const auto used = store.used(id, 10, std::nullopt);
  REQUIRE(used.size() == 3);
  CHECK(used[0].evaluation.key == "c");
  CHECK(used[2].evaluation.key == "b");
  CHECK(store.used(id, 10, 1).size() == 1);
}

TEST_CASE("what a run that was cut off had used is not listed beside what the next one uses",
          "[db]") {
  const TemporaryFolder folder;
  Store store(folder / "a.db", Access::write);
  const auto id = store.add_calibration("n", "{}", "d", 1);
  const auto diagnosis = store.add_diagnosis(id, "{}", 1);
  const std::vector<std::string> former{"a", "b", "c", "d"};
  for (const std::string& key : former) store.add_evaluation(evaluation(key));
  for (const char* key : {"A", "B", "C"}) store.add_evaluation(evaluation(key));
  const auto keys = [](const std::vector<UsedEvaluation>& used) {
    std::vector<std::string> result;
    for (const auto& one : used) result.push_back(one.evaluation.key);
    return result;
  };
  store.note_used(id, 0, former);
  store.note_used_by_diagnosis(diagnosis, 0, former);
  // By another engine, whose search is a shorter one.
  store.note_used(id, 0, {"A", "B"});
  store.note_used_by_diagnosis(diagnosis, 0, {"A", "B"});
  CHECK(keys(store.used(id, 10, std::nullopt)) == std::vector<std::string>{"A", "B"});
  CHECK(keys(store.used_by_diagnosis(diagnosis)) == std::vector<std::string>{"A", "B"});
  store.note_used(id, 2, {"C"});
  CHECK(keys(store.used(id, 10, std::nullopt)) == std::vector<std::string>{"A", "B", "C"});
}

TEST_CASE("a use of an evaluation that is not there is refused whole", "[db]") {
  const TemporaryFolder folder;
  Store store(folder / "a.db", Access::write);
  const auto id = store.add_calibration("n", "{}", "d", 1);
  store.add_evaluation(evaluation("a"));
  CHECK_THROWS_AS(store.note_used(id, 0, {"a", "missing"}), Error);
  CHECK(store.used(id, 10, std::nullopt).empty());
}

TEST_CASE("one process writes at a time, others may read", "[db]") {
  const TemporaryFolder folder;
  Store writer(folder / "a.db", Access::write);
  const auto id = writer.add_calibration("n", "{}", "d", 1);
  CHECK_THROWS_WITH(Store(folder / "a.db", Access::write), Catch::Contains("in use by process"));
  const Store reader(folder / "a.db", Access::read);
  CHECK(reader.calibration(id)->name == "n");
}

TEST_CASE("a reader of nothing, of rubbish and of a newer file is told so", "[db]") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(Store(folder / "none.db", Access::read), Catch::Contains("cannot open"));
  std::ofstream(folder / "empty.db").close();
  CHECK_THROWS_WITH(Store(folder / "empty.db", Access::read), Catch::Contains("schema 0"));
  CHECK_THROWS_WITH(Store(folder / "no" / "such" / "folder.db", Access::write),
                    Catch::Contains("folder exists"));
  std::ofstream(folder / "rubbish.db") << std::string(5000, 'x');
  CHECK_THROWS_WITH(Store(folder / "rubbish.db", Access::write), Catch::Contains("not a database"));
  {
    Connection other(folder / "other.db", Connection::Mode::write);
    other.run("CREATE TABLE t (x)");
  }
  CHECK_THROWS_WITH(Store(folder / "other.db", Access::write), Catch::Contains("another program"));
  { Store store(folder / "newer.db", Access::write); }
  {
    Connection newer(folder / "newer.db", Connection::Mode::write);
    newer.run("PRAGMA user_version = " + std::to_string(newest_schema() + 1));
  }
  CHECK_THROWS_WITH(Store(folder / "newer.db", Access::write), Catch::Contains("newer repose"));
}

TEST_CASE("a verb that the disk has no room for fails, and the store goes on", "[db]") {
  const TemporaryFolder folder;
  const auto file = folder / "a.db";
  EvaluationRecord large = evaluation("large");
  large.answer = std::string(200'000, 'x');
  {
    Store store(file, Access::write);
    store.add_evaluation(evaluation("before"));
    const std::string before = repose::tests::all_rows(file);
    {
      const FileSizeLimit limit(std::filesystem::file_size(file.string() + "-wal") + 8192);
      CHECK_THROWS_WITH(store.add_evaluation(large), Catch::Contains("the disk failed to"));
      CHECK_THROWS_AS(store.add_evaluation(large), Error);
      CHECK_FALSE(store.evaluation("large"));
      CHECK(store.evaluation("before"));
    }
    CHECK(repose::tests::all_rows(file) == before);
    CHECK(store.add_evaluation(large));
  }
  CHECK(Store(file, Access::read).evaluation("large")->answer == large.answer);
  CHECK(examine(file).empty());
}

TEST_CASE("a full database is named as such and stays sound", "[db]") {
  const TemporaryFolder folder;
  Connection capped(folder / "capped.db", Connection::Mode::write);
  migrate(capped);
  capped.run("PRAGMA max_page_count = 60");
  const std::string big(300'000, 'x');
  auto insert = capped.prepare("INSERT INTO evaluation VALUES ('k', 'q', ?, 1.0, 'v', 1)");
  insert.bind(std::string_view(big));
  CHECK_THROWS_WITH(insert.step(), Catch::Contains("disk is full"));
  auto stored = capped.prepare("SELECT count(*) FROM evaluation");
  stored.step();
  CHECK(stored.integer(0) == 0);
  auto check = capped.prepare("PRAGMA integrity_check");
  check.step();
  CHECK(check.text(0) == "ok");
}

TEST_CASE("many threads write without loss", "[db]") {
  const TemporaryFolder folder;
  Store store(folder / "a.db", Access::write);
  {
    std::vector<std::jthread> threads;
    threads.reserve(4);
    for (int t = 0; t < 4; ++t) {
      threads.emplace_back([&store, t] {
        for (int i = 0; i < 25; ++i) {
          store.add_evaluation(evaluation(std::to_string(t) + "-" + std::to_string(i)));
        }
      });
    }
  }
  for (int t = 0; t < 4; ++t) {
    for (int i = 0; i < 25; ++i) {
      CHECK(store.evaluation(std::to_string(t) + "-" + std::to_string(i)).has_value());
    }
  }
}

TEST_CASE("a new file is in WAL mode, with foreign keys that are sound", "[db]") {
  const TemporaryFolder folder;
  { Store store(folder / "a.db", Access::write); }
  Connection connection(folder / "a.db", Connection::Mode::write);
  auto mode = connection.prepare("PRAGMA journal_mode");
  mode.step();
  CHECK(mode.text(0) == "wal");
  auto version = connection.prepare("PRAGMA user_version");
  version.step();
  CHECK(version.integer(0) == newest_schema());
  CHECK_FALSE(connection.prepare("PRAGMA foreign_key_check").step());
}
