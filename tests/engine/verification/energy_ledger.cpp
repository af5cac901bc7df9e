#include "tests/engine/verification/energy_ledger.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

namespace repose::tests {

using namespace engine;

namespace {

constexpr int width = ContactBlock::width;

void set_end(ContactBlock::End& end, int lane, const GrainRow& row) {
  end.x[lane] = row.x;
  end.y[lane] = row.y;
  end.z[lane] = row.z;
  end.radius[lane] = row.radius;
  end.vx[lane] = row.vx;
  end.vy[lane] = row.vy;
  end.vz[lane] = row.vz;
  end.inverse_mass[lane] = row.inverse_mass;
  end.wx[lane] = row.wx;
  end.wy[lane] = row.wy;
  end.wz[lane] = row.wz;
  end.inverse_inertia[lane] = row.inverse_inertia;
}

/// Two spheres that just touch, at rest, for the lanes without a contact.
constexpr GrainRow idle_i{.z = 1.0, .radius = 0.5, .inverse_mass = 1.0};
constexpr GrainRow idle_j{.radius = 0.5, .inverse_mass = 1.0};

/// The nearest point of a wall, moving with it.
GrainRow point_of(const Surface& surface, const Vec3& point) {
  GrainRow row;
  row.x = point.x;
  row.y = point.y;
  row.z = point.z;
  const Vec3 velocity = velocity_at(surface, point);
  row.vx = velocity.x;
  row.vy = velocity.y;
  row.vz = velocity.z;
  row.wx = surface.spin.x;
  row.wy = surface.spin.y;
  row.wz = surface.spin.z;
  return row;
}

double hertz_energy(double modulus, double radius, double overlap) {
  const double force = 4.0 / 3.0 * modulus * std::sqrt(radius * overlap) * overlap;
  return 0.4 * force * overlap;
}

}  // namespace

GrainRow mean_motion(const GrainRow& before, const GrainRow& after) {
  GrainRow mean = before;
  for (double GrainRow::*part :
       {&GrainRow::vx, &GrainRow::vy, &GrainRow::vz, &GrainRow::wx, &GrainRow::wy, &GrainRow::wz}) {
    mean.*part = 0.5 * (before.*part + after.*part);
  }
  return mean;
}

void add_work(const ContactBlock& c,
              int lane,
              const GrainRow& mean_i,
              const GrainRow& mean_j,
              double dt,
              EnergyAccount& account) {
  const Vec3 n{c.normal_x[lane], c.normal_y[lane], c.normal_z[lane]};
  const Vec3 tangent{c.tangent_x[lane], c.tangent_y[lane], c.tangent_z[lane]};
  const Vec3 couple{c.couple_x[lane], c.couple_y[lane], c.couple_z[lane]};
  const Vec3 surface_i = mean_i.velocity() + cross(mean_i.spin(), -c.arm_i[lane] * n);
  const Vec3 surface_j = mean_j.velocity() + cross(mean_j.spin(), c.arm_j[lane] * n);
  const Vec3 over = surface_i - surface_j;
  const double approach = -dot(over, n);
  account.elastic += c.elastic_force[lane] * approach * dt;
  account.dashpot += (c.normal_force[lane] - c.elastic_force[lane]) * approach * dt;
  account.friction -= dot(tangent, over) * dt;
  account.couples -= dot(couple, mean_i.spin() - mean_j.spin()) * dt;
}

EnergyLedger::EnergyLedger(World& world, Alter alter)
    : world_(world),
      alter_(std::move(alter)),
      kinetic_at_start_(world.kinetic_energy()),
      stored_at_start_(stored(rows_by_id())),
      stored_before_(stored_at_start_) {}

std::vector<GrainRow> EnergyLedger::rows_by_id() const {
  const Grains& grains = world_.grains();
  std::vector<GrainRow> rows(grains.size());
  for (std::size_t k = 0; k < rows.size(); ++k) rows[grains.ids[k]] = grains.rows[k];
  return rows;
}

std::vector<EnergyLedger::Contact> EnergyLedger::grain_contacts(
    const std::vector<GrainRow>& rows) const {
  std::vector<Contact> result;
  for (std::uint32_t i = 0; i < rows.size(); ++i) {
    for (std::uint32_t j = i + 1; j < rows.size(); ++j) {
      const Vec3 d = rows[i].centre() - rows[j].centre();
      const double reach = rows[i].radius + rows[j].radius;
      if (dot(d, d) < reach * reach) result.push_back({{i, j}, rows[j]});
    }
  }
  return result;
}

std::vector<EnergyLedger::Contact> EnergyLedger::wall_contacts(const std::vector<GrainRow>& rows,
                                                               MaterialId material) const {
  std::vector<Contact> result;
  for (std::uint32_t i = 0; i < rows.size(); ++i) {
    for (std::uint32_t wall = 0; wall < world_.surfaces().size(); ++wall) {
      const Surface& surface = world_.surfaces()[wall];
      if (surface.material != material) continue;
      const Vec3 d = offset_from(surface, rows[i].centre());
      if (dot(d, d) >= rows[i].radius * rows[i].radius) continue;
      result.push_back({{i, wall}, point_of(surface, rows[i].centre() - d)});
    }
  }
  return result;
}

void EnergyLedger::book(const std::vector<Contact>& contacts,
                        Partner partner,
                        MaterialId material,
                        const std::vector<GrainRow>& before,
                        const std::vector<GrainRow>& after,
                        Histories& histories) {
  const PairLaw& law = world_.model().law(material);
  const double dt = world_.time_step();
  const auto columns = static_cast<std::size_t>(law.history_columns);
  const auto block = std::make_unique<ContactBlock>();
  for (std::size_t first = 0; first < contacts.size(); first += width) {
    alignas(64) std::array<double, width * most_history_columns> history{};
    const auto count = std::min<std::size_t>(width, contacts.size() - first);
    block->count = static_cast<int>(count);
    for (int lane = 0; lane < width; ++lane) {
      const bool idle = lane >= block->count;
      const std::size_t k = idle ? first : first + static_cast<std::size_t>(lane);
      set_end(block->i, lane, idle ? idle_i : before[contacts[k].ends.first]);
      set_end(block->j, lane, idle ? idle_j : contacts[k].partner);
      if (idle) continue;
      auto& kept = histories[contacts[k].ends];
      kept.resize(columns);
      for (std::size_t q = 0; q < columns; ++q)
        history[q * width + static_cast<std::size_t>(lane)] = kept[q];
    }
    apply(law, partner, *block, HistoryBlock(history.data()), dt);
    for (std::size_t lane = 0; lane < count; ++lane) {
      auto& kept = histories[contacts[first + lane].ends];
      for (std::size_t q = 0; q < columns; ++q) kept[q] = history[q * width + lane];
    }
    if (alter_) alter_(*block);
    for (int lane = 0; lane < block->count; ++lane) {
      const Contact& contact = contacts[first + static_cast<std::size_t>(lane)];
      const auto [i, j] = contact.ends;
      const bool wall = partner == Partner::wall;
      const GrainRow mean_j = wall ? contact.partner : mean_motion(before[j], after[j]);
      add_work(*block, lane, mean_motion(before[i], after[i]), mean_j, dt, account_);
      if (!wall) continue;
      const Vec3 force =
          block->normal_force[lane] *
              Vec3{block->normal_x[lane], block->normal_y[lane], block->normal_z[lane]} +
          Vec3{block->tangent_x[lane], block->tangent_y[lane], block->tangent_z[lane]};
      const Vec3 couple{block->couple_x[lane], block->couple_y[lane], block->couple_z[lane]};
      account_.walls += dot(force, contact.partner.velocity()) * dt;
      account_.walls += dot(couple, contact.partner.spin()) * dt;
    }
  }
  // A contact that has opened is forgotten.
  std::erase_if(histories, [&](const auto& entry) {
    const bool of_this_law =
        partner == Partner::grain || world_.surfaces()[entry.first.second].material == material;
    return of_this_law && std::none_of(contacts.begin(), contacts.end(), [&](const Contact& c) {
             return c.ends == entry.first;
           });
  });
}

void EnergyLedger::step() {
  const std::vector<GrainRow> before = rows_by_id();
  stored_before_ = stored(before);
  world_.step();
  const std::vector<GrainRow> after = rows_by_id();
  book(grain_contacts(before), Partner::grain, MaterialId::grain, before, after, pairs_);
  for (const MaterialId material : {MaterialId::grain, MaterialId::wall}) {
    book(wall_contacts(before, material), Partner::wall, material, before, after, walls_);
  }
  for (std::size_t id = 0; id < before.size(); ++id) {
    const Vec3 moved = world_.time_step() * mean_motion(before[id], after[id]).velocity();
    account_.gravity += mass(before[id]) * dot(world_.gravity(), moved);
  }
}

EnergyAccount EnergyLedger::account() const {
  EnergyAccount result = account_;
  result.kinetic = world_.kinetic_energy() - kinetic_at_start_;
  // Velocities lie half a step behind positions: the springs' energy at their time.
  result.stored = 0.5 * (stored_before_ + stored(rows_by_id())) - stored_at_start_;
  return result;
}

double EnergyLedger::stored(const std::vector<GrainRow>& rows) const {
  double energy = 0.0;
  for (const Contact& c : grain_contacts(rows)) {
    const GrainRow& a = rows[c.ends.first];
    const GrainRow& b = c.partner;
    const double overlap = a.radius + b.radius - norm(a.centre() - b.centre());
    energy += hertz_energy(world_.model().law(MaterialId::grain).elastic.modulus,
                           a.radius * b.radius / (a.radius + b.radius),
                           overlap);
  }
  for (const MaterialId material : {MaterialId::grain, MaterialId::wall}) {
    for (const Contact& c : wall_contacts(rows, material)) {
      const GrainRow& a = rows[c.ends.first];
      const double overlap = a.radius - norm(a.centre() - c.partner.centre());
      energy += hertz_energy(world_.model().law(material).elastic.modulus, a.radius, overlap);
    }
  }
  return energy;
}

}  // namespace repose::tests
