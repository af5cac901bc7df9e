#include "engine/clump_shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/unit.hpp"

namespace repose::engine {

namespace {

/// Columns across the region of overlaps, each way.
constexpr int columns = 512;
/// Members this share of their radii apart still touch.
constexpr double rounding = 1e-9;
/// Products of inertia this small beside the moments are rounding.
constexpr double negligible = 1e-13;

using Matrix = std::array<std::array<double, 3>, 3>;

/// Integrals of 1, of the coordinates and of their products over a body.
struct Moments {
  double volume = 0.0;  // m3
  Vec3 first;           // m4
  Matrix second{};      // m5

  void add(double share, const Vec3& at) {
    volume += share;
    first += share * at;
    const std::array x{at.x, at.y, at.z};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) second[i][j] += share * x[i] * x[j];
    }
  }
};

struct Interval {
  double low, high;
};

/// A column along z.
struct Column {
  double x, y;
  double area;
};

/// A stretch of a column, counted `weight` times: its own second moment is length cubed over 12.
void add_stretch(Moments& m, const Column& column, const Interval& z, double weight) {
  const double length = z.high - z.low;
  m.add(weight * length, {column.x, column.y, 0.5 * (z.low + z.high)});
  m.second[2][2] += weight * length * length * length / 12.0;
}

void add_sphere(Moments& m, const ClumpMember& member) {
  const double r = member.radius;
  const double volume = 4.0 / 3.0 * unit::pi * r * r * r;
  m.add(volume, member.centre);
  for (std::size_t i = 0; i < 3; ++i) m.second[i][i] += 0.2 * volume * r * r;
}

/// Takes off what a column's spheres count more than once: their chords less the union of these.
/// `chords` is room to work in.
void take_off_excess(Moments& m,
                     std::span<const ClumpMember> members,
                     const Column& column,
                     std::vector<Interval>& chords) {
  chords.clear();
  for (const ClumpMember& a : members) {
    const double dx = column.x - a.centre.x, dy = column.y - a.centre.y;
    const double squared = a.radius * a.radius - dx * dx - dy * dy;
    if (squared <= 0.0) continue;
    const double half = std::sqrt(squared);
    chords.push_back({a.centre.z - half, a.centre.z + half});
  }
  if (chords.size() < 2) return;
  std::ranges::sort(chords, {}, &Interval::low);
  double covered = chords[0].high;
  for (std::size_t k = 1; k < chords.size(); ++k) {
    const Interval twice{chords[k].low, std::min(covered, chords[k].high)};
    if (twice.high > twice.low) add_stretch(m, column, twice, -column.area);
    covered = std::max(covered, chords[k].high);
  }
}

/// Where overlaps can be: the box round what the boxes of two members share.
struct Box {
  double low_x = 1e300, high_x = -1e300, low_y = 1e300, high_y = -1e300;
};

Box box_of_overlaps(std::span<const ClumpMember> members) {
  Box box;
  for (std::size_t i = 0; i < members.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const ClumpMember& a = members[i];
      const ClumpMember& b = members[j];
      if (norm(a.centre - b.centre) >= a.radius + b.radius) continue;
      const auto low = [&](double p, double q) { return std::max(p - a.radius, q - b.radius); };
      const auto high = [&](double p, double q) { return std::min(p + a.radius, q + b.radius); };
      box.low_x = std::min(box.low_x, low(a.centre.x, b.centre.x));
      box.high_x = std::max(box.high_x, high(a.centre.x, b.centre.x));
      box.low_y = std::min(box.low_y, low(a.centre.y, b.centre.y));
      box.high_y = std::max(box.high_y, high(a.centre.y, b.centre.y));
    }
  }
  return box;
}

Moments moments_of_union(std::span<const ClumpMember> members) {
  Moments m;
  for (const ClumpMember& member : members) add_sphere(m, member);
  const Box box = box_of_overlaps(members);
  if (box.low_x >= box.high_x) return m;
  std::vector<Interval> chords;
  const double step_x = (box.high_x - box.low_x) / columns;
  const double step_y = (box.high_y - box.low_y) / columns;
  for (int i = 0; i < columns; ++i) {
    for (int j = 0; j < columns; ++j) {
      const Column column{
          box.low_x + (i + 0.5) * step_x, box.low_y + (j + 0.5) * step_y, step_x * step_y};
      take_off_excess(m, members, column, chords);
    }
  }
  return m;
}

/// Second moments about the centre of mass.
Matrix central(const Moments& m, const Vec3& centre) {
  const std::array c{centre.x, centre.y, centre.z};
  Matrix result = m.second;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) result[i][j] -= m.volume * c[i] * c[j];
  }
  return result;
}

