#include "server/cli/next_command.hpp"

#include <vector>

#include "server/report/words.hpp"

namespace repose::server {

namespace {

std::string typed(const std::vector<std::string>& words) {
  std::string text = "repose";
  for (const std::string& word : words) text += " " + shell_word(word);
  return text;
}

}  // namespace

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
  return typed(words);
}

std::string queued_text(std::int64_t id, Cancelled what, const std::filesystem::path& database) {
  std::vector<std::string> words{"cancel", std::to_string(id)};
  if (what == Cancelled::diagnosis) words.emplace_back("--diagnosis");
  words.insert(words.end(), {"--db", database.string()});
  return "It is queued: `repose serve` on this database goes on with it. To end it instead:\n  " +
         typed(words) + "\n";
}

std::string after_fit(const CalibrationDocument& document, const std::filesystem::path& database) {
  if (!document.calibration || !document.fit) return "";
  if (verdict(*document.calibration, *document.fit) != Verdict::missed) return "";
  const auto of_it = [&](const char* command) {
    return "`" + typed({command, std::to_string(document.id), "--db", database.string()}) + "`";
  };
  return "Next: " + of_it("compare") + " shows where the model misses, " + of_it("diagnose") +
         " which effect it lacks.\n";
}

std::string after_diagnosis(std::int64_t calibration,
                            const calibrator::Diagnosis& diagnosis,
                            const std::filesystem::path& database) {
  using enum calibrator::DiagnosisVerdict;
  const bool is_named =
      diagnosis.verdict == named || diagnosis.verdict == family || diagnosis.verdict == pair;
  if (!is_named || diagnosis.refits.empty()) return "";
  const calibrator::Refit& best = diagnosis.refits.front();
  const std::string& effect = diagnosis.effects.at(best.effects.front()).suspect.name;
  return "Next: `" +
         typed({"extend",
                std::to_string(calibration),
                "--effect",
                effect,
                "--db",
                database.string()}) +
         "` adds " + (best.effects.size() > 1 ? "the first of them" : "it") +
         " and calibrates again.\n";
}

}  // namespace repose::server
