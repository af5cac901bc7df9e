#include "db/backup.hpp"

#include <algorithm>
#include <array>
#include <system_error>
#include <utility>

#include "db/lock.hpp"
#include "db/migrate.hpp"
#include "db/move.hpp"
#include "db/sqlite.hpp"
#include "db/store.hpp"

namespace repose::db {

namespace {

namespace fs = std::filesystem;

/// Questions whose every row is something wrong; the sentence ends with the row's first column.
constexpr std::array<std::pair<const char*, const char*>, 10> invariants{{
    {"done without a fit: calibration ",
     "SELECT id FROM calibration WHERE state = 'done' AND fit IS NULL"},
    {"ended before it began: calibration ",
     "SELECT id FROM calibration WHERE finished_at < started_at OR started_at < created_at"},
    {"evaluations missing between those used by calibration ",
     "SELECT c.id FROM calibration c JOIN calibration_evaluation u ON u.calibration_id = c.id "
     "WHERE c.state = 'done' GROUP BY c.id HAVING max(u.ordinal) + 1 <> count(*)"},
    {"done without a result: diagnosis ",
     "SELECT id FROM diagnosis WHERE state = 'done' AND result IS NULL"},
    {"done without a result: night ",
     "SELECT id FROM night WHERE state = 'done' AND result IS NULL"},
    {"promoted without being done: calibration ",
     "SELECT c.id FROM promotion p JOIN calibration c ON c.id = p.calibration_id "
     "WHERE c.state <> 'done'"},
    {"more than one running night of schedule ",
     "SELECT schedule_id FROM night WHERE state = 'running' GROUP BY schedule_id "
     "HAVING count(*) > 1"},
    {"empty question or answer of evaluation ",
     "SELECT key FROM evaluation WHERE question = '' OR answer = ''"},
    {"answered, but its answer is missing: attempt at ",
     "SELECT a.key FROM attempt a LEFT JOIN evaluation e ON e.key = a.key "
     "WHERE a.state = 'answered' AND e.key IS NULL"},
    {"numbers are missing between the attempts at ",
     "SELECT key FROM attempt GROUP BY key HAVING max(n) + 1 <> count(*)"},
}};

/// Each row of a check of SQLite's own that is not "ok".
void check(Connection& connection, const char* pragma, std::vector<std::string>& problems) {
  Statement row = connection.prepare(std::string("PRAGMA ") + pragma);
  while (row.step()) {
    if (row.text(0) != "ok") problems.push_back(std::string(pragma) + ": " + row.text(0));
  }
}

std::vector<std::string> damage(Connection& connection) {
  std::vector<std::string> problems;
  try {
    check(connection, "integrity_check", problems);
    check(connection, "foreign_key_check", problems);
  } catch (const Error& error) {
    problems.emplace_back(error.what());  // so damaged that it cannot be checked
  }
  return problems;
}

/// A whole copy in one file, without a log beside it, that has been checked.
void copy_checked(const fs::path& from, const fs::path& to) {
  fs::remove(to);  // left by a copy that was cut off
  try {
    Connection source(from, Connection::Mode::read);
    check_made(source);
    Connection target(to, Connection::Mode::write);
    source.copy_to(target);
    target.run("PRAGMA journal_mode = DELETE");
    const auto problems = damage(target);
    if (!problems.empty()) {
      throw Error(0, from.string() + " is damaged, and so would be its copy: " + problems.front());
    }
  } catch (...) {
    std::error_code ignored;
    fs::remove(to, ignored);
    throw;
  }
}

fs::path beside(fs::path file, const char* suffix) { return file += suffix; }

/// What belongs to a database: SQLite finds the other files by the name of the first. The first one
/// moves first, for without it nobody opens the others.
constexpr std::array<const char*, 3> suffixes{"", "-wal", "-shm"};

bool any_there(const fs::path& database) {
  return std::any_of(suffixes.begin(), suffixes.end(), [&](const char* suffix) {
    return fs::exists(beside(database, suffix));
  });
}

/// Where something is kept beside a database: the first name that is free.
fs::path kept_name(const fs::path& database, const std::string& suffix) {
  for (int number = 1;; ++number) {
    fs::path name = beside(database, (suffix + std::to_string(number)).c_str());
    if (!any_there(name)) return name;
  }
}

/// Moves a database away as it is, without opening it: it may be damaged, and its log holds what
/// was not yet moved into it. A log that stayed would be taken for the next database's.
fs::path set_aside(const fs::path& database) {
  if (!any_there(database)) return {};
  fs::path kept = kept_name(database, ".replaced-");
  for (const char* suffix : suffixes) {
    const fs::path file = beside(database, suffix);
    if (fs::exists(file)) move_to(file, beside(kept, suffix));
  }
  return kept;
}

}  // namespace

void back_up(const fs::path& database, const fs::path& file) {
  if (!fs::exists(database)) throw Error(0, "there is no database " + database.string());
  if (fs::exists(file)) throw Error(0, file.string() + " is there already: choose another name");
  copy_checked(database, beside(file, ".part"));
  move_to(beside(file, ".part"), file);
}

fs::path keep_copy(const fs::path& database) {
  fs::path copy = kept_name(database, ".before-");
  back_up(database, copy);
  return copy;
}

fs::path restore(const fs::path& file, const fs::path& database) {
  if (!fs::exists(file)) throw Error(0, "there is no backup " + file.string());
  const FileLock lock(database);
  const fs::path copy = beside(database, ".part");
  copy_checked(file, copy);
  try {
    fs::path kept = set_aside(database);
    move_to(copy, database);
    return kept;
  } catch (...) {
    std::error_code ignored;
    fs::remove(copy, ignored);
    throw;
  }
}

std::vector<std::string> examine(const fs::path& database, const Digest& digest) {
  if (!fs::exists(database)) throw Error(0, "there is no database " + database.string());
  Connection connection(database, Connection::Mode::read);
  check_current(connection);
  std::vector<std::string> problems = damage(connection);
  if (!problems.empty()) return problems;  // what rows say of each other means nothing then
  for (const auto& [sentence, question] : invariants) {
    Statement row = connection.prepare(question);
    while (row.step()) problems.push_back(sentence + row.text(0));
  }
  if (!digest) return problems;
  Statement row = connection.prepare("SELECT key, engine_version, question FROM evaluation");
  while (row.step()) {
    // What follows a slash is not the question's: how the host failed on it.
    const std::string key = row.text(0).substr(0, row.text(0).find('/'));
    if (digest(row.text(1) + "\n" + row.text(2)) == key) continue;
    problems.push_back("key that is not its question's: evaluation " + row.text(0));
  }
  return problems;
}

}  // namespace repose::db
