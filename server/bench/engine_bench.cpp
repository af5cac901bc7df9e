#include "server/bench/engine_bench.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <fstream>
#include <iomanip>
#include <stdexcept>
#include <variant>

#include "engine/catalogue.hpp"
#include "engine/evaluate.hpp"
#include "engine/random.hpp"
#include "engine/world.hpp"
#include "server/jobs/team.hpp"

namespace repose::server {

namespace {

using engine::GrainRow;
using engine::World;

constexpr std::uint64_t tile = 5000;     ///< grains of the bed that is laid side by side
constexpr double time_step_share = 0.2;  ///< of the Rayleigh time
constexpr double particle_steps = 4e6;   ///< of one round

/// Processor and wall time since it was made, s.
class Watch {
 public:
  /// Of the processor where one thread works, which others on the machine disturb less.
  [[nodiscard]] double time_of(unsigned threads) const {
    return threads == 1 ? processor() : wall();
  }
  [[nodiscard]] double processor() const {
    return static_cast<double>(std::clock() - processor_) / CLOCKS_PER_SEC;
  }
  [[nodiscard]] double wall() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_).count();
  }

 private:
  std::clock_t processor_ = std::clock();
  std::chrono::steady_clock::time_point wall_ = std::chrono::steady_clock::now();
};

void summarise(std::vector<double> rates, BenchScene& scene) {
  std::ranges::sort(rates);
  scene.slowest = rates.front();
  scene.fastest = rates.back();
  scene.particle_steps_per_second = rates[rates.size() / 2];
}

struct Bed {
  engine::ContactModel model;
  double radius;   ///< m
  double density;  ///< kg/m3
  double side;     ///< of the square base, m
  engine::Team team;

  [[nodiscard]] World world(int along_x, int along_y) const {
    const auto& material = model.material(engine::MaterialId::grain);
    World result(model,
                 {.time_step = time_step_share * engine::rayleigh_time(radius, material),
                  .period = {along_x * side, along_y * side, 0.0},
                  .team = team});
    result.change_surfaces() = {engine::plane(0.0)};
    return result;
  }
};

/// Lets a loose jittered lattice fall on the base and come to rest.
World settled(const Bed& bed, std::uint64_t grains) {
  World world = bed.world(1, 1);
  const double d = 2.0 * bed.radius;
  const int across = static_cast<int>(bed.side / (1.3 * d));
  const double pitch = bed.side / across;
  engine::Random random(1, engine::Purpose::grain_position);
  for (std::uint64_t k = 0; k < grains; ++k) {
    const auto n = static_cast<std::uint64_t>(across);
    const auto place = [&](std::uint64_t cell) {
      return (static_cast<double>(cell) + 0.5) * pitch + random.uniform(-0.4, 0.4) * (pitch - d);
    };
    GrainRow grain = engine::sphere(bed.radius, bed.density);
    grain.x = place(k % n);
    grain.y = place(k / n % n);
    const std::uint64_t layer = k / (n * n);
    grain.z = (static_cast<double>(layer) + 0.5) * 1.2 * d + random.uniform(-0.1, 0.1) * d;
    grain.vx = random.uniform(-0.2, 0.2);
    world.add(grain);
  }
  constexpr double seconds = 1.2;  // a metre of fall, and time to come to rest
  while (world.time() < seconds) world.step();
  return world;
}

/// The bed laid side by side, in a rectangle as nearly square as its factors allow.
World tiled(const Bed& bed, const World& one, int tiles) {
  int along_y = static_cast<int>(std::lround(std::sqrt(tiles)));
  while (tiles % along_y != 0) --along_y;
  const int along_x = tiles / along_y;
  World world = bed.world(along_x, along_y);
  for (int x = 0; x < along_x; ++x) {
    for (int y = 0; y < along_y; ++y) {
      for (GrainRow grain : one.grains().rows) {
        grain.x += x * bed.side;
        grain.y += y * bed.side;
        world.add(grain);
      }
    }
  }
  constexpr int before = 50;  // steps: contacts find their histories
  for (int step = 0; step < before; ++step) world.step();
  return world;
}

