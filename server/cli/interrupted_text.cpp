#include "server/cli/interrupted_text.hpp"

#include <vector>

namespace repose::server {

std::string shell_word(std::string_view word) {
  // Everything else may mean something to a shell (POSIX, Shell Command Language, 2.2).
  constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=:,+@%";
  if (!word.empty() && word.find_first_not_of(plain) == word.npos) return std::string(word);
  std::string text = "'";
  for (const char letter : word) {
    if (letter == '\'') {
      text += R"('\'')";
    } else {
      text += letter;
    }
  }
  return text + "'";
}

std::string resume_words(const CalibrateCommand& command) {
  std::vector<std::string> words = command.asked_as;
  if (words.empty()) words = {"calibrate", command.study.string()};
  words.insert(words.end(), {"--db", command.database.string()});
  if (command.workers > 0) {
    words.insert(words.end(), {"--workers", std::to_string(command.workers)});
  }
  if (!command.report.empty()) words.insert(words.end(), {"--report", command.report.string()});
  if (!command.pictures) words.emplace_back("--no-pictures");
  if (command.form == Form::json) words.emplace_back("--json");
  std::string text = "repose";
  for (const std::string& word : words) text += " " + shell_word(word);
  return text;
}

std::string queued_text(std::int64_t id, Cancelled what, const std::filesystem::path& database) {
  return "It is queued: `repose serve` on this database goes on with it. To end it instead:\n"
         "  repose cancel " +
         std::to_string(id) + (what == Cancelled::diagnosis ? " --diagnosis" : "") + " --db " +
         shell_word(database.string()) + "\n";
}

}  // namespace repose::server
