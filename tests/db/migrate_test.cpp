#include "db/migrate.hpp"

#include <array>
#include <utility>

#include <catch2/catch.hpp>

#include "db/backup.hpp"
#include "db/event_store.hpp"
#include "db/schedule_store.hpp"
#include "db/store.hpp"
#include "tests/support/database_rows.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace repose::db;
using repose::tests::questions_of;
using repose::tests::rows_of;
using repose::tests::TemporaryFolder;

namespace {

/// Rows of every kind: the first schema that has them, and how a program of that time wrote them.
constexpr std::array<std::pair<int, const char*>, 12> rows{{
    {1,
     "INSERT INTO evaluation (key, question, answer, seconds, engine_version, created_at) VALUES "
     "('a', 'qa', 'aa', 1.5, 'v', 1), ('b', 'qb', 'ab', 2.5, 'v', 2)"},
    {1,
     "INSERT INTO calibration (id, name, state, created_at, started_at, finished_at, request, "
     "request_digest, progress, fit, misfit, error) VALUES "
     "(1, 'one', 'done', 1, 2, 3, '{}', 'd1', '{\"stage\":1}', '{}', 0.5, NULL), "
     "(2, 'two', 'running', 4, 5, NULL, '{\"extends\":{\"calibration\":1,\"effect\":\"e\"}}', "
     "'d2', NULL, NULL, NULL, NULL), "
     "(3, 'three', 'failed', 7, 8, 9, '{}', 'd3', NULL, NULL, NULL, 'why'), "
     "(4, 'four', 'cancelled', 10, NULL, 11, '{}', 'd4', NULL, NULL, NULL, NULL), "
     "(5, 'five', 'running', 12, 13, NULL, '{}', 'd5', NULL, NULL, NULL, NULL), "
     "(6, 'six', 'queued', 14, NULL, NULL, 'no document', 'd6', NULL, NULL, NULL, NULL); "
     "UPDATE calibration SET progress = '{\"stage\":2,\"predicted\":[]}' WHERE id = 5"},
    {12, "UPDATE calibration SET parent_id = 1 WHERE id = 2"},
    {1,
     "UPDATE calibration SET state = 'done', finished_at = 6, fit = '{}', misfit = 0.25 "
     "WHERE id = 2"},
    {1,
     "INSERT INTO calibration_evaluation (calibration_id, ordinal, key) VALUES (1, 0, 'a'), "
     "(1, 1, 'b'), (2, 0, 'a')"},
    {2,
     "INSERT INTO diagnosis (id, calibration_id, state, created_at, finished_at, request, result) "
     "VALUES (1, 1, 'done', 4, 5, '{}', '{}'), (2, 1, 'queued', 6, NULL, '{}', NULL); "
     "INSERT INTO diagnosis_evaluation (diagnosis_id, ordinal, key) VALUES (1, 0, 'b'), (1, 1, "
     "'a')"},
    {4,
     "INSERT INTO kept_reply (key, request_digest, created_at, reply) VALUES ('k', 'd', 1, '{}')"},
    {5,
     "INSERT INTO measurement_set (id, name, version, material, created_at, measurements) VALUES "
     "(1, 'may', 1, 'soybean', 1, '[]'), (2, 'may', 2, 'soybean', 2, '[1]'); "
     "INSERT INTO calibration_source (calibration_id, material, measurement_set_id) VALUES "
     "(1, 'soybean', 2), (3, NULL, NULL)"},
    {6, "INSERT INTO material (name, created_at, document) VALUES ('mine', 1, '{}')"},
    {7,
     "INSERT INTO schedule (id, name, created_at, request) VALUES (1, 'nightly', 1, '{}'); "
     "INSERT INTO night (id, schedule_id, planned_at, started_at, state, calibration_id) VALUES "
     "(1, 1, 10, 11, 'running', 1), (2, 1, 20, 21, 'running', NULL); "
     "UPDATE night SET state = 'done', outcome = 'first', finished_at = 12, diagnosis_id = 1, "
     "result = '{\"alarms\":[{}]}' WHERE id = 1; "
     "INSERT INTO promotion (schedule_id, calibration_id, night_id, promoted_at, reason) VALUES "
     "(1, 1, 1, 12, 'the first')"},
    {8,
     "INSERT INTO attempt (key, n, executor, state, started_at) VALUES "
     "('a', 0, 'inline', 'running', 1), ('a', 1, 'inline', 'running', 2); "
     "UPDATE attempt SET state = 'crashed', finished_at = 2 WHERE n = 0; "
     "UPDATE attempt SET state = 'answered', finished_at = 3 WHERE n = 1"},
    {9,
     "INSERT INTO webhook (id, created_at, url, kinds, secret, state, last_event, next_at, "
     "account) VALUES (1, 1, 'https://a', '[]', 's', 'parked', 2, 3, 'it answered no')"},
}};

void make(const std::filesystem::path& database, std::int64_t schema) {
  Connection connection(database, Connection::Mode::write);
  connection.run("PRAGMA foreign_keys = ON");
  migrate(connection, schema);
  for (const auto& [since, sql] : rows) {
    if (since <= schema) connection.run(sql);
  }
}

std::int64_t schema_of(const std::filesystem::path& database) {
  Connection connection(database, Connection::Mode::read);
  Statement version = connection.prepare("PRAGMA user_version");
  version.step();
  return version.integer(0);
}

}  // namespace

