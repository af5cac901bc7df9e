#include "engine/contact_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

// One binary, fast everywhere: the block kernel is compiled for three instruction sets and the
// loader picks one. Bits are equal on all, since nothing is contracted. clang 14 refuses the
// attribute, and the sanitizers' start-up cannot resolve it.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && !defined(REPOSE_SANITIZED)
#define REPOSE_ANY_MACHINE \
  __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4"), flatten))
#else
#define REPOSE_ANY_MACHINE
#endif

namespace repose::engine {

namespace {

constexpr int width = ContactBlock::width;

/// Geometry and relative motion from the gathered ends. Velocities at the contact point include
/// both spins; the point divides the overlap of two grains in halves and lies on a wall's surface.
template <Partner partner>
[[gnu::always_inline]] inline void kinematics(ContactBlock& c) {
  constexpr double share_i = partner == Partner::grain ? 0.5 : 1.0;
  for (int i = 0; i < width; ++i) {
    const double dx = c.normal_x[i], dy = c.normal_y[i], dz = c.normal_z[i];
    const double distance = std::sqrt(dx * dx + dy * dy + dz * dz);
    const double inverse = 1.0 / distance;
    const double nx = dx * inverse, ny = dy * inverse, nz = dz * inverse;
    const double ri = c.radius_i[i], rj = c.radius_j[i];
    const double gap = ri + rj - distance;
    const double overlap = gap > 0.0 ? gap : 0.0;
    const double arm_i = ri - share_i * overlap;
    const double arm_j = distance - arm_i;
    const double wxi = c.spin_i_x[i], wyi = c.spin_i_y[i], wzi = c.spin_i_z[i];
    const double wxj = c.spin_j_x[i], wyj = c.spin_j_y[i], wzj = c.spin_j_z[i];
    // Surface velocity of i over j: u - (arm_i w_i + arm_j w_j) x n; a wall's own motion is in u.
    const double reach_j = partner == Partner::grain ? arm_j : 0.0;
    const double wx = arm_i * wxi + reach_j * wxj;
    const double wy = arm_i * wyi + reach_j * wyj;
    const double wz = arm_i * wzi + reach_j * wzj;
    const double ux = c.slip_x[i] - (wy * nz - wz * ny);
    const double uy = c.slip_y[i] - (wz * nx - wx * nz);
    const double uz = c.slip_z[i] - (wx * ny - wy * nx);
    const double un = ux * nx + uy * ny + uz * nz;
    const double rx = wxi - wxj, ry = wyi - wyj, rz = wzi - wzj;
    const double twist = rx * nx + ry * ny + rz * nz;
    c.normal_x[i] = nx;
    c.normal_y[i] = ny;
    c.normal_z[i] = nz;
    c.overlap[i] = overlap;
    c.radius[i] = partner == Partner::grain ? ri * rj / (ri + rj) : ri;
    c.mass[i] = 1.0 / (c.inverse_mass_i[i] + c.inverse_mass_j[i]);
    c.arm_i[i] = arm_i;
    c.arm_j[i] = reach_j;
    c.approach[i] = -un;
    c.slip_x[i] = ux - un * nx;
    c.slip_y[i] = uy - un * ny;
    c.slip_z[i] = uz - un * nz;
    c.roll_x[i] = rx - twist * nx;
    c.roll_y[i] = ry - twist * ny;
    c.roll_z[i] = rz - twist * nz;
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
    c.force_x[i] = f * nx + tx;
    c.force_y[i] = f * ny + ty;
    c.force_z[i] = f * nz + tz;
    c.torque_i_x[i] = cx - arm_i * mx;
    c.torque_i_y[i] = cy - arm_i * my;
    c.torque_i_z[i] = cz - arm_i * mz;
    c.torque_j_x[i] = -cx - arm_j * mx;
    c.torque_j_y[i] = -cy - arm_j * my;
    c.torque_j_z[i] = -cz - arm_j * mz;
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

}  // namespace

// Active effects in catalogue order. The only place where laws are composed.
REPOSE_ANY_MACHINE
void apply(
    const PairLaw& law, Partner partner, ContactBlock& block, HistoryBlock history, double dt) {
  block.modulus = law.elastic.modulus;
  block.shear_modulus = law.elastic.shear_modulus;
  if (partner == Partner::grain) {
    kinematics<Partner::grain>(block);
  } else {
    kinematics<Partner::wall>(block);
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
  const auto fold = [&]<std::size_t... I>(std::index_sequence<I...>) {
    (apply_one<I>(law, block, history, dt), ...);
  };
  fold(std::make_index_sequence<effect_count>{});
  sum_loads(block);
}

namespace {

PairElastic pair_elastic(const Material& a, const Material& b) {
  const auto bend = [](const Material& m) {
    return (1.0 - m.poisson_ratio) / (2.0 * m.shear_modulus);  // (1 - nu^2) / E
  };
  const auto shear = [](const Material& m) { return (2.0 - m.poisson_ratio) / m.shear_modulus; };
  return {1.0 / (bend(a) + bend(b)), 1.0 / (shear(a) + shear(b))};
}

template <std::size_t I>
void bind_one(const ParameterSet& set, MaterialId partner, PairLaw& law) {
  using E = std::tuple_element_t<I, AllEffects>;
  if constexpr (ContactHook<E>) {
    const auto parameters = parameters_of<E>(set, {MaterialId::grain, partner});
    if (!is_active<E>(parameters)) return;
    law.active[I] = true;
    law.history_start[I] = law.history_columns;
    law.history_columns += E::history_columns;
    std::get<I>(law.coefficients) = E::prepare(parameters, law.elastic);
  }
}

Material material_of(const ParameterSet& set, MaterialId id) {
  Material result{};
  for (const auto& field : material_fields) {
    const std::string name = std::string(Material::name) + "." + std::string(field.info.name);
    result.*field.member = set.get_or({name, {id}}, absent);
  }
  return result;
}

}  // namespace

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
}

}  // namespace repose::engine
