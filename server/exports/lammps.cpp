#include <cmath>

#include "engine/unit.hpp"
#include "server/exports/export.hpp"

namespace repose::server {

namespace {

constexpr const char* deck = R"(
units si
atom_style sphere
newton off
comm_modify vel yes
# --- domain: yours
boundary f f f
region domain block -0.05 0.05 -0.05 0.05 -0.01 0.3 units box
create_box 1 domain
# --- contact law
pair_style granular
pair_coeff * * hertz/material @E@ @e@ @nu@ damping tsuji tangential mindlin NULL @xt@ @mu@@rolling@
# Laws of walls: ${wall} is bare, ${rough} is covered with grains.
variable wall string "@wall@"
variable rough string "@rough@"
neighbor @skin@ bin
neigh_modify delay 0 every 1 check yes
timestep @dt@
fix motion all nve/sphere
fix weight all gravity 9.81 vector 0 0 -1
thermo_style custom step atoms ke
thermo_modify lost ignore norm no
# --- scene: an example. Grains fall on a floor and come to rest.
fix floor all wall/gran ${wall} zplane 0.0 NULL
fix sides all wall/gran ${wall} zcylinder 0.045
region above cylinder z 0.0 0.0 0.04 0.02 0.28 units box
fix pour all pour 500 1 49979687 region above diam one @diameter@ dens @rho@ @rho@ vol 0.2 200 vel 0.0 0.0 0.0 0.0 -0.5
thermo 2000
run @steps@
)";

const std::vector<std::string> remarks{
    "How this says it in LAMMPS (29 Sep 2021, as Debian 12 has it; pair_style granular):",
    "  - damping tsuji turns its first number into a damping by a polynomial of another mass; the",
    "    number given is the one whose damping is sqrt(5) |ln e| / sqrt(ln^2 e + pi^2), which",
    "    rebounds with e.",
    "  - rolling sds has the reduced radius in its cap, as repose has; its spring of constant",
    "    stiffness (that of sliding under the weight of six grains) stands for repose's couple.",
    "  - walls: this version takes E / (2 (1 - nu)) for the reduced modulus of a wall and brackets",
    "    its tangential stiffness wrongly, so both are given such that they come out right.",
};

/// Tsuji's polynomial as LAMMPS has it: the damping of a restitution.
double polynomial(double e) {
  return 1.2728 +
         e * (-4.2783 + e * (11.087 + e * (-22.348 + e * (27.467 + e * (-18.022 + e * 4.8218)))));
}

/// What to give LAMMPS for a restitution of e, by halving: the polynomial falls from 0 to 1.
double tsuji_input(double e) {
  const double logarithm = std::log(e);
  const double pi = engine::unit::pi;
  const double damping = std::sqrt(5.0) * -logarithm / std::sqrt(logarithm * logarithm + pi * pi);
  double low = 0.0;
  double high = 1.0;
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (low + high);
    (polynomial(middle) > damping ? low : high) = middle;
  }
  return high;
}

/// Tangential over normal dashpot, as engine/effects/restitution.hpp has it.
double tangential_ratio(const PairLaw& law) { return std::sqrt(4.0 * law.shear / law.modulus); }

std::string rolling(const DemModel& model, const PairLaw& law, double reduced_radius) {
  if (law.rolling == 0.0) return "";
  const double pi = engine::unit::pi;
  const double weight = 9.81 * model.density * pi / 6.0 * std::pow(model.diameter, 3);
  const double patch = std::cbrt(0.75 * 6.0 * weight * reduced_radius / law.modulus);
  return " rolling sds " + exact(8.0 * law.shear * patch) + " 0.0 " + exact(law.rolling);
}

std::string wall(const DemModel& model, const PairLaw& law) {
  const double nu = model.grain.poisson;
  return "granular hertz/material " + exact(2.0 * (1.0 - nu) * law.modulus) + " " +
         exact(tsuji_input(law.restitution)) + " " + exact(nu) +
         " damping tsuji tangential mindlin " + exact(8.0 * law.shear) + " " +
         exact(tangential_ratio(law)) + " " + exact(law.friction) +
         rolling(model, law, 0.5 * model.diameter);
}

}  // namespace

std::string print_lammps(const DemModel& model, const std::vector<std::string>& title) {
  const PairLaw& g = model.between_grains;
  std::vector<std::string> unsaid = model.unsaid;
  if (g.cohesion != 0.0 || model.at_wall.cohesion != 0.0) {
    unsaid.push_back("area_cohesion.energy_density: LAMMPS has JKR and DMT adhesion only");
  }
  std::vector<std::string> head = title;
  head.insert(head.end(), remarks.begin(), remarks.end());
  return comment_head(head, unsaid, "LAMMPS") +
         filled(deck,
                {{"@E@", exact(model.grain.young)},
                 {"@e@", exact(tsuji_input(g.restitution))},
                 {"@nu@", exact(model.grain.poisson)},
                 {"@xt@", exact(tangential_ratio(g))},
                 {"@mu@", exact(g.friction)},
                 {"@rolling@", rolling(model, g, 0.25 * model.diameter)},
                 {"@wall@", wall(model, model.at_wall)},
                 {"@rough@", wall(model, g)},
                 {"@skin@", exact(0.25 * model.diameter)},
                 {"@dt@", exact(model.time_step)},
                 {"@diameter@", exact(model.diameter)},
                 {"@rho@", exact(model.density)},
                 {"@steps@", std::to_string(static_cast<long>(0.6 / model.time_step))}});
}

}  // namespace repose::server
