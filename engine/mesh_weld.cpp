#include "engine/mesh_weld.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <tuple>
#include <unordered_map>

namespace repose::engine {

namespace {

/// Points that are the same but for rounding, as one; numbered by first appearance.
class Welder {
 public:
  explicit Welder(double distance) : distance_(distance) {}

  std::uint32_t number_of(const Vec3& point) {
    const Cell home = cell_of(point);
    for (std::int64_t dx = -1; dx <= 1; ++dx) {
      for (std::int64_t dy = -1; dy <= 1; ++dy) {
        for (std::int64_t dz = -1; dz <= 1; ++dz) {
          const auto found = cells_.find({home[0] + dx, home[1] + dy, home[2] + dz});
          if (found == cells_.end()) continue;
          for (const std::uint32_t known : found->second) {
            if (norm(points_[known] - point) <= distance_) return known;
          }
        }
      }
    }
    const auto fresh = static_cast<std::uint32_t>(points_.size());
    points_.push_back(point);
    cells_[home].push_back(fresh);
    return fresh;
  }
  std::vector<Vec3> take_points() { return std::move(points_); }

 private:
  using Cell = std::array<std::int64_t, 3>;
  struct Hash {
    std::size_t operator()(const Cell& cell) const {
      std::uint64_t hash = 0;
      for (const std::int64_t each : cell) {
        hash = (hash ^ static_cast<std::uint64_t>(each)) * 0x9e3779b97f4a7c15U;  // golden ratio
        hash ^= hash >> 32U;
      }
      return hash;
    }
  };
  [[nodiscard]] Cell cell_of(const Vec3& p) const {
    const auto place = [this](double x) {
      return static_cast<std::int64_t>(std::floor(x / distance_));
    };
    return {place(p.x), place(p.y), place(p.z)};
  }

  double distance_;
  std::vector<Vec3> points_;
  std::unordered_map<Cell, std::vector<std::uint32_t>, Hash> cells_;
};

/// Least height of a triangle, m.
double height(const Triangle& t) {
  const Vec3 a = t[1] - t[0], b = t[2] - t[1], c = t[0] - t[2];
  const double longest = std::max({norm(a), norm(b), norm(c)});
  return longest > 0.0 ? norm(cross(a, b)) / longest : 0.0;
}

void find_edges(WeldedFacets& w) {
  w.edges.reserve(3 * w.facets.size());
  for (std::uint32_t f = 0; f < w.facets.size(); ++f) {
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t a = w.facets[f][corner], b = w.facets[f][(corner + 1) % 3];
      w.edges.push_back({std::min(a, b), std::max(a, b), f, corner});
    }
  }
  std::ranges::sort(w.edges, [](const FacetEdge& a, const FacetEdge& b) {
    return std::tie(a.low, a.high, a.facet) < std::tie(b.low, b.high, b.facet);
  });
}

}  // namespace

Triangle WeldedFacets::corners(std::uint32_t facet) const {
  const auto& [a, b, c] = facets[facet];
  return {points[a], points[b], points[c]};
}

void WeldedFacets::for_each_edge(const std::function<void(std::span<const FacetEdge>)>& see) const {
  for (auto first = edges.begin(); first != edges.end();) {
    const auto last = std::find_if(first, edges.end(), [&](const FacetEdge& e) {
      return e.low != first->low || e.high != first->high;
    });
    see({first, last});
    first = last;
  }
}

Result<WeldedFacets, MeshError> weld(std::span<const Triangle> facets,
                                     double scale,
                                     double distance) {
  WeldedFacets result;
  Welder welder(distance);
  std::set<std::array<std::uint32_t, 3>> known;
  for (std::size_t k = 0; k < facets.size(); ++k) {
    std::array<std::uint32_t, 3> numbers{};
    for (std::size_t c = 0; c < 3; ++c) numbers[c] = welder.number_of(scale * facets[k][c]);
    std::array<std::uint32_t, 3> sorted = numbers;
    std::ranges::sort(sorted);
    if (!known.insert(sorted).second) continue;
    result.facets.push_back(numbers);
    result.numbers.push_back(k + 1);
  }
  result.points = welder.take_points();
  for (std::uint32_t f = 0; f < result.facets.size(); ++f) {
    if (height(result.corners(f)) > distance) continue;
    const std::size_t number = result.numbers[f];
    return Unexpected{MeshError{
        MeshFault::no_area,
        number,
        "facet " + std::to_string(number) + ": its corners lie on a line, it has no area"}};
  }
  find_edges(result);
  return result;
}

}  // namespace repose::engine
