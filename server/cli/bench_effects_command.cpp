#include <cmath>
#include <iostream>
#include <vector>

#include "server/bench/effect_bench.hpp"
#include "server/cli/commands.hpp"
#include "server/cli/exit_code.hpp"
#include "server/cli/input.hpp"
#include "server/cli/reference_grain.hpp"
#include "server/cli/text_table.hpp"
#include "server/json/effect_bench_json.hpp"
#include "server/report/number_text.hpp"
#include "server/service.hpp"

namespace repose::server {

namespace {

std::string table_of(const std::vector<EffectBench>& effects) {
  TextTable table({"effect", "observable", "without", "with", "change", "+-", ""}, "llrrrrl");
  for (const EffectBench& effect : effects) {
    for (const EffectChange& change : effect.changes) {
      const double factor = change.unit.factor;
      const double difference = (change.with - change.without) / factor;
      const double error = change.standard_error / factor;
      const int decimals = decimals_for(difference, error);
      const auto shown = [&](double value) {
        return std::isfinite(value) ? fixed_text(value, decimals) : std::string("-");
      };
      table.row({effect.effect,
                 change.experiment + "." + change.observable + unit_suffix(change.unit),
                 shown(change.without / factor),
                 shown(change.with / factor),
                 shown(difference),
                 shown(error),
                 change.failure});
    }
  }
  return table.str();
}

}  // namespace

int bench_effects_command(const BenchEffectsCommand& command) {
  ServiceOptions options;
  options.database = command.database;
  options.workers = command.workers;
  options.program = own_program();
  Service service(options);
  std::vector<const engine::ExperimentInfo*> experiments;
  for (const std::string& name : command.experiments) {
    experiments.push_back(engine::find_experiment(name));
  }
  std::vector<EffectBench> effects;
  for (const std::string& name : command.effects) {
    std::cerr << "repose: " << name << "\n";
    effects.push_back(bench_effect(*engine::find_effect(name),
                                   reference_grain(),
                                   experiments,
                                   command.seeds,
                                   [&service](const engine::Trial& trial, int seeds) {
                                     return service.evaluate(trial, seeds);
                                   }));
  }
  if (command.form == Form::json) {
    std::cout << print_effect_bench(effects, command.seeds) << "\n";
  } else {
    std::cout << table_of(effects);
  }
  return exit_code::done;
}

}  // namespace repose::server
