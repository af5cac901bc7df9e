#include <iostream>

#include "engine/any_machine.hpp"
#include "server/bench/engine_bench.hpp"
#include "server/cli/commands.hpp"
#include "server/cli/exit_code.hpp"
#include "server/cli/reference_grain.hpp"
#include "server/cli/text_table.hpp"
#include "server/json/bench_json.hpp"
#include "server/report/number_text.hpp"

namespace repose::server {

namespace {

void print_table(const std::vector<BenchScene>& scenes, unsigned threads) {
  TextTable table(
      {"scene", "grains", "M particle-steps/s", "contacts/grain", "steps/rebuild", "bytes/grain"});
  for (const BenchScene& scene : scenes) {
    table.row({scene.scene,
               std::to_string(scene.grains),
               number_text(1e-6 * scene.particle_steps_per_second, 3) + " (" +
                   number_text(1e-6 * scene.slowest, 3) + " to " +
                   number_text(1e-6 * scene.fastest, 3) + ")",
               number_text(scene.contacts_per_grain, 3),
               number_text(scene.steps_per_rebuild, 3),
               number_text(scene.bytes_per_grain, 3)});
  }
  const auto set = static_cast<std::size_t>(engine::instruction_set());
  std::cout << table.str() << "\ninstruction set " << engine::instruction_set_names.at(set)
            << (threads == 1 ? ", one core, processor time"
                             : ", " + std::to_string(threads) + " threads, wall time")
            << "; median (extremes) of the rounds\n";
}

}  // namespace

int bench_engine_command(const BenchCommand& command) {
  engine::ParameterSet grain = reference_grain();
  if (command.stiff) {
    for (const auto material : {engine::MaterialId::grain, engine::MaterialId::wall}) {
      grain.set(engine::make_key("material.shear_modulus", {material}), 41.7e6);  // Pa
    }
  }
  const BenchOptions options{command.rounds, command.threads, command.bed};
  std::vector<BenchScene> scenes;
  for (const std::string& scene : command.scenes) {
    scenes.push_back(scene == "static" ? bench_static(grain, command.grains, options)
                                       : bench_experiment(scene, grain, options));
  }
  if (command.form == Form::json) {
    std::cout << print_bench(scenes) << "\n";
  } else {
    print_table(scenes, command.threads);
  }
  return exit_code::done;
}

}  // namespace repose::server
