/// CSV (RFC 4180): text <-> rows of cells.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace repose::server {

using CsvRows = std::vector<std::vector<std::string>>;

/// A row as it was read.
struct CsvRow {
  std::size_t line = 0;  ///< from 1, on which it begins
  std::vector<std::string> cells;
};

/// The rows of a text; blank lines are none. A quote that is not closed ends with the text.
std::vector<CsvRow> read_csv(std::string_view text);

/// Quoted where it must be.
std::string print_csv(const CsvRows& rows);

}  // namespace repose::server
