/// ContactModel: a ParameterSet bound for running: one PairLaw per pair of materials, and the fold
/// that applies it to a block of contacts.
#pragma once

#include <array>
#include <tuple>

#include "engine/effects/all.hpp"
#include "engine/parameter_set.hpp"

namespace repose::engine {

/// What an effect needs during a step; nothing where it does not act on contacts.
struct NoCoefficients {};

template <class E>
struct CoefficientsOf {
  using type = NoCoefficients;
};
template <class E>
requires ContactHook<E> || LoadHook<E> || BodyHook<E> || LiftHook<E>
struct CoefficientsOf<E> {
  using type = typename E::Coefficients;
};

template <class List>
struct CoefficientsOfAll;
template <class... E>
struct CoefficientsOfAll<std::tuple<E...>> {
  using type = std::tuple<typename CoefficientsOf<E>::type...>;
};

/// The law of contact between two materials.
struct PairLaw {
  PairElastic elastic{};
  std::array<bool, effect_count> active{};
  std::array<int, effect_count> history_start{};  ///< first history column of each active effect
  int history_columns = 0;
  bool reaches = false;  ///< whether an active effect acts between surfaces that are apart
  CoefficientsOfAll<AllEffects>::type coefficients;
};

/// What acts on every grain, contacts or not, and on the apparatus.
struct BodyLaw {
  std::array<bool, effect_count> active{};
  CoefficientsOfAll<AllEffects>::type coefficients;
};

/// Forces on a block of contacts: Hertz, then every active effect in the order of the list.
void apply(
    const PairLaw& law, Partner partner, ContactBlock& block, HistoryBlock history, double dt);

/// A material's properties, SI; NaN where the set does not give them.
Material material_of(const ParameterSet& set, MaterialId id);

/// A parameter set bound for running.
class ContactModel {
 public:
  explicit ContactModel(const ParameterSet& parameters);

  /// The law of a grain against another grain, or against a surface of that material. A surface of
  /// grain material has the friction and the stiffness of the grains.
  [[nodiscard]] const PairLaw& law(MaterialId partner) const {
    return laws_[static_cast<std::size_t>(partner)];
  }
  [[nodiscard]] const Material& material(MaterialId id) const {
    return materials_[static_cast<std::size_t>(id)];
  }
  /// How far from touch a contact may still act, of grains up to that radius, m.
  [[nodiscard]] double reach(double largest_radius) const;
  /// Whether grains feel a force that is neither contact nor gravity.
  [[nodiscard]] bool has_body_force() const { return has_body_force_; }
  /// That force on a grain with the volume of a sphere of that diameter (m), N.
  [[nodiscard]] Vec3 body_force(double diameter, const Vec3& velocity) const;
  /// Whether the apparatus is shaken while it is filled.
  [[nodiscard]] bool lifts() const { return lifts_; }
  /// Its acceleration that long (s) after the filling began, upwards, m/s2.
  [[nodiscard]] double lift(double time) const;
  /// Columns of history a contact carries; the same for all laws.
  [[nodiscard]] int history_columns() const { return history_columns_; }

 private:
  std::array<Material, material_names.size()> materials_{};
  std::array<PairLaw, material_names.size()> laws_{};
  BodyLaw body_;
  bool has_body_force_ = false;
  bool lifts_ = false;
  int history_columns_ = 0;
};

/// The parameters of an effect as a set gives them, null where it does not.
template <Effect E>
typename E::Parameters parameters_of(const ParameterSet& set,
                                     const std::vector<MaterialId>& between) {
  typename E::Parameters result{};
  for (const auto& field : E::fields) {
    const std::string name = std::string(E::text.name) + "." + std::string(field.info.name);
    result.*field.member = set.get_or(make_key(name, between), field.info.null_value);
  }
  return result;
}

/// Whether any parameter is off its null.
template <Effect E>
bool is_active(const typename E::Parameters& parameters) {
  for (const auto& field : E::fields) {
    if (parameters.*field.member != field.info.null_value) return true;
  }
  return false;
}

}  // namespace repose::engine
