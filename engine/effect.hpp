/// Effect: one physical departure from smooth elastic spheres, and where it may act.
///
/// An effect is a struct in one file of effects/, admitted by one line of effects/all.hpp. It holds
/// a `text`, a table of `fields`, its `stage` and `scope`, and at least one hook:
///
///   amend      before anything is bound: `amends` names the parameter that `factor` multiplies
///              under the experiment's conditions
///   populate   once, when grains are made: their sizes; of these effects one may be on
///   shape      once, when grains are made: the spheres of which a grain consists; one may be on
///   prepare    once per material pair: Parameters, pair elasticity -> Coefficients
///   contact    each step, per block of contacts: columns in, columns out
///   reach      each time neighbours are sought: how far from touch it still acts, m
///   load       the same after the sums: what each grain receives for itself, not as one of a pair
///   lift       each step while a vessel is filled: acceleration of the whole apparatus
///   body       each step, per grain, contacts or not: diameter and velocity -> force
///   strong     never in a run: parameters of a strong but plausible effect on such grains, where
///              the diagnosis probes; an effect without it is never suspected to be missing
///
/// At the null value of all its parameters an effect is exactly absent.
#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "engine/clump_shape.hpp"
#include "engine/condition.hpp"
#include "engine/contact_block.hpp"
#include "engine/field.hpp"
#include "engine/random.hpp"
#include "engine/vec3.hpp"

namespace repose::engine {

/// When an effect acts; the list in effects/all.hpp is in this order.
enum class Stage : std::uint8_t {
  amendment,
  population,
  filling,
  dissipation,
  adhesion,
  friction,
  rolling,
  body,
};

inline constexpr std::array<std::string_view, 8> stage_names{
    "amendment",
    "population",
    "filling",
    "dissipation",
    "adhesion",
    "friction",
    "rolling",
    "body",
};

/// How many materials a parameter belongs to: none, one, or a pair. The enumerators' values are
/// that number.
enum class Scope : std::uint8_t { global = 0, material = 1, pair = 2 };

inline constexpr std::array<std::string_view, 3> scope_names{"global", "material", "pair"};

struct EffectText {
  std::string_view name;
  std::string_view title;
  std::string_view summary;
  std::string_view citation;
  std::string_view family = {};     ///< effects of one family are other forms of the same physics
  std::string_view condition = {};  ///< it shows only between experiments that differ in this
};

/// Elastic constants of two materials in contact (Johnson 1985, Contact Mechanics, ch. 4 and 7).
struct PairElastic {
  double modulus;        ///< E* = 1 / ((1 - nu1^2) / E1 + (1 - nu2^2) / E2), Pa
  double shear_modulus;  ///< G* = 1 / ((2 - nu1) / G1 + (2 - nu2) / G2), Pa
};

/// The grains that an effect's strength is measured by.
struct GrainScale {
  double radius;        ///< m
  double density;       ///< kg/m3
  PairElastic elastic;  ///< of grain on grain

  /// kg
  [[nodiscard]] double mass() const {
    return 4.0 / 3.0 * unit::pi * radius * radius * radius * density;
  }

  /// N
  [[nodiscard]] double weight() const { return 9.81 * mass(); }

  /// Of two grains pressed together by the weight of one (Hertz; R* = R / 2), m.
  [[nodiscard]] double overlap() const {
    const double force = 0.75 * weight() / elastic.modulus;
    return std::cbrt(2.0 * force * force / radius);
  }
};

/// A catalogue entry: made from the effect's file, read by everyone else.
struct EffectInfo {
  EffectText text;
  Stage stage;
  Scope scope;
  std::span<const FieldInfo> fields;
  /// Values of the fields for a strong but plausible effect on such grains, SI; null where the
  /// effect is never suspected to be missing.
  std::vector<double> (*strong)(const GrainScale& grains) = nullptr;
};

template <class E>
concept ContactHook = requires(ContactBlock& block,
                               const typename E::Coefficients& coefficients,
                               HistoryBlock history,
                               double dt) {
  { E::contact(block, coefficients, history, dt) } -> std::same_as<void>;
  { E::history_columns } -> std::convertible_to<int>;
};

template <class E>
concept LoadHook = requires(ContactBlock& block, const typename E::Coefficients& coefficients) {
  { E::load(block, coefficients) } -> std::same_as<void>;
};

/// The block's `gap` is there for its contacts; from touch on they stay closed until their gap
/// exceeds the reach of the largest grains.
template <class E>
concept ReachHook = ContactHook<E> && requires(const typename E::Coefficients& coefficients) {
  { E::reach(coefficients, 0.0) } -> std::same_as<double>;  // of a reduced radius, m
};

template <class E>
concept BodyHook = requires(const typename E::Coefficients& coefficients, const Vec3& velocity) {
  { E::body(coefficients, 0.0, velocity) } -> std::same_as<Vec3>;  // diameter, m
};

template <class E>
concept PopulateHook = requires(const typename E::Parameters& parameters, Random& random) {
  { E::populate(parameters, random) } -> std::same_as<double>;  // grain volume over mean volume
  { E::smallest(parameters) } -> std::same_as<double>;          // of these
  { E::largest(parameters) } -> std::same_as<double>;
};

template <class E>
concept ShapeHook = requires(const typename E::Parameters& parameters) {
  { E::shape(parameters) } -> std::same_as<std::vector<ClumpMember>>;
};

template <class E>
concept AmendHook = requires(const typename E::Parameters& parameters,
                             const Conditions& conditions) {
  { E::amends } -> std::convertible_to<std::string_view>;
  { E::factor(parameters, conditions) } -> std::same_as<double>;
};

template <class E>
concept LiftHook = requires(const typename E::Coefficients& coefficients) {
  { E::lift(coefficients, 0.0) } -> std::same_as<double>;  // s -> m/s2, upwards
};

template <class E>
concept StrongHook = requires(const GrainScale& grains) {
  { E::strong(grains) } -> std::same_as<typename E::Parameters>;
};

template <class E>
concept Effect = requires {
  { E::text } -> std::convertible_to<EffectText>;
  { E::stage } -> std::convertible_to<Stage>;
  { E::scope } -> std::convertible_to<Scope>;
  E::fields;
}
&&sizeof(typename E::Parameters) == E::fields.size() * sizeof(double) &&
    (ContactHook<E> || LoadHook<E> || BodyHook<E> || PopulateHook<E> || ShapeHook<E> ||
     AmendHook<E> || LiftHook<E>);

}  // namespace repose::engine
