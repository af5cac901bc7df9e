#include "server/json/starting_study.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "server/json/key_json.hpp"
#include "server/json/text.hpp"

namespace repose::server {

using engine::make_key;
using engine::ParameterKey;
using enum engine::MaterialId;

namespace {

/// Walls in the order in which a study takes them.
constexpr std::array<std::string_view, 6> surfaces{
    "steel", "galvanized sheet metal", "aluminium", "acrylic", "glass", "perspex"};

/// Sliding friction on steel over that of grain on grain: Stahl 1950, as used by Boac et al. 2010.
constexpr double steel_share = 0.67;
/// Standard error of one published value that has no range, over the value: assumed.
constexpr double single_value_error = 0.05;

double rounded(double value, int digits) {
  if (value == 0.0) return 0.0;
  const double step = std::pow(10.0, digits - 1 - std::floor(std::log10(std::abs(value))));
  return std::round(value * step) / step;
}

/// The place of a property's surface in the order of preference: the last where it has none.
std::size_t rank(const PublishedProperty& property) {
  return static_cast<std::size_t>(std::ranges::find(surfaces, property.surface) - surfaces.begin());
}

std::string text_of(double value) { return to_text(Json(value)); }

class Builder {
 public:
  explicit Builder(const PublishedMaterial& material) : material_(material) {}

  StartingStudy build() {
    describe_materials();
    pair_parameter("sliding_friction.coefficient", steel_share);
    pair_parameter("restitution.coefficient", 1.0);
    pair_parameter("rolling_resistance.coefficient", 1.0);
    measure();
    Json study{{"name", material_.name + ", published properties"}, {"materials", materials_}};
    if (!fixed_.empty()) study["fixed"] = fixed_;
    study["free"] = free_;
    if (!tied_.empty()) study["tied"] = tied_;
    study["measurements"] = measurements_;
    study["budget"] = {{"evaluations", 32}, {"batch", 4}, {"fidelity", "draft"}};
    study["seed"] = 1;
    return {to_text(study, 2) + "\n", std::move(notes_)};
  }

 private:
  void note(std::string text) { notes_.push_back(std::move(text)); }

  [[nodiscard]] const PublishedProperty* named(std::string_view property) const {
    const auto found = std::ranges::find(
        material_.properties, property, [](const auto& p) { return std::string_view(p.property); });
    return found == material_.properties.end() ? nullptr : &*found;
  }

  /// What is published of a parameter: by the preferred surface, a range before a value.
  [[nodiscard]] const PublishedProperty* published(const ParameterKey& key) const {
    const PublishedProperty* best = nullptr;
    for (const PublishedProperty& property : material_.properties) {
      if (property.key != key) continue;
      const auto order = [](const PublishedProperty& p) {
        return std::pair(rank(p), !p.is_range());
      };
      if (best == nullptr || order(property) < order(*best)) best = &property;
    }
    return best;
  }

  /// The same, or the library's stand-in; null where there is neither.
  const PublishedProperty* known(const ParameterKey& key) {
    if (const auto* property = published(key)) return property;
    const auto& stand_ins = material_library().stand_ins;
    const auto found = std::ranges::find(
        stand_ins, key, [](const auto& p) { return p.key.value_or(ParameterKey{}); });
    if (found == stand_ins.end()) return nullptr;
    note(to_string(key) + ": " + found->doubt + " (" + listed_sources(*found) + ")");
    return &*found;
  }

  static std::string listed_sources(const PublishedProperty& property) {
    std::string text;
    for (const std::string& source : property.values.front().sources) {
      text += (text.empty() ? "" : "; ") + source;
    }
    return text;
  }

  static Json quantity(double value, const std::string& unit) {
    return {{"value", value}, {"unit", unit}};
  }