TEST_CASE("a database of every earlier schema is brought up to date with all of its rows", "[db]") {
  for (std::int64_t schema = 1; schema < newest_schema(); ++schema) {
    INFO("schema " << schema);
    const TemporaryFolder folder;
    const auto database = folder / "a.db";
    make(database, schema);
    const auto questions = questions_of(database);
    const std::string before = rows_of(database, questions);
    {
      const Store store(database, Access::write);
      CHECK(store.used(1, 10, std::nullopt).size() == 2);
      const auto children = store.children(1);
      REQUIRE(children.size() == 1);
      CHECK(children[0].name == "two");
    }
    CHECK(schema_of(database) == newest_schema());
    CHECK(rows_of(database, questions) == before);
    CHECK(examine(database) == std::vector<std::string>{});
  }
}

TEST_CASE("a night that ran when its database was brought up to date ends as every other", "[db]") {
  const TemporaryFolder folder;
  const auto database = folder / "a.db";
  make(database, 12);
  {
    Store store(database, Access::write);
    ScheduleStore nights(store);
    CHECK(nights.end_night(2, {.state = "done", .outcome = "unchanged", .result = "{}"}, 22));
    CHECK(EventStore(store).events(std::nullopt, 0, 100).back().kind == "night.unchanged");
    CHECK(nights.begin_night(1, 30, 31) == 3);
    CHECK_THROWS_AS(nights.begin_night(99, 40, 41), Error);  // a schedule that is not there
  }
  Connection connection(database, Connection::Mode::write);
  CHECK_THROWS_AS(connection.run("UPDATE night SET result = '[]' WHERE id = 1"), Error);
  CHECK_THROWS_AS(connection.run("UPDATE night SET state = 'done', outcome = 'well', "
                                 "finished_at = 32 WHERE id = 3"),
                  Error);
}

TEST_CASE("before a database is changed for a newer program it is copied, once", "[db]") {
  const TemporaryFolder folder;
  const auto database = folder / "a.db";
  make(database, 1);
  const std::string before = repose::tests::all_rows(database);
  for (int opened = 0; opened < 2; ++opened) const Store store(database, Access::write);
  const auto copy = folder / "a.db.before-1";
  REQUIRE(std::filesystem::exists(copy));
  CHECK(schema_of(copy) == 1);
  CHECK(repose::tests::all_rows(copy) == before);
  CHECK_FALSE(std::filesystem::exists(folder / "a.db.before-2"));
  { const Store store(folder / "new.db", Access::write); }
  CHECK_FALSE(std::filesystem::exists(folder / "new.db.before-1"));
}

TEST_CASE("a database that cannot be copied is not migrated", "[db]") {
  const TemporaryFolder folder;
  const auto database = folder / "a.db";
  make(database, 1);
  std::filesystem::create_directories(folder / "a.db.before-1.part" / "in the way");
  CHECK_THROWS(Store(database, Access::write));
  CHECK(schema_of(database) == 1);
}
