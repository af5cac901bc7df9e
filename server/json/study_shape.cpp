#include <array>
#include <string>
#include <vector>

#include "engine/effects/sphere_clump.hpp"
#include "server/json/codec.hpp"
#include "server/json/study.hpp"

namespace repose::server {

namespace {

using engine::effects::SphereClump;

constexpr std::array<std::string_view, 4> members_of_sphere{"x", "y", "z", "radius"};

/// A sphere's numbers as parameters of the effect: "x" of the first is sphere_clump.x_1.
void read_sphere(const Place& place,
                 std::size_t number,
                 const engine::Unit& unit,
                 const std::string& shape_pointer,
                 Study& study) {
  Members members(place);
  for (std::size_t k = 0; k < members_of_sphere.size(); ++k) {
    const Place at = members.required(members_of_sphere.at(k), "a length in the shape's unit");
    const engine::FieldInfo& field = SphereClump::fields.at(4 * number + k).info;
    const auto key =
        engine::make_key(std::string(SphereClump::text.name) + "." + std::string(field.name),
                         {engine::MaterialId::grain});
    study.claims.try_emplace(key, Study::Claim{Part::materials, shape_pointer});
    if (!at.exists()) continue;
    const auto value = read_bounded(at, unit, field, members_of_sphere.at(k));
    if (value) study.calibration.fixed.set(key, *value);
  }
  members.no_others();
}

}  // namespace

void read_shape(const Place& place, Study& study) {
  Members members(place);
  const Place spheres = members.required("spheres", R"([{"x", "y", "z", "radius"}, ...])");
  const Place unit_place = members.required("unit", "the unit of all lengths");
  members.no_others();
  if (!spheres.exists() || !unit_place.exists()) return;
  const auto unit = read_unit(unit_place, engine::unit::millimetre, "a length");
  const std::vector<Place> list = spheres.elements();
  if (list.empty() || list.size() > engine::most_clump_members) {
    spheres.complain("a grain is a clump of at most eight spheres",
                     std::to_string(list.size()) + " spheres",
                     "1 to " + std::to_string(engine::most_clump_members) + " spheres");
    return;
  }
  if (!unit) return;
  for (std::size_t k = 0; k < list.size(); ++k) {
    read_sphere(list[k], k, *unit, place.pointer(), study);
  }
}

}  // namespace repose::server
