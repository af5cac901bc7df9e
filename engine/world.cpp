#include "engine/world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/motion.hpp"
#include "engine/wall_pass.hpp"

namespace repose::engine {

namespace {

/// Steps a grain may fly before its skin is used up: long enough to spread the cost of a search,
/// short enough to keep the list of a falling stream small.
constexpr double horizon_steps = 40.0;

/// Half a period, or more than any distance where there is none.
double half(double period) {
  return period > 0.0 ? 0.5 * period : std::numeric_limits<double>::infinity();
}

/// Nearest image of a difference of coordinates.
double image(double d, double period, double half_period) {
  d -= d > half_period ? period : 0.0;
  d += d < -half_period ? period : 0.0;
  return d;
}

}  // namespace

double rayleigh_time(double radius, const Material& material) {
  return unit::pi * radius * std::sqrt(material.density / material.shear_modulus) /
         (0.1631 * material.poisson_ratio + 0.8766);
}

double impact_time(double mass, double radius, double modulus, double speed) {
  return 2.868 * std::pow(mass * mass / (radius * modulus * modulus * speed), 0.2);
}

World::World(ContactModel model, const WorldOptions& options)
    : model_(std::move(model)),
      options_(options),
      gravity_(options.gravity),
      list_(model_.history_columns()) {}

std::uint32_t World::add_row(const GrainRow& row) {
  const auto id = static_cast<std::uint32_t>(inserted_++);
  grains_.rows.push_back(row);
  grains_.ids.push_back(id);
  grains_.loads.push_back({});
  stale_ = true;
  return id;
}

std::uint32_t World::add(const GrainRow& grain) {
  ++inserted_grains_;
  return add_row(grain);
}

std::uint32_t World::add_clump(const ClumpShape& shape, const ClumpPlacement& placement) {
  ++inserted_grains_;
  const auto first = static_cast<std::uint32_t>(inserted_);
  for (const GrainRow& member : clumps_.add(shape, placement, first)) add_row(member);
  return first;
}

std::size_t World::remove(const std::function<bool(const GrainRow&)>& condition) {
  std::vector<std::uint32_t> new_row(grains_.size());
  std::vector<std::uint8_t> leaving;  // clumps
  leaving.reserve(clumps_.bodies().size());
  for (const ClumpBody& body : clumps_.bodies()) {
    leaving.push_back(condition(clumps_.envelope(body)) ? 1 : 0);
  }
  const std::size_t before = grain_count();
  std::size_t kept = 0;
  constexpr std::uint32_t gone = std::numeric_limits<std::uint32_t>::max();
  for (std::size_t k = 0; k < grains_.size(); ++k) {
    const std::uint32_t body = clumps_.body_of(grains_.ids[k]);
    if (body == no_body ? condition(grains_.rows[k]) : leaving[body] != 0) {
      new_row[k] = gone;
      continue;
    }
    new_row[k] = static_cast<std::uint32_t>(kept);
    grains_.rows[kept] = grains_.rows[k];
    grains_.ids[kept] = grains_.ids[k];
    ++kept;
  }
  if (kept == grains_.size()) return 0;
  clumps_.remove(leaving);
  grains_.rows.resize(kept);
  grains_.ids.resize(kept);
  grains_.loads.resize(kept);
  list_.renumber(new_row, gone);
  stale_ = true;
  return before - grain_count();
}

std::vector<Surface>& World::change_surfaces() {
  stale_ = true;
  return surfaces_;
}

void World::drive(std::size_t surface, const Vec3& velocity, const Vec3& spin) {
  surfaces_[surface].velocity = velocity;
  surfaces_[surface].spin = spin;
  walls_move_ = walls_move_ || fastest(surfaces_[surface]) > 0.0;
}

void World::turn_gravity(double rate) {
  turn_rate_ = rate;
  turn_start_ = time_;
}

void World::start_shaking() {
  shaken_ = model_.lifts();
  shaken_since_ = time_;
}

void World::stop_shaking() {
  if (shaken_) gravity_ = options_.gravity;
  shaken_ = false;
}

void World::rebuild() {
  double largest = 0.0;
  for (const GrainRow& row : grains_.rows) largest = std::max(largest, row.radius);
  reach_ = model_.reach(largest);
  list_.rebuild(grains_,
                surfaces_,
                options_.period,
                horizon_steps * options_.time_step,
                clumps_.bodies_of_ids(),
                options_.team,
                reach_);
  desks_.resize(list_.parts().size());
  if (!clumps_.empty()) clumps_.locate(grains_, options_.period);
  grains_.loads.resize(grains_.size());
  travelled_.assign(surfaces_.size(), 0.0);
  walls_move_ = std::ranges::any_of(surfaces_, [](const Surface& s) { return fastest(s) > 0.0; });
  stale_ = false;
  ++rebuilds_;
}

void World::push_pairs(std::size_t first, std::size_t last, Desk& desk) {
  PairPass pass{.law = model_.law(MaterialId::grain),
                .period = {options_.period.x, options_.period.y},
                .dt = options_.time_step,
                .reach = reach_,
                .rows = grains_.rows.data(),
                .loads = grains_.loads.data(),
                .candidates = list_.pairs,
                .first = first,
                .last = last,
                .history_columns = list_.history_columns(),
                .block = *desk.block};
  engine::push_pairs(pass);
  desk.closed += pass.closed;
}

void World::push_pairs() {
  const std::span<const Part> parts = list_.parts();
  share(options_.team, parts.size(), [&](std::size_t k) {
    desks_[k].closed = 0;
    push_pairs(parts[k].first, parts[k].last, desks_[k]);
  });
  push_pairs(parts.back().last, list_.pairs.size(), desks_.front());
  for (const Desk& desk : desks_) closed_ += desk.closed;
}

void World::push_walls() {
  wall_loads_.assign(surfaces_.size(), {});
  WallPass pass{.model = model_,
                .surfaces = surfaces_,
                .dt = options_.time_step,
                .reach = reach_,
                .rows = grains_.rows.data(),
                .loads = grains_.loads.data(),
                .wall_loads = wall_loads_,
                .candidates = list_.walls,
                .history_columns = list_.history_columns(),
                .block = *desks_.front().block};
  engine::push_walls(pass);
  closed_ += pass.closed;
}

/// Forces on single spheres that are no contacts'; on clumps they act as a whole.
void World::push_spheres() {
  for (std::size_t k = 0; k < grains_.size(); ++k) {
    if (clumps_.body_of(grains_.ids[k]) != no_body) continue;
    const GrainRow& row = grains_.rows[k];
    const Vec3 force = model_.body_force(2.0 * row.radius, row.velocity());
    grains_.loads[k].fx += force.x;
    grains_.loads[k].fy += force.y;
    grains_.loads[k].fz += force.z;
  }
}

/// Members of clumps have no motion of their own: what they get with the others is overwritten.
void World::move() {
  if (!clumps_.empty()) clumps_.collect(grains_);
  if (model_.has_body_force()) {
    push_spheres();
    clumps_.push([&](double d, const Vec3& velocity) { return model_.body_force(d, velocity); });
  }
  const std::span<const Part> parts = list_.parts();
  share(options_.team, parts.size(), [&](std::size_t k) {
    Motion motion{gravity_,
                  options_.time_step,
                  grains_,
                  list_.anchors().data(),
                  parts[k].first_row,
                  parts[k].last_row};
    advance(motion);
    desks_[k].outlived = motion.outlived;
  });
  outlived_ = std::ranges::any_of(desks_, &Desk::outlived);
  if (clumps_.empty()) return;
  clumps_.advance(options_.time_step, gravity_, options_.period, grains_.rows);
  outlived_ = outlived_ || list_.outlived(grains_, clumps_.rows());
}

void World::move_walls() {
  for (std::size_t s = 0; s < surfaces_.size(); ++s) {
    const double speed = fastest(surfaces_[s]);
    if (speed == 0.0) continue;
    advance(surfaces_[s], options_.time_step);
    travelled_[s] += speed * options_.time_step;
    stale_ = stale_ || travelled_[s] > list_.wall_skins()[s];
  }
}

void World::step() {
  const double horizon = horizon_steps * options_.time_step;
  if (stale_ ||
      (outlived_ && !list_.repair(grains_, surfaces_, horizon, clumps_.bodies_of_ids()))) {
    rebuild();
  }
  closed_ = 0;
  push_pairs();
  push_walls();
  if (turn_rate_ != 0.0) {
    const double angle = turn_rate_ * (time_ - turn_start_);
    const double g = norm(options_.gravity);
    gravity_ = {g * std::sin(angle), 0.0, -g * std::cos(angle)};
  }
  if (shaken_) {
    gravity_ = options_.gravity - Vec3{0.0, 0.0, model_.lift(time_ - shaken_since_)};
  }
  move();
  if (walls_move_) move_walls();
  time_ += options_.time_step;
  ++steps_;
  grain_steps_ += grains_.size();
}

void World::for_each_grain(const std::function<void(const GrainRow&, std::uint32_t)>& see) const {
  for (std::size_t k = 0; k < grains_.size(); ++k) {
    if (clumps_.body_of(grains_.ids[k]) == no_body) see(grains_.rows[k], grains_.ids[k]);
  }
  for (const ClumpBody& body : clumps_.bodies()) see(clumps_.envelope(body), body.first_id);
}

double World::kinetic_energy() const {
  double energy = visible_energy();
  for (std::size_t k = 0; k < grains_.size(); ++k) {
    const GrainRow& a = grains_.rows[k];
    if (clumps_.body_of(grains_.ids[k]) != no_body) continue;
    energy += 0.5 * dot(a.spin(), a.spin()) / a.inverse_inertia;
  }
  return energy;
}

double World::visible_energy() const {
  double energy = 0.0;
  for (std::size_t k = 0; k < grains_.size(); ++k) {
    const GrainRow& a = grains_.rows[k];
    if (clumps_.body_of(grains_.ids[k]) != no_body) continue;
    energy += 0.5 * dot(a.velocity(), a.velocity()) / a.inverse_mass;
  }
  for (const ClumpBody& body : clumps_.bodies()) energy += engine::kinetic_energy(body);
  return energy;
}

double World::largest_overlap() const {
  double largest = 0.0;
  for (std::size_t k = 0; k < list_.pairs.size(); ++k) {
    if (list_.pairs.closed[k] == 0) continue;
    const GrainRow& a = grains_.rows[list_.pairs.i[k]];
    const GrainRow& b = grains_.rows[list_.pairs.j[k]];
    const Vec3 d{image(a.x - b.x, options_.period.x, half(options_.period.x)),
                 image(a.y - b.y, options_.period.y, half(options_.period.y)),
                 a.z - b.z};
    const double overlap = a.radius + b.radius - norm(d);
    largest = std::max(largest, overlap / std::min(a.radius, b.radius));
  }
  for (std::size_t k = 0; k < list_.walls.size(); ++k) {
    if (list_.walls.closed[k] == 0) continue;
    const GrainRow& a = grains_.rows[list_.walls.i[k]];
    const Vec3 d = offset_from(surfaces_[list_.walls.j[k]], a.centre(), a.radius);
    largest = std::max(largest, 1.0 - norm(d) / a.radius);
  }
  return largest;
}

double World::bytes_per_grain() const {
  const auto columns = static_cast<std::size_t>(list_.history_columns());
  const std::size_t per_candidate = 2 * sizeof(std::uint32_t) + 1 + columns * sizeof(double);
  const std::size_t per_grain =
      2 * sizeof(GrainRow) + sizeof(GrainLoad) + sizeof(std::uint32_t) * 4 +
      sizeof(double) * 5;  // rows twice while they are sorted; skins, anchors
  constexpr std::size_t per_member = 2 * sizeof(std::uint32_t) + sizeof(Vec3);
  const std::size_t bytes =
      grains_.size() * per_grain + 2 * (list_.pairs.size() + list_.walls.size()) * per_candidate +
      clumps_.bodies().size() * sizeof(ClumpBody) + clumps_.members() * per_member;
  return grain_count() == 0 ? 0.0 : static_cast<double>(bytes) / static_cast<double>(grain_count());
}

}  // namespace repose::engine
