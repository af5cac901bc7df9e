#include "server/exports/export.hpp"

namespace repose::server {

namespace {

/// LIGGGHTS's `hertz` with its damping is this engine's law but for the cut of tension at the end
/// of a contact; its `cdt` has the reduced radius in the couple, as ours; `epsd2` is the rolling
/// spring with k_r = k_t R*^2, without a dashpot; `sjkr` is area cohesion.
constexpr const char* deck = R"(
atom_style granular
atom_modify map array
newton off
communicate single vel yes
units si
soft_particles yes
hard_particles yes
# --- domain: yours. Type 1 is the grain, type 2 the wall.
boundary f f f
region domain block -0.05 0.05 -0.05 0.05 -0.01 0.3 units box
create_box 2 domain
# --- contact law
fix young all property/global youngsModulus peratomtype @E1@ @E2@
fix poisson all property/global poissonsRatio peratomtype @nu1@ @nu2@
fix restitution all property/global coefficientRestitution peratomtypepair 2 @e@
fix friction all property/global coefficientFriction peratomtypepair 2 @mu@
fix rolling all property/global coefficientRollingFriction peratomtypepair 2 @roll@
@cohesion@pair_style gran @model@
pair_coeff * *
neighbor @skin@ bin
neigh_modify delay 0 every 1 check yes
timestep @dt@
fix motion all nve/sphere
fix weight all gravity 9.81 vector 0 0 -1
thermo_style custom step atoms ke
thermo_modify lost ignore norm no
# --- scene: an example. Grains fall on a floor and come to rest. Meshes are walls of type 2:
#   fix NAME all mesh/surface file NAME.stl type 2
#   fix walls all wall/gran @model@ mesh n_meshes 1 meshes NAME
fix floor all wall/gran @model@ primitive type 2 zplane 0.0
fix sides all wall/gran @model@ primitive type 2 zcylinder 0.045 0.0 0.0
fix one all particletemplate/sphere 15485863 atom_type 1 density constant @rho@ radius constant @radius@
fix all_of_one all particledistribution/discrete 32452843 1 one 1.0
region above cylinder z 0.0 0.0 0.04 0.01 0.28 units box
fix pour all insert/pack seed 49979687 distributiontemplate all_of_one insert_every once overlapcheck yes all_in yes vel constant 0.0 0.0 -0.5 region above volumefraction_region 0.2
thermo 2000
run @steps@
)";

/// The symmetric 2 x 2 table of a pair property; walls do not touch walls.
std::string table(double grains, double wall) {
  return exact(grains) + " " + exact(wall) + " " + exact(wall) + " " + exact(wall);
}

}  // namespace

std::string print_liggghts(const DemModel& model, const std::vector<std::string>& title) {
  const PairLaw& g = model.between_grains;
  const PairLaw& w = model.at_wall;
  const bool coheres = g.cohesion != 0.0 || w.cohesion != 0.0;
  std::string law = "model hertz tangential history";
  if (coheres) law += " cohesion sjkr";
  if (g.rolling != 0.0 || w.rolling != 0.0) {
    law += model.rolling_spring ? " rolling_friction epsd2" : " rolling_friction cdt";
  }
  const std::string cohesion = coheres ? "fix cohesion all property/global cohesionEnergyDensity "
                                         "peratomtypepair 2 " +
                                             table(g.cohesion, w.cohesion) + "\n"
                                       : "";
  return comment_head(title, model.unsaid, "LIGGGHTS") +
         filled(deck,
                {{"@E1@", exact(model.grain.young)},
                 {"@E2@", exact(model.wall.young)},
                 {"@nu1@", exact(model.grain.poisson)},
                 {"@nu2@", exact(model.wall.poisson)},
                 {"@e@", table(g.restitution, w.restitution)},
                 {"@mu@", table(g.friction, w.friction)},
                 {"@roll@", table(g.rolling, w.rolling)},
                 {"@cohesion@", cohesion},
                 {"@model@", law},
                 {"@skin@", exact(0.25 * model.diameter)},
                 {"@dt@", exact(model.time_step)},
                 {"@rho@", exact(model.density)},
                 {"@radius@", exact(0.5 * model.diameter)},
                 {"@steps@", std::to_string(static_cast<long>(0.6 / model.time_step))}});
}

}  // namespace repose::server
