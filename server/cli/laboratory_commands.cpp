// What the laboratory costs, what its draft fidelity is worth, how its observables move.
#include <filesystem>
#include <iostream>
#include <unistd.h>

#include "db/store.hpp"
#include "server/cli/commands.hpp"
#include "server/cli/exit_code.hpp"
#include "server/cli/input.hpp"
#include "server/cli/interrupt.hpp"
#include "server/cli/output.hpp"
#include "server/cli/reference_grain.hpp"
#include "server/cli/text_table.hpp"
#include "server/json/laboratory_json.hpp"
#include "server/laboratory/fidelity_pairs.hpp"
#include "server/laboratory/speed.hpp"
#include "server/laboratory/trends.hpp"
#include "server/report/frame_files.hpp"
#include "server/report/number_text.hpp"
#include "server/report/trends_report.hpp"

namespace repose::server {

namespace {

constexpr int reference_seeds = 5;  // of the trends: they tell the scatter

std::string percent(double share) { return fixed_text(100.0 * share, 0) + " %"; }

void print_table(const std::vector<ExperimentCost>& costs) {
  TextTable table({"experiment", "draft, s", "share", "standard, s", "share", "draft / standard"});
  const ExperimentCost all = sum(costs);
  const auto row = [&](const ExperimentCost& cost) {
    table.row({cost.experiment,
               fixed_text(cost.seconds[0], 2),
               percent(cost.seconds[0] / all.seconds[0]),
               fixed_text(cost.seconds[1], 2),
               percent(cost.seconds[1] / all.seconds[1]),
               percent(cost.grain_steps[0] / cost.grain_steps[1])});
  };
  for (const ExperimentCost& cost : costs) row(cost);
  row(all);
  std::cout << table.str()
            << "\nreference grain, 1.04 MPa, one replicate; processor time of one core, the last "
               "column in\nsphere-steps, which are the same on every machine\n";
}

void print_table(const std::vector<FidelityPairs>& pairs) {
  TextTable table({"observable", "draft less standard", "deviation", "unit", "sets", "cost"});
  for (const FidelityPairs& one : pairs) {
    const DraftBias bias = one.bias();
    const double factor = one.observable.unit.factor;
    table.row({one.experiment + "." + std::string(one.observable.name),
               number_text(bias.mean / factor, 3),
               number_text(bias.deviation / factor, 2),
               std::string(one.observable.unit.symbol),
               std::to_string(bias.sets),
               percent(one.cost)});
  }
  std::cout << table.str()
            << "\none seed a set at both fidelities: the deviation holds the scatter of both; cost "
               "in sphere-steps\n";
}

/// A line for each run that was done, on standard error.
LaboratoryObserver progress() {
  return [](std::size_t done, std::size_t all, bool stored) {
    if (stored && done < all) return;
    const bool live = isatty(STDERR_FILENO) == 1;
    // Return to the first column and clear the line (ECMA-48).
    std::cerr << (live ? "\r\x1b[K" : "") << "repose: " << done << " of " << all
              << (live && done < all ? "" : "\n") << std::flush;
  };
}

/// Answers through the store of a database, so that what was interrupted goes on.
template <class Ask>
auto with_workers(const LaboratoryCommand& command, const Interrupt& interrupt, const Ask& ask) {
  make_folder_of(command.database);
  db::Store store(command.database, db::Access::write);
  Workers workers(store, {.workers = command.workers, .program = own_program()});
  return ask(workers, interrupt.token());
}

int end(const LaboratoryCommand& command, const Interrupt& interrupt) {
  if (!interrupt.happened()) return exit_code::done;
  std::cerr << "repose: stopped. Every finished run is kept in " << command.database.string()
            << "; the same command goes on where it was.\n";
  return exit_code::interrupted;
}

}  // namespace

int bench_laboratory_command(Form form) {
  const Interrupt interrupt;
  const auto costs = laboratory_costs(reference_grain(), interrupt.token());
  if (form == Form::json) {
    std::cout << print_costs(costs) << "\n";
  } else {
    print_table(costs);
  }
  return exit_code::done;
}

int bench_fidelity_command(const LaboratoryCommand& command) {
  const Interrupt interrupt;
  const auto grains = spread_grains(reference_grain(), static_cast<std::size_t>(command.sets));
  const auto pairs =
      with_workers(command, interrupt, [&](Workers& workers, const std::stop_token& stop) {
        return fidelity_pairs(grains, workers, stop, progress());
      });
  if (command.form == Form::json) {
    std::cout << print_fidelity_pairs(pairs) << "\n";
  } else {
    print_table(pairs);
  }
  return end(command, interrupt);
}

int trends_command(const LaboratoryCommand& command) {
  const auto folder = command.output.empty() ? std::filesystem::path(".") : command.output;
  if (const auto why = make_folder(folder)) {
    return report_error(*why, command.form == Form::json);
  }
  const Interrupt interrupt;
  const Trends trends =
      with_workers(command, interrupt, [&](Workers& workers, const std::stop_token& stop) {
        return measure_trends(reference_grain(), reference_seeds, workers, stop, progress());
      });
  const std::string text = print_trends(trends);
  write_file(command.output / "trends.json", text + "\n");
  write_file(command.output / "trends.html", print_trends_report(trends, "repose trends"));
  if (command.form == Form::json) {
    std::cout << text << "\n";
  } else {
    std::cout << "Page: " << (command.output / "trends.html").string()
              << "\nNumbers: " << (command.output / "trends.json").string() << "\n";
  }
  return end(command, interrupt);
}

}  // namespace repose::server
