#include "engine/world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/any_machine.hpp"
#include "engine/quad.hpp"

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

/// History of lanes that no contact uses.
void clear_idle_lanes(int count, int columns, double* history) {
  for (int q = 0; q < columns && count < width; ++q) {
    std::fill(history + q * width + count, history + (q + 1) * width, 0.0);
  }
}

constexpr int quad = 4;
static_assert(sizeof(GrainRow) == 12 * sizeof(double) && width % quad == 0);

/// What stands in the lanes past the last contact: two equal spheres that just touch, at rest.
constexpr GrainRow idle_i{.z = 1.0, .radius = 0.5, .inverse_mass = 1.0};
constexpr GrainRow idle_j{.radius = 0.5, .inverse_mass = 1.0};

/// Four rows to four lanes of the columns of an end.
[[gnu::always_inline]] inline void to_lanes(const std::array<const GrainRow*, quad>& rows,
                                            ContactBlock::End& end,
                                            int lane) {
  const std::array columns{&end.x, &end.vx, &end.wx};
  const std::array firsts{&GrainRow::x, &GrainRow::vx, &GrainRow::wx};
  for (std::size_t part = 0; part < columns.size(); ++part) {
    Quad a = load_quad(&(rows[0]->*firsts[part]));
    Quad b = load_quad(&(rows[1]->*firsts[part]));
    Quad c = load_quad(&(rows[2]->*firsts[part]));
    Quad d = load_quad(&(rows[3]->*firsts[part]));
    transpose(a, b, c, d);
    double* const to = columns[part]->data() + lane;
    store_quad(to, a);
    store_quad(to + width, b);
    store_quad(to + 2 * width, c);
    store_quad(to + 3 * width, d);
  }
}

/// Copies the rows at both ends of a block's pairs to its columns.
REPOSE_ANY_MACHINE
void gather_ends(ContactBlock& c,
                 const std::uint32_t* block,
                 const Candidates& p,
                 const GrainRow* rows) {
  for (int lane = 0; lane < width; lane += quad) {
    std::array<const GrainRow*, quad> i{};
    std::array<const GrainRow*, quad> j{};
    for (int q = 0; q < quad; ++q) {
      const bool idle = lane + q >= c.count;
      const std::uint32_t k = idle ? 0 : block[lane + q];
      i[static_cast<std::size_t>(q)] = idle ? &idle_i : rows + p.i[k];
      j[static_cast<std::size_t>(q)] = idle ? &idle_j : rows + p.j[k];
    }
    to_lanes(i, c.i, lane);
    to_lanes(j, c.j, lane);
  }
}

/// A point of a wall as the other end of a contact: no size, no spin, no give.
[[gnu::always_inline]] inline void set_wall_end(ContactBlock::End& end,
                                                int lane,
                                                const Vec3& point,
                                                const Vec3& velocity) {
  end.x[lane] = point.x;
  end.y[lane] = point.y;
  end.z[lane] = point.z;
  end.vx[lane] = velocity.x;
  end.vy[lane] = velocity.y;
  end.vz[lane] = velocity.z;
}

/// What all ends at walls share, and the idle lanes' partner.
void clear_wall_ends(ContactBlock::End& end, int count) {
  for (auto* column :
       {&end.x, &end.y, &end.z, &end.vx, &end.vy, &end.vz, &end.wx, &end.wy, &end.wz}) {
    column->fill(0.0);
  }
  for (int lane = 0; lane < width; ++lane) {
    end.radius[lane] = lane < count ? 0.0 : idle_j.radius;
    end.inverse_mass[lane] = lane < count ? 0.0 : idle_j.inverse_mass;
  }
}

/// Adds four lanes of loads to the grains they belong to.
[[gnu::always_inline]] inline void from_lanes(const ContactBlock::Load& load,
                                              int lane,
                                              std::array<Quad, quad>& force,
                                              std::array<Quad, quad>& torque) {
  const double* const from = load.fx.data() + lane;
  for (int q = 0; q < quad; ++q) force[static_cast<std::size_t>(q)] = load_quad(from + q * width);
  torque[0] = load_quad(from + 4 * width);
  torque[1] = load_quad(from + 5 * width);
  torque[2] = torque[3] = Quad{0.0, 0.0, 0.0, 0.0};
  transpose(force[0], force[1], force[2], force[3]);
  transpose(torque[0], torque[1], torque[2], torque[3]);
}

