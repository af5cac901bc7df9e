/// EnergyLedger: where the energy of a run comes from and goes to, kept beside a World.
///
/// It finds the contacts of each step anew, carries their history itself, and takes the work of
/// every part of a contact's force at the relative velocity there, from its own kinematics. A
/// leapfrog's kick changes the kinetic energy by force times the mean of the velocities before and
/// after, exactly; so what the grains did in the World and what the parts add up to agree to
/// round-off unless force, arm, torque or history differ between the two.
///
/// For scenes of few grains without period, and laws of pairs; it compares every grain with every
/// other.
#pragma once

#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "engine/world.hpp"

namespace repose::tests {

/// Energy since the start, J.
struct EnergyAccount {
  double gravity = 0.0;   ///< in
  double walls = 0.0;     ///< in, from walls that move
  double kinetic = 0.0;   ///< gained
  double elastic = 0.0;   ///< work against Hertz's springs
  double stored = 0.0;    ///< what these hold more than at the start, (2/5) F d each
  double dashpot = 0.0;   ///< out, along the normal
  double friction = 0.0;  ///< out or held in tangential springs
  double couples = 0.0;   ///< out or held in rolling springs

  [[nodiscard]] double in() const { return gravity + walls; }
  [[nodiscard]] double out() const { return dashpot + friction + couples; }
  /// What is not accounted for: with the springs' work, to round-off; with their energy, to the
  /// order of the time step squared.
  [[nodiscard]] double missing_work() const { return in() - kinetic - elastic - out(); }
  [[nodiscard]] double missing() const { return in() - kinetic - stored - out(); }
};

/// Adds the work of one contact over a step. The ends move at their mean velocities of the step.
void add_work(const engine::ContactBlock& block,
              int lane,
              const engine::GrainRow& mean_i,
              const engine::GrainRow& mean_j,
              double dt,
              EnergyAccount& account);

/// Means of the velocities and spins of two rows of one grain.
engine::GrainRow mean_motion(const engine::GrainRow& before, const engine::GrainRow& after);

class EnergyLedger {
 public:
  /// Alters the forces that the ledger takes the World to have.
  using Alter = std::function<void(engine::ContactBlock&)>;

  explicit EnergyLedger(engine::World& world, Alter alter = {});

  /// Steps the World and books what happened.
  void step();
  [[nodiscard]] EnergyAccount account() const;

 private:
  using Ends = std::pair<std::uint32_t, std::uint32_t>;  ///< ids; of j, or of the wall

  struct Contact {
    Ends ends;
    engine::GrainRow partner;  ///< the other grain, or the point of the wall
  };
  using Histories = std::map<Ends, std::vector<double>>;

  [[nodiscard]] std::vector<engine::GrainRow> rows_by_id() const;
  [[nodiscard]] std::vector<Contact> grain_contacts(
      const std::vector<engine::GrainRow>& rows) const;
  [[nodiscard]] std::vector<Contact> wall_contacts(const std::vector<engine::GrainRow>& rows,
                                                   engine::MaterialId material) const;
  void book(const std::vector<Contact>& contacts,
            engine::Partner partner,
            engine::MaterialId material,
            const std::vector<engine::GrainRow>& before,
            const std::vector<engine::GrainRow>& after,
            Histories& histories);
  [[nodiscard]] double stored(const std::vector<engine::GrainRow>& rows) const;

  engine::World& world_;
  Alter alter_;
  EnergyAccount account_;
  Histories pairs_, walls_;
  double kinetic_at_start_, stored_at_start_;
  double stored_before_;
};

}  // namespace repose::tests
