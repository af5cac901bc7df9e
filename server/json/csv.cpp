#include "server/json/csv.hpp"

#include <utility>

namespace repose::server {

namespace {

/// One letter after the other; what is quoted may hold anything.
class Reader {
 public:
  std::vector<CsvRow> read(std::string_view text) {
    for (std::size_t i = 0; i < text.size(); ++i) {
      const char letter = text[i];
      if (letter == '\n') ++line_;
      const bool doubled = i + 1 < text.size() && text[i + 1] == '"';
      if (quoted_ && letter == '"' && doubled) {
        cell_ += text[++i];
      } else if (letter == '"') {
        quoted_ = !quoted_;
      } else if (quoted_ || (letter != ',' && letter != '\n' && letter != '\r')) {
        cell_ += letter;
      } else if (letter == ',') {
        row_.cells.push_back(std::exchange(cell_, {}));
      } else if (letter == '\n') {
        end_row();
      }
    }
    end_row();
    return std::move(rows_);
  }

 private:
  void end_row() {
    row_.cells.push_back(std::exchange(cell_, {}));
    if (row_.cells.size() > 1 || !row_.cells[0].empty()) rows_.push_back(std::move(row_));
    row_ = {line_, {}};
  }

  std::size_t line_ = 1;
  std::vector<CsvRow> rows_;
  CsvRow row_{line_, {}};
  std::string cell_;
  bool quoted_ = false;
};

std::string quoted(const std::string& cell) {
  if (cell.find_first_of(",\"\r\n") == std::string::npos) return cell;
  std::string text = "\"";
  for (const char letter : cell) {
    if (letter == '"') text += '"';
    text += letter;
  }
  return text + "\"";
}

}  // namespace

std::vector<CsvRow> read_csv(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // a mark that spreadsheets write
  return Reader().read(text);
}

std::string print_csv(const CsvRows& rows) {
  std::string text;
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) text += (i > 0 ? "," : "") + quoted(row[i]);
    text += "\r\n";
  }
  return text;
}

}  // namespace repose::server
