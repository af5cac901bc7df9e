#include <optional>
#include <utility>

#include "server/json/codec.hpp"
#include "server/json/read_key.hpp"
#include "server/json/study.hpp"

namespace repose::server {

using calibrator::Constraint;

namespace {

struct NamedTerm {
  NamedParameter parameter;
  double coefficient;
};

std::optional<NamedTerm> read_term(const Place& place) {
  Members members(place);
  auto named = read_key(members);
  const Place coefficient_place = members.optional("coefficient");
  members.no_others();
  const auto coefficient =
      coefficient_place.exists() ? coefficient_place.number() : std::optional(1.0);
  if (!named || !coefficient) return std::nullopt;
  return NamedTerm{*std::move(named), *coefficient};
}

/// The terms; they must measure the same thing, and have a value.
std::optional<std::vector<NamedTerm>> read_terms(const Place& place, const Study& study) {
  std::vector<NamedTerm> terms;
  bool good = true;
  for (const Place& element : place.elements()) {
    auto term = read_term(element);
    good = good && term;
    if (!term) continue;
    if (!study.claims.contains(term->parameter.key)) {
      element.complain(term->parameter.text + " is neither free nor tied nor fixed",
                       term->parameter.text,
                       "a parameter of the study");
      good = false;
    } else if (!terms.empty() && term->parameter.field->unit.dimension !=
                                     terms.front().parameter.field->unit.dimension) {
      element.complain(
          term->parameter.text + " and " + terms.front().parameter.text +
              " cannot be added: they measure different things",
          term->parameter.text,
          "a parameter in one of " + listed(units_like(terms.front().parameter.field->unit)));
      good = false;
    }
    terms.push_back(*std::move(term));
  }
  if (place.exists() && place.json().is_array() && terms.empty() && good) {
    place.complain("a constraint has at least one term",
                   R"([{"field", "between", "coefficient"}, ...])");
    good = false;
  }
  if (!good || terms.empty()) return std::nullopt;
  return terms;
}

void read_constraint(const Place& place, Study& study) {
  Members members(place);
  const Place terms_place =
      members.required("terms", R"([{"field", "between", "coefficient"}, ...])");
  const Place bound_place = members.required("bound", "what their sum may be at most");
  const Place unit_place = members.required("unit", "the unit of the bound");
  members.no_others();
  const auto terms = read_terms(terms_place, study);
  const auto bound = bound_place.exists() ? bound_place.number() : std::nullopt;
  if (!terms || !bound || !unit_place.exists()) return;
  const auto unit =
      read_unit(unit_place, terms->front().parameter.field->unit, terms->front().parameter.text);
  if (!unit) return;
  Constraint constraint{{}, *bound * unit->factor, *unit};
  for (const NamedTerm& term : *terms) {
    constraint.terms.push_back({term.parameter.key, term.coefficient});
  }
  study.calibration.constraints.push_back(std::move(constraint));
}

}  // namespace

void read_constraints(const Place& place, Study& study) {
  for (const Place& element : place.elements()) read_constraint(element, study);
}

}  // namespace repose::server
