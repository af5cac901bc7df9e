#include "engine/contact_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/any_machine.hpp"

namespace repose::engine {

namespace {

constexpr int width = ContactBlock::width;

/// Half a period, or more than any distance where there is none.
double half(double period) {
  return period > 0.0 ? 0.5 * period : std::numeric_limits<double>::infinity();
}

/// Geometry and relative motion from the gathered ends. Velocities at the contact point include
/// both spins; the point divides the overlap of two grains in halves and lies on a wall's surface.
template <Partner partner>
[[gnu::always_inline]] inline void kinematics(ContactBlock& c) {
  const ContactBlock::End& a = c.i;
  const ContactBlock::End& b = c.j;
  constexpr bool grain = partner == Partner::grain;
  constexpr double share_i = grain ? 0.5 : 1.0;
  const double px = c.period.x, py = c.period.y, half_x = half(px), half_y = half(py);
  for (int k = 0; k < width; ++k) {
    double dx = a.x[k] - b.x[k], dy = a.y[k] - b.y[k];
    const double dz = a.z[k] - b.z[k];
    if (grain) {
      dx -= dx > half_x ? px : 0.0;
      dx += dx < -half_x ? px : 0.0;
      dy -= dy > half_y ? py : 0.0;
      dy += dy < -half_y ? py : 0.0;
    }
    const double distance = std::sqrt(dx * dx + dy * dy + dz * dz);
    const double inverse = 1.0 / distance;
    const double nx = dx * inverse, ny = dy * inverse, nz = dz * inverse;
    const double ri = a.radius[k], rj = b.radius[k];
    const double gap = ri + rj - distance;
    const double overlap = gap > 0.0 ? gap : 0.0;
    const double arm_i = ri - share_i * overlap;
    const double arm_j = grain ? distance - arm_i : 0.0;
    // Surface velocity of i over j: u - (arm_i w_i + arm_j w_j) x n; a wall's own motion is in u.
    const double wx = arm_i * a.wx[k] + arm_j * b.wx[k];
    const double wy = arm_i * a.wy[k] + arm_j * b.wy[k];
    const double wz = arm_i * a.wz[k] + arm_j * b.wz[k];
    const double ux = (a.vx[k] - b.vx[k]) - (wy * nz - wz * ny);
    const double uy = (a.vy[k] - b.vy[k]) - (wz * nx - wx * nz);
    const double uz = (a.vz[k] - b.vz[k]) - (wx * ny - wy * nx);
    const double un = ux * nx + uy * ny + uz * nz;
    const double rx = a.wx[k] - b.wx[k], ry = a.wy[k] - b.wy[k], rz = a.wz[k] - b.wz[k];
    const double twist = rx * nx + ry * ny + rz * nz;
    c.normal_x[k] = nx;
    c.normal_y[k] = ny;
    c.normal_z[k] = nz;
    c.overlap[k] = overlap;
    c.radius[k] = grain ? ri * rj / (ri + rj) : ri;
    c.mass[k] = 1.0 / (a.inverse_mass[k] + b.inverse_mass[k]);
    c.arm_i[k] = arm_i;
    c.arm_j[k] = arm_j;
    c.approach[k] = -un;
    c.slip_x[k] = ux - un * nx;
    c.slip_y[k] = uy - un * ny;
    c.slip_z[k] = uz - un * nz;
    c.roll_x[k] = rx - twist * nx;
    c.roll_y[k] = ry - twist * ny;
    c.roll_z[k] = rz - twist * nz;
  }
}

/// Gaps of contacts that are apart; what overlaps has none.
template <Partner partner>
[[gnu::always_inline]] inline void gaps(ContactBlock& c) {
  for (int k = 0; k < width; ++k) {
    const double along = (c.i.x[k] - c.j.x[k]) * c.normal_x[k] +
                         (c.i.y[k] - c.j.y[k]) * c.normal_y[k] +
                         (c.i.z[k] - c.j.z[k]) * c.normal_z[k];
    const double distance = partner == Partner::grain ? c.arm_i[k] + c.arm_j[k] : along;
    const double gap = distance - c.i.radius[k] - c.j.radius[k];
    c.gap[k] = c.overlap[k] > 0.0 || gap < 0.0 ? 0.0 : gap;
  }
}

/// The ground law, from which effects depart: F = (4/3) E* sqrt(R*) d^(3/2), patch radius sqrt(R*
/// d) (Hertz 1882; Johnson 1985, Contact Mechanics, section 4.2).
[[gnu::always_inline]] inline void hertz(ContactBlock& c) {
  const double stiffness = 4.0 / 3.0 * c.modulus;
  for (int i = 0; i < width; ++i) {
    const double patch = std::sqrt(c.radius[i] * c.overlap[i]);
    const double force = stiffness * patch * c.overlap[i];
    c.patch_radius[i] = patch;
    c.elastic_force[i] = force;
    c.normal_force[i] = force;
    c.grip_force[i] = force;
  }
}

/// What the grains receive. The tangential force acts at the contact point: -arm_i n from centre i,
/// arm_j n from centre j.
[[gnu::always_inline]] inline void sum_loads(ContactBlock& c) {
  for (int i = 0; i < width; ++i) {
    const double nx = c.normal_x[i], ny = c.normal_y[i], nz = c.normal_z[i];
    const double tx = c.tangent_x[i], ty = c.tangent_y[i], tz = c.tangent_z[i];
    const double f = c.normal_force[i], arm_i = c.arm_i[i], arm_j = c.arm_j[i];
    const double mx = ny * tz - nz * ty, my = nz * tx - nx * tz, mz = nx * ty - ny * tx;
    const double cx = c.couple_x[i], cy = c.couple_y[i], cz = c.couple_z[i];
    c.force.x[i] = f * nx + tx;
    c.force.y[i] = f * ny + ty;
    c.force.z[i] = f * nz + tz;
    c.torque_i.x[i] = cx - arm_i * mx;
    c.torque_i.y[i] = cy - arm_i * my;
    c.torque_i.z[i] = cz - arm_i * mz;
    c.torque_j.x[i] = -cx - arm_j * mx;
    c.torque_j.y[i] = -cy - arm_j * my;
    c.torque_j.z[i] = -cz - arm_j * mz;
  }
}

/// Of contacts that are apart only effects that reach out keep a memory.
template <std::size_t I>
[[gnu::always_inline]] inline void forget_apart(const PairLaw& law,
                                                const ContactBlock& block,
                                                HistoryBlock history) {
  using E = std::tuple_element_t<I, AllEffects>;
  if constexpr (ContactHook<E> && !ReachHook<E>) {
    if (!law.active[I]) return;
    for (int column = 0; column < E::history_columns; ++column) {
      double* const values = history.column(law.history_start[I] + column);
      for (int i = 0; i < width; ++i) values[i] = block.overlap[i] > 0.0 ? values[i] : 0.0;
    }
  }
}

template <std::size_t I>
[[gnu::always_inline]] inline void apply_one(const PairLaw& law,
                                             ContactBlock& block,
                                             HistoryBlock history,
                                             double dt) {
  using E = std::tuple_element_t<I, AllEffects>;
  if constexpr (ContactHook<E>) {
    if (!law.active[I]) return;  // decided once per block, never per contact
    E::contact(block, std::get<I>(law.coefficients), history.from(law.history_start[I]), dt);
  }
}

template <std::size_t I>
[[gnu::always_inline]] inline void load_one(const PairLaw& law, ContactBlock& block) {
  using E = std::tuple_element_t<I, AllEffects>;
  if constexpr (LoadHook<E>) {
    if (law.active[I]) E::load(block, std::get<I>(law.coefficients));
  }
}

/// Active effects in catalogue order. The only place where laws are composed.
template <Partner partner>
inline void apply_to(const PairLaw& law, ContactBlock& block, HistoryBlock history, double dt) {
  block.modulus = law.elastic.modulus;
  block.shear_modulus = law.elastic.shear_modulus;
  constexpr std::make_index_sequence<effect_count> all;
  kinematics<partner>(block);
  if (law.reaches) {
    gaps<partner>(block);
    const auto forget = [&]<std::size_t... I>(std::index_sequence<I...>) {
      (forget_apart<I>(law, block, history), ...);
    };
    forget(all);
  }
  hertz(block);
  for (auto* column : {&block.shear_damping,
                       &block.tangent_x,
                       &block.tangent_y,
                       &block.tangent_z,
                       &block.couple_x,
                       &block.couple_y,
                       &block.couple_z}) {
    column->fill(0.0);
  }
  const auto contacts = [&]<std::size_t... I>(std::index_sequence<I...>) {
    (apply_one<I>(law, block, history, dt), ...);
  };
  contacts(all);
  sum_loads(block);
  const auto loads = [&]<std::size_t... I>(std::index_sequence<I...>) {
    (load_one<I>(law, block), ...);
  };
  loads(all);
}

}  // namespace

void apply(
    const PairLaw& law, Partner partner, ContactBlock& block, HistoryBlock history, double dt) {
  if (partner == Partner::grain) {
    AnyMachine<apply_to<Partner::grain>>::call(law, block, history, dt);
  } else {
    AnyMachine<apply_to<Partner::wall>>::call(law, block, history, dt);
  }
}

namespace {

PairElastic pair_elastic(const Material& a, const Material& b) {
  const auto bend = [](const Material& m) {
    return (1.0 - m.poisson_ratio) / (2.0 * m.shear_modulus);  // (1 - nu^2) / E
  };
  const auto shear = [](const Material& m) { return (2.0 - m.poisson_ratio) / m.shear_modulus; };
  return {1.0 / (bend(a) + bend(b)), 1.0 / (shear(a) + shear(b))};
}

template <class E>
constexpr int columns_of() {
  if constexpr (ContactHook<E>) return E::history_columns;
  return 0;
}

template <std::size_t... I>
constexpr int columns_of_all(std::index_sequence<I...> /*all*/) {
  return (columns_of<std::tuple_element_t<I, AllEffects>>() + ...);
}
static_assert(columns_of_all(std::make_index_sequence<std::tuple_size_v<AllEffects>>{}) <=
              most_history_columns);

template <std::size_t I>
void bind_one(const ParameterSet& set, MaterialId partner, PairLaw& law) {
  using E = std::tuple_element_t<I, AllEffects>;
  if constexpr (ContactHook<E> || LoadHook<E>) {
    const auto parameters = parameters_of<E>(set, {MaterialId::grain, partner});
    if (!is_active<E>(parameters)) return;
    law.active[I] = true;
    if constexpr (ContactHook<E>) {
      law.history_start[I] = law.history_columns;
      law.history_columns += E::history_columns;
      law.reaches = law.reaches || ReachHook<E>;
    }
    std::get<I>(law.coefficients) = E::prepare(parameters, law.elastic);
  }
}

template <std::size_t I>
double reach_of(const PairLaw& law, double reduced_radius) {
  using E = std::tuple_element_t<I, AllEffects>;
  if constexpr (ReachHook<E>) {
    if (law.active[I]) return E::reach(std::get<I>(law.coefficients), reduced_radius);
  }
  return 0.0;
}

template <std::size_t I>
void bind_body(const ParameterSet& set, BodyLaw& law) {
  using E = std::tuple_element_t<I, AllEffects>;
  if constexpr (BodyHook<E> || LiftHook<E>) {
    static_assert(E::scope == Scope::global);
    const auto parameters = parameters_of<E>(set, {});
    law.active[I] = is_active<E>(parameters);
    std::get<I>(law.coefficients) = parameters;
  }
}

template <std::size_t I>
void body_one(const BodyLaw& law, double diameter, const Vec3& velocity, Vec3& force) {
  using E = std::tuple_element_t<I, AllEffects>;
  if constexpr (BodyHook<E>) {
    if (law.active[I]) force += E::body(std::get<I>(law.coefficients), diameter, velocity);
  }
}

template <std::size_t I>
bool pulls(const BodyLaw& law) {
  return BodyHook<std::tuple_element_t<I, AllEffects>> && law.active[I];
}

template <std::size_t I>
bool shakes(const BodyLaw& law) {
  return LiftHook<std::tuple_element_t<I, AllEffects>> && law.active[I];
}

template <std::size_t I>
double lift_of(const BodyLaw& law, double time) {
  using E = std::tuple_element_t<I, AllEffects>;
  if constexpr (LiftHook<E>) {
    if (law.active[I]) return E::lift(std::get<I>(law.coefficients), time);
  }
  return 0.0;
}

}  // namespace

Material material_of(const ParameterSet& set, MaterialId id) {
  Material result{};
  for (const auto& field : material_fields) {
    const std::string name = std::string(Material::name) + "." + std::string(field.info.name);
    result.*field.member = set.get_or({name, {id}}, absent);
  }
  return result;
}

ContactModel::ContactModel(const ParameterSet& parameters) {
  for (std::size_t i = 0; i < laws_.size(); ++i) {
    const auto id = static_cast<MaterialId>(i);
    materials_[i] = material_of(parameters, id);
    laws_[i].elastic = pair_elastic(materials_[0], materials_[i]);
    const auto fold = [&]<std::size_t... I>(std::index_sequence<I...>) {
      (bind_one<I>(parameters, id, laws_[i]), ...);
    };
    fold(std::make_index_sequence<effect_count>{});
    history_columns_ = std::max(history_columns_, laws_[i].history_columns);
  }
  const auto bodies = [&]<std::size_t... I>(std::index_sequence<I...>) {
    (bind_body<I>(parameters, body_), ...);
    has_body_force_ = (pulls<I>(body_) || ...);
    lifts_ = (shakes<I>(body_) || ...);
  };
  bodies(std::make_index_sequence<effect_count>{});
}

double ContactModel::reach(double largest_radius) const {
  double farthest = 0.0;
  for (const PairLaw& law : laws_) {
    const auto fold = [&]<std::size_t... I>(std::index_sequence<I...>) {
      ((farthest = std::max(farthest, reach_of<I>(law, largest_radius))), ...);
    };
    fold(std::make_index_sequence<effect_count>{});
  }
  return farthest;
}

double ContactModel::lift(double time) const {
  const auto fold = [&]<std::size_t... I>(std::index_sequence<I...>) {
    return (lift_of<I>(body_, time) + ...);
  };
  return fold(std::make_index_sequence<effect_count>{});
}

Vec3 ContactModel::body_force(double diameter, const Vec3& velocity) const {
  Vec3 force;
  const auto fold = [&]<std::size_t... I>(std::index_sequence<I...>) {
    (body_one<I>(body_, diameter, velocity, force), ...);
  };
  fold(std::make_index_sequence<effect_count>{});
  return force;
}

}  // namespace repose::engine
