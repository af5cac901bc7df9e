#include "engine/shape_population.hpp"

#include <vector>

#include "engine/visit_population.hpp"

namespace repose::engine {

namespace {

struct NamedShape {
  std::string effect;
  std::vector<ClumpMember> members;
};

std::vector<NamedShape> shapes_of(const ParameterSet& parameters) {
  std::vector<NamedShape> shapes;
  visit_population(parameters, [&shapes]<class E>(const E*, const typename E::Parameters& p) {
    if constexpr (ShapeHook<E>) shapes.push_back({std::string(E::text.name), E::shape(p)});
  });
  return shapes;
}

}  // namespace

std::optional<ClumpShape> shape_of_grains(const ParameterSet& parameters) {
  const std::vector<NamedShape> shapes = shapes_of(parameters);
  if (shapes.empty() || shapes.front().members.size() == 1) return std::nullopt;
  auto shape = clump_shape(shapes.front().members);
  if (!shape) return std::nullopt;
  return *std::move(shape);
}

std::string check_shape(const ParameterSet& parameters) {
  const std::vector<NamedShape> shapes = shapes_of(parameters);
  if (shapes.empty()) return {};
  if (shapes.size() > 1) {
    return shapes[0].effect + " and " + shapes[1].effect +
           " are both on, but grains have one shape: leave one at its null";
  }
  const auto shape = clump_shape(shapes.front().members);
  return shape ? std::string() : shapes.front().effect + ": " + shape.error();
}

}  // namespace repose::engine
