#include <algorithm>
#include <iostream>

#include "calibrator/bench/bench_run.hpp"
#include "server/bench/calibrator_bench.hpp"
#include "server/cli/commands.hpp"
#include "server/cli/exit_code.hpp"
#include "server/cli/text_table.hpp"
#include "server/json/calibrator_bench_json.hpp"
#include "server/report/number_text.hpp"

namespace repose::server {

namespace {

std::string count_text(const std::optional<int>& count) {
  return count ? std::to_string(*count) : "-";
}

std::string table_of(const std::vector<BenchCase>& cases) {
  TextTable table({"case", "method", "median", "p90", "within 40"}, "ll");
  for (const BenchCase& one : cases) {
    for (const BenchMethod& method : one.methods) {
      table.row({std::string(one.name),
                 std::string(method.name),
                 count_text(method.median),
                 count_text(method.p90),
                 fixed_text(100.0 * method.share_within_40, 0) + " %"});
    }
  }
  return table.str();
}

template <class Names>
std::size_t index_in(const Names& names, const std::string& name) {
  return static_cast<std::size_t>(std::ranges::find(names, std::string_view(name)) - names.begin());
}

void print(Form form, const std::string& json, const std::string& text) {
  std::cout << (form == Form::json ? json : text) << "\n";
}

std::size_t case_named(const std::string& name) {
  std::cerr << "repose: case " << name << "\n";
  return index_in(calibrator::bench::case_names, name);
}

int honesty_command(const BenchCalibratorCommand& command) {
  std::vector<HonestyOfCase> cases;
  TextTable table({"case",
                   "studies",
                   "in 90 % posterior",
                   "in 95 % profile",
                   "misfit shown / fresh",
                   "false hits"},
                  "l");
  for (const std::string& name : command.cases) {
    cases.push_back({name, calibrator::bench::honesty_of_case(case_named(name), command.honesty)});
    const auto& found = cases.back().honesty;
    table.row({name,
               std::to_string(found.studies),
               fixed_text(100.0 * found.posterior_90, 1) + " %",
               fixed_text(100.0 * found.profile_95, 1) + " %",
               fixed_text(found.misfit_ratio, 2),
               std::to_string(found.false_hits) + " of " + std::to_string(found.declared)});
  }
  print(command.form,
        print_honesty(cases),
        table.str() +
            "\nshares of all free parameters of all studies; truth anywhere within the "
            "bounds, targets\noff by a draw of their standard errors; fresh: mean of 8 "
            "runs at the best set");
  return exit_code::done;
}

int warm_start_command(const BenchCalibratorCommand& command) {
  std::vector<WarmStartOfCase> cases;
  TextTable table({"case", "stored runs", "median", "p90"}, "l");
  for (const std::string& name : command.cases) {
    std::vector<calibrator::bench::BenchRun> runs;
    for (const int solved :
         calibrator::bench::warm_start_of_case(case_named(name), command.seeds, command.warm_start)
             .evaluations) {
      runs.emplace_back().solved_at = solved;
    }
    cases.push_back({name,
                     command.warm_start,
                     calibrator::bench::quantile(runs, 0.5),
                     calibrator::bench::quantile(runs, 0.9)});
    table.row({name,
               std::to_string(command.warm_start),
               count_text(cases.back().median),
               count_text(cases.back().p90)});
  }
  print(command.form,
        print_warm_start(cases),
        table.str() +
            "\nnew evaluations until solved, after stored runs of a study with another "
            "truth; over " +
            std::to_string(command.seeds) + " seeds");
  return exit_code::done;
}

}  // namespace

int bench_calibrator_command(const BenchCalibratorCommand& command) {
  if (command.honesty > 0) return honesty_command(command);
  if (command.warm_start > 0) return warm_start_command(command);
  std::vector<calibrator::Method> methods;
  for (const std::string& name : command.methods) {
    methods.push_back(static_cast<calibrator::Method>(index_in(calibrator::method_names, name)));
  }
  std::vector<BenchCase> cases;
  for (const std::string& name : command.cases) {
    cases.push_back(bench_case(case_named(name), methods, command.seeds));
  }
  if (command.form == Form::json) {
    std::cout << print_calibrator_bench(cases) << "\n";
  } else {
    std::cout << table_of(cases)
              << "\nevaluations until the recommended set is truly within one standard error of "
                 "every\ntarget, and stays so in 12 of the next 15; over "
              << command.seeds << " seeds; - where not reached\n";
  }
  return exit_code::done;
}

}  // namespace repose::server