/// One Jacobi rotation in the plane (p, q): makes a[p][q] zero and turns the axes with it
/// (Golub & Van Loan 2013, Matrix Computations, section 8.5).
void rotate_plane(Matrix& a, Quaternion& axes, std::size_t p) {
  const std::size_t q = (p + 1) % 3, r = (p + 2) % 3;
  const double tau = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
  const double t = (tau < 0.0 ? -1.0 : 1.0) / (std::abs(tau) + std::sqrt(1.0 + tau * tau));
  const double c = 1.0 / std::sqrt(1.0 + t * t), s = t * c;
  const double app = a[p][p], aqq = a[q][q], apq = a[p][q], apr = a[p][r], aqr = a[q][r];
  a[p][p] = app - t * apq;
  a[q][q] = aqq + t * apq;
  a[p][q] = a[q][p] = 0.0;
  a[p][r] = a[r][p] = c * apr - s * aqr;
  a[q][r] = a[r][q] = s * apr + c * aqr;
  // Axis p moves towards -q: a turn about r by minus the angle.
  const double half_c = std::sqrt(0.5 * (1.0 + c)), half_s = -0.5 * s / half_c;
  const std::array<Quaternion, 3> turn{Quaternion{half_c, half_s, 0.0, 0.0},
                                       Quaternion{half_c, 0.0, half_s, 0.0},
                                       Quaternion{half_c, 0.0, 0.0, half_s}};
  axes = normalised(axes * turn[r]);
}

/// Brings a matrix to its diagonal; returns what turns the new axes into the old.
Quaternion principal_axes(Matrix& a) {
  constexpr int most_sweeps = 30;
  Quaternion axes;
  const double small = negligible * (a[0][0] + a[1][1] + a[2][2]);
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    bool done = true;
    for (std::size_t p = 0; p < 3; ++p) {
      if (std::abs(a[p][(p + 1) % 3]) <= small) continue;
      rotate_plane(a, axes, p);
      done = false;
    }
    if (done) break;
  }
  return axes;
}

std::string member_name(std::size_t index) { return "member " + std::to_string(index + 1); }

bool usable(const ClumpMember& m) {
  return std::isfinite(m.radius) && m.radius > 0.0 && std::isfinite(norm(m.centre));
}

/// A member that no chain of touching members joins to the first; members.size() if none.
std::size_t unconnected(std::span<const ClumpMember> members) {
  std::vector<std::size_t> reached{0};
  std::vector<bool> known(members.size(), false);
  known[0] = true;
  for (std::size_t next = 0; next < reached.size(); ++next) {
    const ClumpMember& a = members[reached[next]];
    for (std::size_t k = 0; k < members.size(); ++k) {
      const ClumpMember& b = members[k];
      const double touch = (a.radius + b.radius) * (1.0 + rounding);
      if (known[k] || norm(a.centre - b.centre) > touch) continue;
      known[k] = true;
      reached.push_back(k);
    }
  }
  const auto missing = std::ranges::find(known, false);
  return static_cast<std::size_t>(missing - known.begin());
}

/// What is wrong with the members; empty if nothing.
std::string problem_of(std::span<const ClumpMember> members) {
  if (members.empty()) return "a clump needs a member";
  if (members.size() > most_clump_members) {
    return "a clump of " + std::to_string(members.size()) + " members: at most " +
           std::to_string(most_clump_members);
  }
  for (std::size_t k = 0; k < members.size(); ++k) {
    if (!usable(members[k])) return member_name(k) + " needs a finite centre and a radius above 0";
  }
  for (std::size_t k = 0; k < members.size(); ++k) {
    for (std::size_t other = 0; other < members.size(); ++other) {
      const ClumpMember& a = members[k];
      const ClumpMember& b = members[other];
      const bool twin = a == b && k < other;  // of two equal members the later one is named
      if (k == other || twin || norm(a.centre - b.centre) + a.radius > b.radius) continue;
      return member_name(k) + " lies wholly inside " + member_name(other);
    }
  }
  const std::size_t apart = unconnected(members);
  if (apart < members.size()) {
    return member_name(apart) + " does not touch the part of the clump with " + member_name(0);
  }
  return {};
}

}  // namespace

Result<ClumpShape, std::string> clump_shape(std::span<const ClumpMember> members) {
  if (std::string problem = problem_of(members); !problem.empty()) return Unexpected{problem};
  const Moments m = moments_of_union(members);
  const Vec3 centre = (1.0 / m.volume) * m.first;
  Matrix second = central(m, centre);
  ClumpShape shape;
  shape.axes = principal_axes(second);
  shape.volume = m.volume;
  shape.inertia = {
      second[1][1] + second[2][2], second[2][2] + second[0][0], second[0][0] + second[1][1]};
  shape.members.reserve(members.size());
  for (const ClumpMember& member : members) {
    const Vec3 arm = turned(conjugate(shape.axes), member.centre - centre);
    shape.members.push_back({arm, member.radius});
    shape.bounding_radius = std::max(shape.bounding_radius, norm(arm) + member.radius);
  }
  return shape;
}

double equivalent_diameter(const ClumpShape& shape) {
  return std::cbrt(6.0 / unit::pi * shape.volume);
}

}  // namespace repose::engine
