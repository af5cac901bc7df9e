#include "server/json/bench_json.hpp"

#include "engine/any_machine.hpp"
#include "server/json/text.hpp"

namespace repose::server {

std::string print_bench(std::span<const BenchScene> scenes) {
  const auto set = static_cast<std::size_t>(engine::instruction_set());
  Json list = Json::array();
  for (const BenchScene& scene : scenes) {
    list.push_back({{"scene", scene.scene},
                    {"grains", scene.grains},
                    {"particle_steps_per_second", scene.particle_steps_per_second},
                    {"slowest", scene.slowest},
                    {"fastest", scene.fastest},
                    {"contacts_per_grain", scene.contacts_per_grain},
                    {"steps_per_rebuild", scene.steps_per_rebuild},
                    {"instruction_set", engine::instruction_set_names.at(set)},
                    {"bytes_per_grain", scene.bytes_per_grain},
                    {"wall_seconds", scene.wall_seconds}});
  }
  return to_text({{"scenes", std::move(list)}}, 2);
}

}  // namespace repose::server
