#include "engine/clumps.hpp"

#include <algorithm>
#include <cmath>

namespace repose::engine {

namespace {

/// Turns a body about one of its principal axes by an angle, the angular momentum `l` (in the
/// body's axes) with it: in space it stays. tan(angle / 4) is its series to the fifth order, so
/// that the bits owe nothing to a library's sine; the turn is exact, its angle to 2e-4 angle^7 /
/// 4^7.
template <int axis>
void turn(Quaternion& orientation, Vec3& l, double angle) {
  const double x = 0.25 * angle;
  const double u = x * (1.0 + x * x * (1.0 / 3.0 + 2.0 / 15.0 * x * x));
  const double share = 1.0 / (1.0 + u * u);
  const double c = (1.0 - u * u) * share, s = 2.0 * u * share;  // of half the angle
  const double cc = c * c - s * s, ss = 2.0 * c * s;            // of the angle
  if constexpr (axis == 0) {
    orientation = orientation * Quaternion{c, s, 0.0, 0.0};
    l = {l.x, cc * l.y + ss * l.z, cc * l.z - ss * l.y};
  } else if constexpr (axis == 1) {
    orientation = orientation * Quaternion{c, 0.0, s, 0.0};
    l = {cc * l.x - ss * l.z, l.y, cc * l.z + ss * l.x};
  } else {
    orientation = orientation * Quaternion{c, 0.0, 0.0, s};
    l = {cc * l.x + ss * l.y, cc * l.y - ss * l.x, l.z};
  }
}

/// The body's free rotation during dt.
void rotate_freely(ClumpBody& body, double dt) {
  Quaternion& q = body.orientation;
  const Vec3& inertia = body.inertia;
  Vec3 l = turned(conjugate(q), body.angular_momentum);
  turn<0>(q, l, 0.5 * dt * l.x / inertia.x);
  turn<1>(q, l, 0.5 * dt * l.y / inertia.y);
  turn<2>(q, l, dt * l.z / inertia.z);
  turn<1>(q, l, 0.5 * dt * l.y / inertia.y);
  turn<0>(q, l, 0.5 * dt * l.x / inertia.x);
  q = normalised(q);
}

/// Spin in the body's axes.
Vec3 body_spin(const ClumpBody& body) {
  const Vec3 l = turned(conjugate(body.orientation), body.angular_momentum);
  return {l.x / body.inertia.x, l.y / body.inertia.y, l.z / body.inertia.z};
}

/// The image of x that is nearest to `to`.
double image_near(double x, double to, double period) {
  return period > 0.0 ? x + period * std::floor((to - x) / period + 0.5) : x;
}

}  // namespace

Vec3 spin(const ClumpBody& body) { return turned(body.orientation, body_spin(body)); }

double kinetic_energy(const ClumpBody& body) {
  const Vec3 w = body_spin(body);
  const Vec3 l = turned(conjugate(body.orientation), body.angular_momentum);
  return 0.5 * body.mass * dot(body.velocity, body.velocity) + 0.5 * dot(l, w);
}

std::uint32_t Clumps::index_of(const ClumpShape& shape) {
  const auto known = std::ranges::find(shapes_, shape);
  const auto index = static_cast<std::uint32_t>(known - shapes_.begin());
  if (known == shapes_.end()) shapes_.push_back(shape);
  return index;
}

GrainRow Clumps::member_row(const ClumpBody& body,
                            const ClumpMember& member,
                            const Vec3& arm,
                            const Vec3& spin) const {
  const Vec3 centre = body.centre + arm;
  const Vec3 velocity = body.velocity + cross(spin, arm);
  const double mean_inertia = (body.inertia.x + body.inertia.y + body.inertia.z) / 3.0;
  return {centre.x,
          centre.y,
          centre.z,
          body.scale * member.radius,
          velocity.x,
          velocity.y,
          velocity.z,
          1.0 / body.mass,
          spin.x,
          spin.y,
          spin.z,
          1.0 / mean_inertia};
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
  body.inertia = (placement.density * s * s * s * s * s) * shape.inertia;
  body.centre = placement.centre;
  body.velocity = placement.velocity;
  body.orientation = normalised(placement.orientation * shape.axes);
  const Vec3 w = turned(conjugate(body.orientation), placement.spin);
  body.angular_momentum =
      turned(body.orientation, {body.inertia.x * w.x, body.inertia.y * w.y, body.inertia.z * w.z});
  std::vector<GrainRow> members;
  members.reserve(shape.members.size());
  for (const ClumpMember& member : shape.members) {
    const Vec3 arm = turned(body.orientation, s * member.centre);
    members.push_back(member_row(body, member, arm, placement.spin));
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

void Clumps::advance(double dt,
                     const Vec3& gravity,
                     const Vec3& period,
                     std::vector<GrainRow>& rows) {
  for (ClumpBody& body : bodies_) {
    body.velocity += (dt / body.mass) * body.force + dt * gravity;
    body.centre += dt * body.velocity;
    body.angular_momentum += dt * body.torque;
    rotate_freely(body, dt);
    const Vec3 w = spin(body);
    std::size_t slot = body.first_slot;
    for (const ClumpMember& member : shape(body).members) {
      const Vec3 arm = turned(body.orientation, body.scale * member.centre);
      GrainRow row = member_row(body, member, arm, w);
      GrainRow& old = rows[rows_[slot]];
      row.x = image_near(row.x, old.x, period.x);
      row.y = image_near(row.y, old.y, period.y);
      old = row;
      arms_[slot] = arm;
      ++slot;
    }
  }
}

GrainRow Clumps::envelope(const ClumpBody& body) const {
  return member_row(body, {.centre = {}, .radius = shape(body).bounding_radius}, {}, spin(body));
}

}  // namespace repose::engine
