#include "engine/world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace repose::engine {

namespace {

constexpr int width = ContactBlock::width;

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

/// A candidate's history to its lane of a block, and back. Most laws carry three columns or six.
template <int columns>
void gather_columns(const double* from, int lane, double* to) {
  for (int q = 0; q < columns; ++q) to[q * width + lane] = from[q];
}
template <int columns>
void scatter_columns(double* to, int lane, const double* from) {
  for (int q = 0; q < columns; ++q) to[q] = from[q * width + lane];
}

void gather_history(const Candidates& c, int columns, std::uint32_t k, int lane, double* to) {
  const double* from = c.history.data() + static_cast<std::size_t>(k) * columns;
  int q = 0;
  for (; q + 3 <= columns; q += 3) gather_columns<3>(from + q, lane, to + q * width);
  for (; q < columns; ++q) gather_columns<1>(from + q, lane, to + q * width);
}

void scatter_history(Candidates& c, int columns, std::uint32_t k, int lane, const double* from) {
  double* to = c.history.data() + static_cast<std::size_t>(k) * columns;
  int q = 0;
  for (; q + 3 <= columns; q += 3) scatter_columns<3>(to + q, lane, from + q * width);
  for (; q < columns; ++q) scatter_columns<1>(to + q, lane, from + q * width);
}

/// Lanes past the last contact: two equal spheres that just touch, at rest.
void fill_idle_lanes(ContactBlock& c, int columns, double* history) {
  for (int lane = c.count; lane < width; ++lane) {
    c.normal_x[lane] = 1.0;
    c.normal_y[lane] = c.normal_z[lane] = 0.0;
    c.radius_i[lane] = c.radius_j[lane] = 0.5;
    c.inverse_mass_i[lane] = c.inverse_mass_j[lane] = 1.0;
    c.slip_x[lane] = c.slip_y[lane] = c.slip_z[lane] = 0.0;
    c.spin_i_x[lane] = c.spin_i_y[lane] = c.spin_i_z[lane] = 0.0;
    c.spin_j_x[lane] = c.spin_j_y[lane] = c.spin_j_z[lane] = 0.0;
    for (int q = 0; q < columns; ++q) history[q * width + lane] = 0.0;
  }
}

void gather_end_i(ContactBlock& c, int lane, const GrainRow& a) {
  c.radius_i[lane] = a.radius;
  c.inverse_mass_i[lane] = a.inverse_mass;
  c.spin_i_x[lane] = a.wx;
  c.spin_i_y[lane] = a.wy;
  c.spin_i_z[lane] = a.wz;
}

/// Adds a lane's force and torque to the grain at end i.
void load_end_i(const ContactBlock& c, int lane, GrainLoad& load) {
  load.fx += c.force_x[lane];
  load.fy += c.force_y[lane];
  load.fz += c.force_z[lane];
  load.tx += c.torque_i_x[lane];
  load.ty += c.torque_i_y[lane];
  load.tz += c.torque_i_z[lane];
}

void load_end_j(const ContactBlock& c, int lane, GrainLoad& load) {
  load.fx -= c.force_x[lane];
  load.fy -= c.force_y[lane];
  load.fz -= c.force_z[lane];
  load.tx += c.torque_j_x[lane];
  load.ty += c.torque_j_y[lane];
  load.tz += c.torque_j_z[lane];
}

/// Forgets the contact of a candidate that has opened.
void open(Candidates& candidates, int columns, std::uint32_t k) {
  candidates.closed[k] = 0;
  std::fill_n(candidates.history.begin() + static_cast<std::ptrdiff_t>(k) * columns, columns, 0.0);
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

std::uint32_t World::add(const GrainRow& grain) {
  const auto id = static_cast<std::uint32_t>(inserted_++);
  grains_.rows.push_back(grain);
  grains_.ids.push_back(id);
  grains_.loads.push_back({});
  stale_ = true;
  return id;
}

std::size_t World::remove(const std::function<bool(const GrainRow&)>& condition) {
  std::vector<std::uint32_t> new_row(grains_.size());
  std::size_t kept = 0;
  constexpr std::uint32_t gone = std::numeric_limits<std::uint32_t>::max();
  for (std::size_t k = 0; k < grains_.size(); ++k) {
    if (condition(grains_.rows[k])) {
      new_row[k] = gone;
      continue;
    }
    new_row[k] = static_cast<std::uint32_t>(kept);
    grains_.rows[kept] = grains_.rows[k];
    grains_.ids[kept] = grains_.ids[k];
    ++kept;
  }
  const std::size_t removed = grains_.size() - kept;
  if (removed == 0) return 0;
  grains_.rows.resize(kept);
  grains_.ids.resize(kept);
  grains_.loads.resize(kept);
  list_.renumber(new_row, gone);
  stale_ = true;
  return removed;
}

std::vector<Surface>& World::change_surfaces() {
  stale_ = true;
  return surfaces_;
}

void World::turn_gravity(double rate) {
  turn_rate_ = rate;
  turn_start_ = time_;
}

void World::rebuild() {
  list_.rebuild(grains_, surfaces_, options_.period, horizon_steps * options_.time_step);
  grains_.loads.resize(grains_.size());
  stale_ = false;
  ++rebuilds_;
}

void World::find_closed_pairs() {
  Candidates& p = list_.pairs;
  const std::size_t n = p.size();
  const int columns = list_.history_columns();
  const Vec3 period = options_.period;
  const double half_x = half(period.x), half_y = half(period.y);
  closed_pairs_.resize(n + 1);
  std::size_t closed = 0;
  const GrainRow* const rows = grains_.rows.data();
  for (std::uint32_t k = 0; k < n; ++k) {
    const GrainRow& a = rows[p.i[k]];
    const GrainRow& b = rows[p.j[k]];
    const double dx = image(a.x - b.x, period.x, half_x);
    const double dy = image(a.y - b.y, period.y, half_y);
    const double dz = a.z - b.z;
    const double reach = a.radius + b.radius;
    const bool touches = dx * dx + dy * dy + dz * dz < reach * reach;
    closed_pairs_[closed] = k;
    closed += touches ? 1 : 0;
    if (!touches && p.closed[k] != 0) open(p, columns, k);
  }
  closed_pairs_.resize(closed);
  closed_ += closed;
}

void World::find_closed_walls() {
  Candidates& w = list_.walls;
  for (auto& closed : closed_walls_) closed.clear();
  for (std::uint32_t k = 0; k < w.size(); ++k) {
    const GrainRow& a = grains_.rows[w.i[k]];
    const Surface& surface = surfaces_[w.j[k]];
    const Vec3 d = offset_from(surface, a.centre());
    const double squared = dot(d, d);
    if (squared < a.radius * a.radius && squared > 0.0) {
      closed_walls_[static_cast<std::size_t>(surface.material)].push_back(k);
      ++closed_;
    } else if (w.closed[k] != 0) {
      open(w, list_.history_columns(), k);
    }
  }
}

void World::push_pairs() {
  Candidates& p = list_.pairs;
  const PairLaw& law = model_.law(MaterialId::grain);
  const int columns = list_.history_columns();
  const Vec3 period = options_.period;
  const double half_x = half(period.x), half_y = half(period.y);
  alignas(64) ContactBlock c;
  alignas(64) std::array<double, width * most_history_columns> history;
  const GrainRow* const rows = grains_.rows.data();
  GrainLoad* const loads = grains_.loads.data();
  for (std::size_t first = 0; first < closed_pairs_.size(); first += width) {
    c.count = static_cast<int>(std::min<std::size_t>(width, closed_pairs_.size() - first));
    const std::uint32_t* const block = closed_pairs_.data() + first;
    for (int lane = 0; lane < c.count; ++lane) {
      const std::uint32_t k = block[lane];
      const GrainRow& a = rows[p.i[k]];
      const GrainRow& b = rows[p.j[k]];
      c.normal_x[lane] = image(a.x - b.x, period.x, half_x);
      c.normal_y[lane] = image(a.y - b.y, period.y, half_y);
      c.normal_z[lane] = a.z - b.z;
      c.slip_x[lane] = a.vx - b.vx;
      c.slip_y[lane] = a.vy - b.vy;
      c.slip_z[lane] = a.vz - b.vz;
      gather_end_i(c, lane, a);
      c.radius_j[lane] = b.radius;
      c.inverse_mass_j[lane] = b.inverse_mass;
      c.spin_j_x[lane] = b.wx;
      c.spin_j_y[lane] = b.wy;
      c.spin_j_z[lane] = b.wz;
      gather_history(p, columns, k, lane, history.data());
    }
    if (c.count < width) fill_idle_lanes(c, columns, history.data());
    apply(law, Partner::grain, c, HistoryBlock(history.data()), options_.time_step);
    for (int lane = 0; lane < c.count; ++lane) {
      const std::uint32_t k = block[lane];
      load_end_i(c, lane, loads[p.i[k]]);
      load_end_j(c, lane, loads[p.j[k]]);
      p.closed[k] = 1;
      scatter_history(p, columns, k, lane, history.data());
    }
  }
}

void World::push_walls() {
  Candidates& w = list_.walls;
  const int columns = list_.history_columns();
  alignas(64) ContactBlock c;
  alignas(64) std::array<double, width * most_history_columns> history;
  for (std::size_t material = 0; material < closed_walls_.size(); ++material) {
    const PairLaw& law = model_.law(static_cast<MaterialId>(material));
    const std::vector<std::uint32_t>& closed = closed_walls_[material];
    for (std::size_t first = 0; first < closed.size(); first += width) {
      c.count = static_cast<int>(std::min<std::size_t>(width, closed.size() - first));
      for (int lane = 0; lane < c.count; ++lane) {
        const std::uint32_t k = closed[first + static_cast<std::size_t>(lane)];
        const GrainRow& a = grains_.rows[w.i[k]];
        const Surface& surface = surfaces_[w.j[k]];
        const Vec3 d = offset_from(surface, a.centre());
        c.normal_x[lane] = d.x;
        c.normal_y[lane] = d.y;
        c.normal_z[lane] = d.z;
        c.slip_x[lane] = a.vx - surface.velocity.x;
        c.slip_y[lane] = a.vy - surface.velocity.y;
        c.slip_z[lane] = a.vz - surface.velocity.z;
        gather_end_i(c, lane, a);
        c.radius_j[lane] = c.inverse_mass_j[lane] = 0.0;
        c.spin_j_x[lane] = c.spin_j_y[lane] = c.spin_j_z[lane] = 0.0;
        gather_history(w, columns, k, lane, history.data());
      }
      if (c.count < width) fill_idle_lanes(c, columns, history.data());
      apply(law, Partner::wall, c, HistoryBlock(history.data()), options_.time_step);
      for (int lane = 0; lane < c.count; ++lane) {
        const std::uint32_t k = closed[first + static_cast<std::size_t>(lane)];
        load_end_i(c, lane, grains_.loads[w.i[k]]);
        w.closed[k] = 1;
        scatter_history(w, columns, k, lane, history.data());
      }
    }
  }
}

/// Velocities half a step behind positions (leapfrog): kick, then drift.
void World::integrate() {
  const double dt = options_.time_step;
  const Vec3 g = gravity_;
  for (std::size_t k = 0; k < grains_.size(); ++k) {
    GrainRow& a = grains_.rows[k];
    GrainLoad& load = grains_.loads[k];
    const double push = a.inverse_mass * dt, turn = a.inverse_inertia * dt;
    a.vx += load.fx * push + g.x * dt;
    a.vy += load.fy * push + g.y * dt;
    a.vz += load.fz * push + g.z * dt;
    a.wx += load.tx * turn;
    a.wy += load.ty * turn;
    a.wz += load.tz * turn;
    a.x += a.vx * dt;
    a.y += a.vy * dt;
    a.z += a.vz * dt;
    load = {};
  }
}

void World::step() {
  if (stale_ || list_.outlived(grains_)) rebuild();
  closed_ = 0;
  find_closed_pairs();
  find_closed_walls();
  push_pairs();
  push_walls();
  if (turn_rate_ != 0.0) {
    const double angle = turn_rate_ * (time_ - turn_start_);
    const double g = norm(options_.gravity);
    gravity_ = {g * std::sin(angle), 0.0, -g * std::cos(angle)};
  }
  integrate();
  time_ += options_.time_step;
  ++steps_;
  grain_steps_ += grains_.size();
}

double World::kinetic_energy() const {
  double energy = 0.0;
  for (const GrainRow& a : grains_.rows) {
    energy += 0.5 * dot(a.velocity(), a.velocity()) / a.inverse_mass;
    energy += 0.5 * dot(a.spin(), a.spin()) / a.inverse_inertia;
  }
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
    const Vec3 d = offset_from(surfaces_[list_.walls.j[k]], a.centre());
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
  const std::size_t bytes =
      grains_.size() * per_grain + 2 * (list_.pairs.size() + list_.walls.size()) * per_candidate;
  return grains_.size() == 0 ? 0.0
                             : static_cast<double>(bytes) / static_cast<double>(grains_.size());
}

}  // namespace repose::engine
