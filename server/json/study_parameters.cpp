#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "engine/catalogue.hpp"
#include "engine/unit.hpp"
#include "server/json/codec.hpp"
#include "server/json/read_key.hpp"
#include "server/json/study.hpp"

namespace repose::server {

using engine::FieldInfo;
using engine::MaterialId;

namespace {

constexpr std::array<std::string_view, 4> part_words{
    "given under materials", "fixed", "free", "tied"};

/// Notes that the part gives the parameter; complains where another one did already. What is free
/// may be described under materials: the search then decides.
bool claim(const NamedParameter& named, Part part, const Place& place, Study& study) {
  const auto [entry, fresh] =
      study.claims.try_emplace(named.key, Study::Claim{part, place.pointer()});
  if (fresh) return true;
  if (entry->second.part == Part::materials && part == Part::free) {
    entry->second = {part, place.pointer()};
    study.calibration.fixed.erase(named.key);
    return true;
  }
  const auto word = part_words.at(static_cast<std::size_t>(entry->second.part));
  place.complain(named.text + " is already " + std::string(word) + " at " + entry->second.pointer,
                 "each parameter once: under materials, in fixed, in free or in tied");
  return false;
}

void read_fixed_one(const Place& place, Study& study) {
  Members members(place);
  const auto named = read_key(members);
  const Place value_place = members.required("value", "a number");
  const Place unit_place = members.required("unit", "the unit of the value");
  members.no_others();
  if (!named || !claim(*named, Part::fixed, place, study)) return;
  if (!value_place.exists() || !unit_place.exists()) return;
  const auto unit = read_unit(unit_place, named->field->unit, named->text);
  if (!unit) return;
  const auto value = read_bounded(value_place, *unit, *named->field, named->text);
  if (value) study.calibration.fixed.set(named->key, *value);
}

/// The bounds of a free parameter, checked against each other.
bool in_order(const calibrator::FreeParameter& free, const Place& lower) {
  if (!(free.lower < free.upper)) {
    lower.complain("the lower bound must be below the upper one",
                   "less than " + engine::short_number(free.upper / free.unit.factor));
    return false;
  }
  if (free.scale == calibrator::Scale::log && !(free.lower > 0.0)) {
    lower.complain("a parameter on a logarithmic scale has a lower bound above zero",
                   "more than 0, or \"scale\": \"linear\"");
    return false;
  }
  return true;
}

/// What is known beforehand, in the unit of the bounds.
std::optional<calibrator::Prior> read_prior(const Place& place,
                                            const calibrator::FreeParameter& free,
                                            const engine::FieldInfo& field,
                                            const std::string& what) {
  Members members(place);
  const Place mean_place = members.required("mean", "the value it is thought to have");
  const Place deviation_place = members.required("standard_deviation", "how surely");
  members.no_others();
  if (!mean_place.exists() || !deviation_place.exists()) return std::nullopt;
  const auto mean = read_bounded(mean_place, free.unit, field, what);
  const auto deviation = deviation_place.number();
  if (!mean || !deviation) return std::nullopt;
  if (!(*deviation > 0.0)) {
    deviation_place.complain("a standard deviation is above zero", "more than 0");
    return std::nullopt;
  }
  if (*mean < free.lower || *mean > free.upper) {
    mean_place.complain("the prior's mean lies outside the bounds of the search",
                        engine::short_number(free.lower / free.unit.factor) + " to " +
                            engine::short_number(free.upper / free.unit.factor));
    return std::nullopt;
  }
  return calibrator::Prior{*mean, *deviation * free.unit.factor};
}

void read_free_one(const Place& place, Study& study) {
  Members members(place);
  const auto named = read_key(members);
  const Place lower_place = members.required("lower", "the smallest value to try");
  const Place upper_place = members.required("upper", "the largest value to try");
  const Place unit_place = members.required("unit", "the unit of both bounds");
  const Place scale_place = members.optional("scale");
  const Place prior_place = members.optional("prior");
  members.no_others();

  calibrator::FreeParameter free;
  bool scale_known = true;
  if (scale_place.exists()) {
    const auto scale = scale_place.one_of(calibrator::scale_names, "scale");
    scale_known = scale.has_value();
    free.scale = static_cast<calibrator::Scale>(scale.value_or(0));
  }
  if (!named || !claim(*named, Part::free, place, study) || !unit_place.exists()) return;
  const auto unit = read_unit(unit_place, named->field->unit, named->text);
  if (!unit || !lower_place.exists() || !upper_place.exists()) return;
  const auto lower = read_bounded(lower_place, *unit, *named->field, named->text);
  const auto upper = read_bounded(upper_place, *unit, *named->field, named->text);
  if (!lower || !upper || !scale_known) return;
  free.key = named->key;
  free.lower = *lower;
  free.upper = *upper;
  free.unit = *unit;
  if (prior_place.exists()) {
    free.prior = read_prior(prior_place, free, *named->field, named->text);
    if (!free.prior) return;
  }
  if (in_order(free, lower_place)) study.calibration.free.push_back(std::move(free));
}

void read_tied_one(const Place& place, Study& study) {
  Members members(place);
  const auto named = read_key(members);
  const Place to_place = members.required("to", R"({"field", "between"} of the other parameter)");
  const Place factor_place = members.optional("factor");
  members.no_others();

  std::optional<NamedParameter> to;
  if (to_place.exists()) {
    Members to_members(to_place);
    if (to_members.is_object()) to = read_key(to_members);
    to_members.no_others();
  }
  const auto factor = factor_place.exists() ? factor_place.number() : std::optional(1.0);
  if (!named || !claim(*named, Part::tied, place, study) || !to || !factor) return;
  if (to->field->unit.dimension != named->field->unit.dimension) {
    to_place.complain(
        named->text + " cannot follow " + to->text + ": they measure different things",
        to->text,
        "a parameter in one of " + listed(units_like(named->field->unit)));
    return;
  }
  study.ties.push_back({{named->key, to->key, *factor}, place});
  study.calibration.tied.push_back({named->key, to->key, *factor});
}

}  // namespace

void read_materials(const Place& place, Study& study) {
  for (const auto& [name, member] : Members(place).all()) {
    const auto found = std::ranges::find(engine::material_names, std::string_view(name));
    if (found == engine::material_names.end()) {
      member.complain("there is no such material" + did_you_mean(name, engine::material_names),
                      "\"" + name.substr(0, 64) + "\"",
                      listed(engine::material_names));
      continue;
    }
    const auto material = static_cast<MaterialId>(found - engine::material_names.begin());
    const auto key_of = [material](const FieldInfo& field) {
      return engine::make_key(std::string(engine::Material::name) + "." + std::string(field.name),
                              {material});
    };
    read_fields(
        member,
        engine::material_catalogue(),
        name,
        {.value = [&](const FieldInfo& field,
                      double value,
                      const Place&) { study.calibration.fixed.set(key_of(field), value); },
         .named =
             [&](const FieldInfo& field, const Place& at) {
               study.claims.try_emplace(key_of(field), Study::Claim{Part::materials, at.pointer()});
             },
         .other =
             [&](std::string_view other, const Place& at) {
               const bool is_shape = other == "shape" && material == MaterialId::grain;
               if (is_shape) read_shape(at, study);
               return is_shape;
             }});
  }
}

void read_fixed(const Place& place, Study& study) {
  for (const Place& element : place.elements()) read_fixed_one(element, study);
}

void read_free(const Place& place, Study& study) {
  for (const Place& element : place.elements()) {
    ++study.free_named;
    read_free_one(element, study);
  }
}

void read_tied(const Place& place, Study& study) {
  for (const Place& element : place.elements()) read_tied_one(element, study);
}

}  // namespace repose::server
