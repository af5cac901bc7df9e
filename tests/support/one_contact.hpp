/// One contact under a law, its overlap and motion given step by step: what an effect does, without
/// a world around it.
#pragma once

#include <array>
#include <memory>
#include <string_view>

#include "engine/contact_model.hpp"
#include "tests/support/reference_grain.hpp"

namespace repose::tests {

/// The same value for grain-grain and grain-wall.
inline void set_pairs(engine::ParameterSet& set, std::string_view field, double value) {
  using engine::MaterialId;
  for (const MaterialId partner : {MaterialId::grain, MaterialId::wall}) {
    set.set(engine::make_key(field, {MaterialId::grain, partner}), value);
  }
}

/// Where the ends of a contact are and how they move; end i lies above end j.
struct ContactState {
  double overlap = 0.0;   ///< m; below zero where the surfaces are apart
  double approach = 0.0;  ///< m/s
  double slip = 0.0;      ///< velocity of end i along x, m/s
  double twist = 0.0;     ///< spin of end i about the normal, rad/s
};

class OneContact {
 public:
  /// A radius j of 0 stands for a wall.
  OneContact(const engine::ParameterSet& set, double radius_i, double radius_j)
      : model_(set), radius_i_(radius_i), radius_j_(radius_j) {}

  /// A step in that state; what the law made of it is in lane 0.
  const engine::ContactBlock& push(const ContactState& state, double dt = 1e-6) {
    using engine::MaterialId, engine::Partner;
    constexpr double density = 1228.0;
    const bool grain = radius_j_ > 0.0;
    engine::ContactBlock& c = *block_;
    c = {};
    for (int lane = 0; lane < engine::ContactBlock::width; ++lane) {
      const auto mobility = [](double r) {
        return 1.0 / (4.0 / 3.0 * engine::unit::pi * r * r * r * density);
      };
      c.i.z[lane] = radius_i_ + radius_j_ - state.overlap;
      c.i.radius[lane] = radius_i_;
      c.j.radius[lane] = radius_j_;
      c.i.inverse_mass[lane] = mobility(radius_i_);
      c.j.inverse_mass[lane] = grain ? mobility(radius_j_) : 0.0;
      c.i.vz[lane] = -state.approach;
      c.i.vx[lane] = state.slip;
      c.i.wz[lane] = state.twist;
    }
    c.count = engine::ContactBlock::width;
    engine::apply(model_.law(grain ? MaterialId::grain : MaterialId::wall),
                  grain ? Partner::grain : Partner::wall,
                  c,
                  engine::HistoryBlock(history_.data()),
                  dt);
    return c;
  }

  /// Force along the normal in that state, N.
  double force(const ContactState& state) { return push(state).normal_force[0]; }

  [[nodiscard]] double reduced_radius() const {
    return radius_j_ > 0.0 ? radius_i_ * radius_j_ / (radius_i_ + radius_j_) : radius_i_;
  }
  [[nodiscard]] const engine::PairElastic& elastic() const {
    using engine::MaterialId;
    return model_.law(radius_j_ > 0.0 ? MaterialId::grain : MaterialId::wall).elastic;
  }
  /// Hertz's force at an overlap, N.
  [[nodiscard]] double hertz(double overlap) const {
    return 4.0 / 3.0 * elastic().modulus * std::sqrt(reduced_radius() * overlap) * overlap;
  }

 private:
  engine::ContactModel model_;
  double radius_i_, radius_j_;
  std::unique_ptr<engine::ContactBlock> block_ = std::make_unique<engine::ContactBlock>();
  alignas(
      64) std::array<double, engine::ContactBlock::width * engine::most_history_columns> history_{};
};

}  // namespace repose::tests