  void describe_materials() {
    Json& is_grain = materials_["grain"];
    const PublishedProperty& density = *known(make_key("material.density", {grain}));
    is_grain["density"] = quantity(rounded(density.middle(), 4), density.unit);
    is_grain["diameter"] = quantity(diameter(), "mm");
    const PublishedProperty& shear = *known(make_key("material.shear_modulus", {grain}));
    is_grain["shear_modulus"] = quantity(shear.lower, shear.unit);
    if (shear.is_range()) {
      note("material.shear_modulus:grain: the softest of " + text_of(shear.lower) + " to " +
           text_of(shear.upper) + " " + shear.unit + ", since the time of a run grows as its root");
    }
    const PublishedProperty& poisson = *known(make_key("material.poisson_ratio", {grain}));
    is_grain["poisson_ratio"] = quantity(rounded(poisson.middle(), 3), poisson.unit);
    for (const char* field : {"shear_modulus", "poisson_ratio"}) {
      const PublishedProperty& steel = *known(make_key(std::string("material.") + field, {wall}));
      materials_["wall"][field] = quantity(steel.middle(), steel.unit);
    }
  }

  /// mm. The engine's diameter is that of the sphere of mean volume, so a volume comes first.
  double diameter() {
    if (const auto* volume = named("grain_volume")) {
      note("material.diameter:grain: of the sphere of " + text_of(rounded(volume->middle(), 4)) +
           " mm3, the published kernel volume");
      return rounded(std::cbrt(6.0 * volume->middle() / std::numbers::pi), 4);
    }
    return rounded(known(make_key("material.diameter", {grain}))->middle(), 4);
  }

  /// A parameter of grain on grain and of grain on wall. What is not published of the wall follows
  /// the grains.
  void pair_parameter(std::string_view field, double share) {
    const ParameterKey of_grains = make_key(field, {grain, grain});
    const ParameterKey of_wall = make_key(field, {grain, wall});
    admit(of_grains, *known(of_grains));
    const PublishedProperty* on_wall = published(of_wall);
    if (on_wall != nullptr) {
      note(to_string(of_wall) + ": the wall is " + on_wall->surface);
      admit(of_wall, *on_wall);
      return;
    }
    Json tie = print_key(of_wall);
    tie["to"] = print_key(of_grains);
    tie["factor"] = share;
    tied_.push_back(std::move(tie));
  }

  void admit(const ParameterKey& key, const PublishedProperty& property) {
    Json entry = print_key(key);
    if (property.is_range()) {
      entry["lower"] = property.lower;
      entry["upper"] = property.upper;
    } else {
      entry["value"] = property.lower;
    }
    entry["unit"] = property.unit;
    (property.is_range() ? free_ : fixed_).push_back(std::move(entry));
  }

  /// A range of published values is taken as a rectangular distribution, whose standard deviation
  /// is its width over the root of 12 (JCGM 100:2008, 4.3.7).
  void measure() {
    for (const PublishedProperty& property : material_.properties) {
      if (property.experiment.empty()) continue;
      const double error = property.is_range() ? (property.upper - property.lower) / std::sqrt(12.0)
                                               : single_value_error * property.middle();
      measurements_.push_back({{"experiment", property.experiment},
                               {"observable", property.observable},
                               {"value", rounded(property.middle(), 4)},
                               {"unit", property.unit},
                               {"standard_error", rounded(error, 2)},
                               {"source", "published: " + listed_sources(property)}});
      note(property.experiment + "." + property.observable +
           (property.is_range() ? ": middle and spread of the published values"
                                : ": one published value, an error of 5 % assumed") +
           "; put your own measurement there");
    }
  }

  const PublishedMaterial& material_;
  Json materials_ = Json::object();
  Json fixed_ = Json::array(), free_ = Json::array(), tied_ = Json::array();
  Json measurements_ = Json::array();
  std::vector<std::string> notes_;
};

}  // namespace

StartingStudy starting_study(const PublishedMaterial& material) {
  return Builder(material).build();
}

}  // namespace repose::server
