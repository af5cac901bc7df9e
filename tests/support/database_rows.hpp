/// What stands in a database, as text that can be compared.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "db/sqlite.hpp"

namespace repose::tests {

/// One question for each table: every row, with the columns that there are now.
inline std::vector<std::string> questions_of(const std::filesystem::path& database) {
  db::Connection connection(database, db::Connection::Mode::read);
  std::vector<std::string> questions;
  db::Statement table = connection.prepare(
      "SELECT name FROM sqlite_schema WHERE type = 'table' AND name NOT LIKE 'sqlite_%' "
      "ORDER BY name");
  while (table.step()) {
    std::string columns;
    for (db::Statement one =
             connection.prepare("SELECT name FROM pragma_table_info('" + table.text(0) + "')");
         one.step();) {
      columns += (columns.empty() ? "quote(" : "||','||quote(") + one.text(0) + ")";
    }
    questions.push_back("SELECT '" + table.text(0) + ": '||" + columns + " FROM " + table.text(0) +
                        " ORDER BY 1");
  }
  return questions;
}

inline std::string rows_of(const std::filesystem::path& database,
                           const std::vector<std::string>& questions) {
  db::Connection connection(database, db::Connection::Mode::read);
  std::string text;
  for (const std::string& question : questions) {
    db::Statement row = connection.prepare(question);
    while (row.step()) text += row.text(0) + "\n";
  }
  return text;
}

inline std::string all_rows(const std::filesystem::path& database) {
  return rows_of(database, questions_of(database));
}

}  // namespace repose::tests