[[gnu::always_inline]] inline void receive(GrainLoad& load, const Quad& first, const Quad& second) {
  store_quad(&load.fx, load_quad(&load.fx) + first);
  store_quad(&load.ty, load_quad(&load.ty) + second);
}

/// Adds a block's loads to the grains at both ends, in the order of the contacts.
REPOSE_ANY_MACHINE
void scatter_loads(const ContactBlock& c,
                   const std::uint32_t* block,
                   const Candidates& p,
                   GrainLoad* loads) {
  std::array<Quad, quad> force_i{}, torque_i{}, force_j{}, torque_j{};
  for (int lane = 0; lane < c.count; lane += quad) {
    from_lanes(c.load_i, lane, force_i, torque_i);
    from_lanes(c.load_j, lane, force_j, torque_j);
    const int lanes = std::min(quad, c.count - lane);
    for (int q = 0; q < lanes; ++q) {
      const std::uint32_t k = block[lane + q];
      const auto n = static_cast<std::size_t>(q);
      receive(loads[p.i[k]], force_i[n], torque_i[n]);
      receive(loads[p.j[k]], force_j[n], torque_j[n]);
    }
  }
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
      list_(model_.history_columns()),
      block_(std::make_unique<ContactBlock>()) {}

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
      closed_walls_[static_cast<std::size_t>(surface.material)].push_back({k, d});
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
  ContactBlock& c = *block_;
  c.period = {options_.period.x, options_.period.y};
  alignas(64) std::array<double, width * most_history_columns> history;
  for (std::size_t first = 0; first < closed_pairs_.size(); first += width) {
    c.count = static_cast<int>(std::min<std::size_t>(width, closed_pairs_.size() - first));
    const std::uint32_t* const block = closed_pairs_.data() + first;
    gather_ends(c, block, p, grains_.rows.data());
    for (int lane = 0; lane < c.count; ++lane) {
      gather_history(p, columns, block[lane], lane, history.data());
    }
    clear_idle_lanes(c.count, columns, history.data());
    apply(law, Partner::grain, c, HistoryBlock(history.data()), options_.time_step);
    scatter_loads(c, block, p, grains_.loads.data());
    for (int lane = 0; lane < c.count; ++lane) {
      p.closed[block[lane]] = 1;
      scatter_history(p, columns, block[lane], lane, history.data());
    }
  }
}

void World::push_walls() {
  Candidates& w = list_.walls;
  const int columns = list_.history_columns();
  ContactBlock& c = *block_;
  alignas(64) std::array<double, width * most_history_columns> history;
  for (std::size_t material = 0; material < closed_walls_.size(); ++material) {
    const PairLaw& law = model_.law(static_cast<MaterialId>(material));
    const std::vector<ClosedWall>& closed = closed_walls_[material];
    for (std::size_t first = 0; first < closed.size(); first += width) {
      c.count = static_cast<int>(std::min<std::size_t>(width, closed.size() - first));
      const ClosedWall* const block = closed.data() + first;
      for (int lane = 0; lane < width; lane += quad) {
        std::array<const GrainRow*, quad> rows{};
        for (int q = 0; q < quad; ++q) {
          const bool idle = lane + q >= c.count;
          rows[static_cast<std::size_t>(q)] =
              idle ? &idle_i : &grains_.rows[w.i[block[lane + q].candidate]];
        }
        to_lanes(rows, c.i, lane);
      }
      clear_wall_ends(c.j, c.count);
      for (int lane = 0; lane < c.count; ++lane) {
        const std::uint32_t k = block[lane].candidate;
        const Vec3 point = grains_.rows[w.i[k]].centre() - block[lane].offset;
        set_wall_end(c.j, lane, point, surfaces_[w.j[k]].velocity);
      }
      for (int lane = 0; lane < c.count; ++lane) {
        gather_history(w, columns, block[lane].candidate, lane, history.data());
      }
      clear_idle_lanes(c.count, columns, history.data());
      apply(law, Partner::wall, c, HistoryBlock(history.data()), options_.time_step);
      for (int lane = 0; lane < c.count; ++lane) {
        const std::uint32_t k = block[lane].candidate;
        GrainLoad& load = grains_.loads[w.i[k]];
        load.fx += c.load_i.fx[lane];
        load.fy += c.load_i.fy[lane];
        load.fz += c.load_i.fz[lane];
        load.tx += c.load_i.tx[lane];
        load.ty += c.load_i.ty[lane];
        load.tz += c.load_i.tz[lane];
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
