/// TextTable: columns that line up on a terminal.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace repose::server {

class TextTable {
 public:
  /// `sides` has a letter for each column: l, set to the left, or r, which it is without a letter.
  explicit TextTable(std::vector<std::string> head, std::string_view sides = "l")
      : rows_{std::move(head)}, sides_(sides) {}

  void row(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
  /// Lines end with a newline; the first holds the heads.
  [[nodiscard]] std::string str() const;

 private:
  std::vector<std::vector<std::string>> rows_;
  std::string sides_;
};

/// Letters that a UTF-8 text takes on a terminal.
std::size_t letters(std::string_view text);

}  // namespace repose::server
