#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <system_error>
#include <unistd.h>

#include "db/store.hpp"
#include "server/cli/commands.hpp"
#include "server/cli/exit_code.hpp"
#include "server/cli/input.hpp"
#include "server/cli/interrupt.hpp"
#include "server/cli/output.hpp"
#include "server/cli/study_summary.hpp"
#include "server/json/place.hpp"
#include "server/json/published_study_json.hpp"
#include "server/json/study_result_json.hpp"
#include "server/report/number_text.hpp"
#include "server/report/study_report.hpp"
#include "server/studies/study_runner.hpp"

namespace repose::server {

namespace {

/// A stiff four-sphere kettle may take an hour of a busy core, s.
constexpr double evaluation_time_limit = 6.0 * 3600.0;

/// One line that renews itself on a terminal; elsewhere a line for each trial that was run.
class StudyProgress {
 public:
  explicit StudyProgress(bool live) : live_(live) {}

  void trial(std::string_view part, std::size_t done, std::size_t all, bool stored) {
    if (part != part_) {
      part_ = part;
      start_ = last_;  // the end of the part before
      run_ = 0;
    }
    last_ = Clock::now();
    run_ += stored ? 0 : 1;
    if (stored && done < all) return;
    const double elapsed = std::chrono::duration<double>(last_ - start_).count();
    std::string line = part_ + ": " + std::to_string(done) + " of " + std::to_string(all);
    if (run_ > 0) line += ", " + duration_text(elapsed);
    if (run_ > 0 && done < all) {
      const double each = elapsed / static_cast<double>(run_);
      line += ", left about " + duration_text(each * static_cast<double>(all - done));
    }
    // Return to the first column and clear the line (ECMA-48).
    if (live_) std::cerr << "\r\x1b[K";
    std::cerr << line << (live_ && done < all ? "" : "\n") << std::flush;
  }

 private:
  using Clock = std::chrono::steady_clock;
  const bool live_;
  std::string part_;
  Clock::time_point last_ = Clock::now();
  Clock::time_point start_ = last_;
  std::size_t run_ = 0;
};

db::Store open_store(const std::filesystem::path& database) {
  make_folder_of(database);
  return {database, db::Access::write};
}

void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  if (!file.flush()) {
    throw std::system_error(errno, std::generic_category(), "cannot write " + path.string());
  }
}

std::string command_text(const StudyCommand& command) {
  return "repose study " + command.name + (command.quick ? " --quick" : "");
}

}  // namespace

int study_command(const StudyCommand& command) {
  const bool json = command.form == Form::json;
  const PublishedStudy* study = find_published_study(command.name);
  if (study == nullptr) {
    const auto names = published_study_names();
    return report_error({"there is no study '" + command.name + "'" +
                             did_you_mean(command.name, names) + "; there are " + listed(names),
                         {}},
                        json);
  }
  const auto folder = command.output.empty() ? std::filesystem::path(".") : command.output;
  if (const auto why = make_folder(folder)) return report_error(*why, json);
  const Interrupt interrupt;
  db::Store store = open_store(command.database);
  Workers workers(
      store,
      {.workers = command.workers, .program = own_program(), .time_limit = evaluation_time_limit});
  StudyProgress progress(isatty(STDERR_FILENO) == 1);
  const auto result =
      run_study(*study,
                command.quick ? StudySize::quick : StudySize::full,
                workers,
                interrupt.token(),
                [&](std::string_view part, std::size_t done, std::size_t all, bool stored) {
                  progress.trial(part, done, all, stored);
                });
  const std::string name = study->name + (command.quick ? "-quick" : "");
  const std::string text = print_study_result(result);
  write(command.output / (name + ".json"), text + "\n");
  write(command.output / (name + ".html"),
        print_study_report(result, {command_text(command), time_now()}));
  std::cout << (json ? text + "\n" : print_study_summary(result));
  const std::string path = (command.output / name).string();
  (json ? std::cerr : std::cout) << "\nReport: " << path << ".html\nNumbers: " << path << ".json\n";
  if (result.missing == 0) return exit_code::done;
  std::cerr << "repose: stopped. Every finished evaluation is kept in " << command.database.string()
            << "; the same command goes on where it was.\n";
  return exit_code::interrupted;
}

}  // namespace repose::server