void write_bed(const World& world, const std::filesystem::path& path) {
  std::ofstream file(path);
  file << std::setprecision(17) << world.period().x << ' ' << world.period().y << " 0\n";
  for (const GrainRow& g : world.grains().rows) file << g.x << ' ' << g.y << ' ' << g.z << '\n';
  if (!file.flush()) throw std::runtime_error("the bed cannot be written to " + path.string());
}

BenchScene time_world(World& world, const BenchOptions& options) {
  BenchScene scene{.scene = "static", .grains = world.grain_count()};
  if (!options.bed.empty()) write_bed(world, options.bed);
  const Watch whole;
  const auto grains = static_cast<double>(world.grain_count());
  const auto steps = static_cast<int>(std::ceil(particle_steps / grains));
  const std::uint64_t rebuilds = world.rebuilds();
  std::vector<double> rates;
  rates.reserve(static_cast<std::size_t>(options.rounds));
  for (int round = 0; round < options.rounds; ++round) {
    const Watch watch;
    for (int step = 0; step < steps; ++step) world.step();
    rates.push_back(grains * steps / watch.time_of(options.threads));
  }
  summarise(rates, scene);
  scene.contacts_per_grain = static_cast<double>(world.contacts()) / grains;
  scene.steps_per_rebuild =
      static_cast<double>(steps) * options.rounds /
      static_cast<double>(std::max<std::uint64_t>(1, world.rebuilds() - rebuilds));
  scene.bytes_per_grain = world.bytes_per_grain();
  scene.wall_seconds = whole.wall();
  return scene;
}

}  // namespace

BenchScene bench_static(const engine::ParameterSet& grain,
                        std::uint64_t grains,
                        const BenchOptions& options) {
  const engine::ContactModel model(grain);
  const auto& material = model.material(engine::MaterialId::grain);
  const std::uint64_t one = std::min(grains, tile);
  const double d = material.diameter;
  const Bed bed{.model = model,
                .radius = 0.5 * d,
                .density = material.density,
                .side = std::round(20.0 * std::sqrt(static_cast<double>(one) / tile)) * d,
                .team = team_of(options.threads)};
  World world = settled(bed, one);
  if (grains <= tile) return time_world(world, options);
  World many = tiled(bed, world, static_cast<int>(grains / tile));
  return time_world(many, options);
}

BenchScene bench_experiment(std::string_view experiment,
                            const engine::ParameterSet& grain,
                            const BenchOptions& options) {
  engine::Trial trial;
  trial.parameters = grain;
  trial.experiment.name = experiment;
  trial.experiment.fidelity = engine::Fidelity::draft;
  trial.seed = 1;
  BenchScene scene{.scene = std::string(experiment)};
  const Watch whole;
  std::vector<double> rates;
  rates.reserve(static_cast<std::size_t>(options.rounds));
  engine::Effort effort;
  for (int round = 0; round < options.rounds; ++round) {
    const Watch watch;
    const engine::Evaluation evaluation =
        engine::evaluate(trial, {.team = team_of(options.threads)});
    if (const auto* failure = std::get_if<engine::Failure>(&evaluation.outcome)) {
      throw std::runtime_error(scene.scene + ": " + failure->message);
    }
    effort = evaluation.effort;
    rates.push_back(static_cast<double>(effort.grain_steps) / watch.time_of(options.threads));
  }
  summarise(rates, scene);
  scene.grains = effort.grains;
  scene.contacts_per_grain =
      static_cast<double>(effort.contacts) / static_cast<double>(effort.grains);
  scene.steps_per_rebuild =
      static_cast<double>(effort.steps) / static_cast<double>(effort.rebuilds);
  scene.bytes_per_grain = effort.bytes_per_grain;
  scene.wall_seconds = whole.wall();
  return scene;
}

}  // namespace repose::server
