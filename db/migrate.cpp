#include "db/migrate.hpp"

#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "db/store.hpp"

/// The files of db/migrations in the order of their names: name, text.
extern const std::span<const std::pair<std::string_view, std::string_view>> embedded_migrations;

namespace repose::db {

namespace {

std::int64_t pragma(Connection& connection, const std::string& name) {
  Statement statement = connection.prepare("PRAGMA " + name);
  return statement.step() ? statement.integer(0) : 0;
}

bool empty(Connection& connection) {
  Statement statement = connection.prepare("SELECT count(*) FROM sqlite_schema");
  statement.step();
  return statement.integer(0) == 0;
}

}  // namespace

std::int64_t newest_schema() { return static_cast<std::int64_t>(embedded_migrations.size()); }

void check_schema(Connection& connection) {
  if (empty(connection)) return;
  if (pragma(connection, "application_id") != application_id) {
    throw Error(0,
                connection.file().string() +
                    " is a database of another program; choose another file with --db");
  }
  const std::int64_t version = pragma(connection, "user_version");
  if (version > newest_schema()) {
    throw Error(0,
                "database " + connection.file().string() + " has schema " +
                    std::to_string(version) + ", this program knows up to " +
                    std::to_string(newest_schema()) +
                    ": a newer repose has made it; use that one, or another file with --db");
  }
}

void check_made(Connection& connection) {
  check_schema(connection);
  if (empty(connection)) {
    throw Error(0, connection.file().string() + " is empty: it holds no database of this program");
  }
}

void check_current(Connection& connection) {
  check_schema(connection);
  const std::int64_t version = pragma(connection, "user_version");
  if (version < newest_schema()) {
    throw Error(0,
                "database " + connection.file().string() + " has schema " +
                    std::to_string(version) + ", this program reads " +
                    std::to_string(newest_schema()) +
                    ": calibrate or serve with it once, which brings it up to date");
  }
}

bool is_older(Connection& connection) {
  const std::int64_t version = pragma(connection, "user_version");
  return version > 0 && version < newest_schema();
}

void migrate(Connection& connection, std::int64_t up_to) {
  check_schema(connection);
  // A table that is made again is dropped while others refer to it. Whether what they refer to is
  // there is looked up at each end; the setting itself changes nothing within a transaction.
  const std::int64_t watched = pragma(connection, "foreign_keys");
  connection.run("PRAGMA foreign_keys = OFF");
  for (std::int64_t version = pragma(connection, "user_version"); version < up_to; ++version) {
    Transaction transaction(connection);
    connection.run(std::string(embedded_migrations[static_cast<std::size_t>(version)].second));
    connection.run("PRAGMA application_id = " + std::to_string(application_id));
    connection.run("PRAGMA user_version = " + std::to_string(version + 1));
    if (connection.prepare("PRAGMA foreign_key_check").step()) {
      throw Error(0, "database " + connection.file().string() + " has rows that refer to nothing");
    }
    transaction.commit();
  }
  connection.run("PRAGMA foreign_keys = " + std::to_string(watched));
}

}  // namespace repose::db
