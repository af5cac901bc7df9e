#include "engine/clumps.hpp"

#include <algorithm>
#include <cmath>

namespace repose::engine {

namespace {

/// Turns a body about one of its principal axes by an angle, the angular momentum `l` (in the
/// body's axes) with it: in space it stays. Sine and cosine of half the angle h are their series to
/// h^7 and h^8, so that the bits owe nothing to a library; at h = 0.1 no digit is lost.
template <int axis>
void turn(Quaternion& orientation, Vec3& l, double angle) {
  const double h = 0.5 * angle, hh = h * h;
  const double s = h * (1.0 - hh / 6.0 * (1.0 - hh / 20.0 * (1.0 - hh / 42.0)));
  const double c = 1.0 - hh / 2.0 * (1.0 - hh / 12.0 * (1.0 - hh / 30.0 * (1.0 - hh / 56.0)));
  const double cc = c * c - s * s, ss = 2.0 * c * s;  // of the angle
  const Quaternion q = orientation;
  if constexpr (axis == 0) {
    orientation = {c * q.w - s * q.x, c * q.x + s * q.w, c * q.y + s * q.z, c * q.z - s * q.y};
    l = {l.x, cc * l.y + ss * l.z, cc * l.z - ss * l.y};
  } else if constexpr (axis == 1) {
    orientation = {c * q.w - s * q.y, c * q.x - s * q.z, c * q.y + s * q.w, c * q.z + s * q.x};
    l = {cc * l.x - ss * l.z, l.y, cc * l.z + ss * l.x};
  } else {
    orientation = {c * q.w - s * q.z, c * q.x + s * q.y, c * q.y - s * q.x, c * q.z + s * q.w};
    l = {cc * l.x + ss * l.y, cc * l.y - ss * l.x, l.z};
  }
}

constexpr Vec3 by_axis(const Vec3& a, const Vec3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

/// The body's free rotation during dt; returns its spin then, in space.
Vec3 rotate_freely(ClumpBody& body, double dt) {
  Quaternion& q = body.orientation;
  const Vec3& mobility = body.inverse_inertia;
  Vec3 l = turned(conjugate(q), body.angular_momentum);
  turn<0>(q, l, 0.5 * dt * mobility.x * l.x);
  turn<1>(q, l, 0.5 * dt * mobility.y * l.y);
  turn<2>(q, l, dt * mobility.z * l.z);
  turn<1>(q, l, 0.5 * dt * mobility.y * l.y);
  turn<0>(q, l, 0.5 * dt * mobility.x * l.x);
  q = normalised(q);
  return turned(q, by_axis(mobility, l));
}

/// The image of x that is nearest to `to`.
double image_near(double x, double to, double period) {
  return period > 0.0 ? x + period * std::floor((to - x) / period + 0.5) : x;
}

/// Gives a row the place and the motion of a point of a body.
void place(GrainRow& row, const ClumpBody& body, const Vec3& arm, const Vec3& spin) {
  const Vec3 centre = body.centre + arm;
  const Vec3 velocity = body.velocity + cross(spin, arm);
  row.x = centre.x, row.y = centre.y, row.z = centre.z;
  row.vx = velocity.x, row.vy = velocity.y, row.vz = velocity.z;
  row.wx = spin.x, row.wy = spin.y, row.wz = spin.z;
}

/// A row of a body at its centre.
GrainRow row_of(const ClumpBody& body, double radius, const Vec3& spin) {
  const Vec3& mobility = body.inverse_inertia;
  GrainRow row;
  row.radius = radius;
  row.inverse_mass = 1.0 / body.mass;
  row.inverse_inertia = (mobility.x + mobility.y + mobility.z) / 3.0;
  place(row, body, {}, spin);
  return row;
}

}  // namespace

Vec3 spin(const ClumpBody& body) {
  const Quaternion& q = body.orientation;
  return turned(q, by_axis(body.inverse_inertia, turned(conjugate(q), body.angular_momentum)));
}

double kinetic_energy(const ClumpBody& body) {
  return 0.5 * body.mass * dot(body.velocity, body.velocity) +
         0.5 * dot(body.angular_momentum, spin(body));
}

std::uint32_t Clumps::index_of(const ClumpShape& shape) {
  const auto known = std::ranges::find(shapes_, shape);
  const auto index = static_cast<std::uint32_t>(known - shapes_.begin());
  if (known == shapes_.end()) shapes_.push_back(shape);
  return index;
}

std::vector<GrainRow> Clumps::add(const ClumpShape& shape,
                                  const ClumpPlacement& placement,
                                  std::uint32_t first_id) {
  const double s = placement.scale;
  ClumpBody body;
  body.shape = index_of(shape);
  body.first_id = first_id;
  body.first_slot = static_cast<std::uint32_t>(rows_.size());
  body.scale = s;
  body.mass = placement.density * s * s * s * shape.volume;
  const Vec3 inertia = (placement.density * s * s * s * s * s) * shape.inertia;
  body.inverse_inertia = {1.0 / inertia.x, 1.0 / inertia.y, 1.0 / inertia.z};
  body.centre = placement.centre;
  body.velocity = placement.velocity;
  body.orientation = normalised(placement.orientation * shape.axes);
  const Vec3 w = turned(conjugate(body.orientation), placement.spin);
  body.angular_momentum = turned(body.orientation, by_axis(inertia, w));
  std::vector<GrainRow> members;
  members.reserve(shape.members.size());
  for (const ClumpMember& member : shape.members) {
    const Vec3 arm = turned(body.orientation, s * member.centre);
    members.push_back(row_of(body, s * member.radius, placement.spin));
    place(members.back(), body, arm, placement.spin);
    arms_.push_back(arm);
    rows_.push_back(no_body);
  }
  body_of_.resize(first_id, no_body);
  body_of_.resize(first_id + members.size(), static_cast<std::uint32_t>(bodies_.size()));
  bodies_.push_back(body);
  return members;
}

void Clumps::remove(const std::vector<std::uint8_t>& leaving) {
  std::size_t kept = 0;
  std::uint32_t slot = 0;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    ClumpBody body = bodies_[b];
    const auto count = static_cast<std::uint32_t>(shape(body).members.size());
    const bool stays = leaving[b] == 0;
    std::fill_n(body_of_.begin() + body.first_id,
                count,
                stays ? static_cast<std::uint32_t>(kept) : no_body);
    if (!stays) continue;
    std::copy_n(arms_.begin() + body.first_slot, count, arms_.begin() + slot);
    body.first_slot = slot;
    slot += count;
    bodies_[kept++] = body;
  }
  bodies_.resize(kept);
  arms_.resize(slot);
  rows_.assign(slot, no_body);
}

void Clumps::locate(const Grains& grains, const Vec3& period) {
  for (ClumpBody& body : bodies_) {
    body.centre.x = image_near(body.centre.x, 0.5 * period.x, period.x);
    body.centre.y = image_near(body.centre.y, 0.5 * period.y, period.y);
  }
  for (std::size_t k = 0; k < grains.size(); ++k) {
    const std::uint32_t owner = body_of(grains.ids[k]);
    if (owner == no_body) continue;
    const ClumpBody& body = bodies_[owner];
    rows_[body.first_slot + grains.ids[k] - body.first_id] = static_cast<std::uint32_t>(k);
  }
}

void Clumps::collect(const Grains& grains) {
  for (ClumpBody& body : bodies_) {
    body.force = {};
    body.torque = {};
    const std::size_t end = body.first_slot + shape(body).members.size();
    for (std::size_t slot = body.first_slot; slot < end; ++slot) {
      const GrainLoad& load = grains.loads[rows_[slot]];
      const Vec3 force{load.fx, load.fy, load.fz};
      body.force += force;
      body.torque += cross(arms_[slot], force) + Vec3{load.tx, load.ty, load.tz};
    }
  }
}

void Clumps::push(const std::function<Vec3(double, const Vec3&)>& force) {
  for (ClumpBody& body : bodies_) {
    body.force += force(body.scale * equivalent_diameter(shape(body)), body.velocity);
  }
}

void Clumps::advance(double dt,
                     const Vec3& gravity,
                     const Vec3& period,
                     std::vector<GrainRow>& rows) {
  for (ClumpBody& body : bodies_) {
    body.velocity += (dt / body.mass) * body.force + dt * gravity;
    body.centre += dt * body.velocity;
    body.angular_momentum += dt * body.torque;
    const Vec3 w = rotate_freely(body, dt);
    std::size_t slot = body.first_slot;
    for (const ClumpMember& member : shape(body).members) {
      const Vec3 arm = turned(body.orientation, body.scale * member.centre);
      GrainRow& row = rows[rows_[slot]];
      const double x = row.x, y = row.y;
      place(row, body, arm, w);
      row.x = image_near(row.x, x, period.x);
      row.y = image_near(row.y, y, period.y);
      arms_[slot] = arm;
      ++slot;
    }
  }
}

GrainRow Clumps::envelope(const ClumpBody& body) const {
  return row_of(body, body.scale * shape(body).bounding_radius, spin(body));
}

}  // namespace repose::engine
