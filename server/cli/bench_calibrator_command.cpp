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

}  // namespace

int bench_calibrator_command(const BenchCalibratorCommand& command) {
  std::vector<calibrator::Method> methods;
  for (const std::string& name : command.methods) {
    methods.push_back(static_cast<calibrator::Method>(index_in(calibrator::method_names, name)));
  }
  std::vector<BenchCase> cases;
  for (const std::string& name : command.cases) {
    std::cerr << "repose: case " << name << "\n";
    cases.push_back(
        bench_case(index_in(calibrator::bench::case_names, name), methods, command.seeds));
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
