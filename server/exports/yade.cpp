#include <cmath>

#include "engine/unit.hpp"
#include "server/exports/export.hpp"

namespace repose::server {

namespace {

constexpr const char* script = R"(
import math
from yade import *
from yade import pack, utils
# --- materials: 'grain' and 'wall'
grain = O.materials.append(FrictMat(young=@E1@, poisson=@nu1@, density=@rho@, frictionAngle=math.atan(@mu@), label='grain'))
wall = O.materials.append(FrictMat(young=@E2@, poisson=@nu2@, density=@rho@, frictionAngle=math.atan(@muw@), label='wall'))
RADIUS = @radius@  # m
# --- contact law: pairs are (grain, grain) and (grain, wall)
def pairs(between_grains, at_wall):
    return MatchMaker(matches=((grain, grain, between_grains), (grain, wall, at_wall)))
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Facet_Aabb(), Bo1_Wall_Aabb(), Bo1_Box_Aabb()], verletDist=0.15 * RADIUS),
    InteractionLoop(
        [Ig2_Sphere_Sphere_ScGeom(), Ig2_Facet_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom(), Ig2_Box_Sphere_ScGeom()],
        [Ip2_FrictMat_FrictMat_MindlinPhys(
            en=pairs(@e@, @ew@),
            frictAngle=pairs(math.atan(@mu@), math.atan(@muw@)),
            eta=pairs(@eta@, @etaw@), krot=@krot@, ktwist=0.0)],
        [Law2_ScGeom_MindlinPhys_Mindlin(includeMoment=@moment@)]),
    NewtonIntegrator(gravity=(0, 0, -9.81), damping=0.0),
]
O.dt = @dt@
# --- scene: an example. Grains fall on a floor and come to rest.
O.bodies.append(utils.wall(0.0, axis=2, sense=1, material=wall))
grains = pack.SpherePack()
grains.makeCloud((-0.03, -0.03, 0.01), (0.03, 0.03, 0.2), rMean=RADIUS, num=300, seed=1)
grains.toSimulation(material=grain)
O.run(int(0.6 / O.dt), wait=True)
)";

const std::vector<std::string> remarks{
    "How this says it in YADE (2023.02a; MindlinPhys). Not run by us: YADE is not at hand where",
    "repose is tested.",
    "  - the cap of the rolling couple has the mean radius where repose has the reduced one: eta "
    "is",
    "    half the coefficient between grains, and the coefficient itself at a wall.",
    "  - its rolling spring of constant stiffness stands for repose's couple.",
    "  - at a Wall or Box it takes half the grain's radius, at a Facet two thirds of it, for the",
    "    reduced radius, where repose takes the radius: a wall is softer by sqrt(1/2), sqrt(2/3).",
    "  - en damps after Thornton et al. 2013 and cuts tension, as repose does.",
};

}  // namespace

std::string print_yade(const DemModel& model, const std::vector<std::string>& title) {
  const PairLaw& g = model.between_grains;
  const PairLaw& w = model.at_wall;
  std::vector<std::string> unsaid = model.unsaid;
  if (g.cohesion != 0.0 || w.cohesion != 0.0) {
    unsaid.push_back("area_cohesion.energy_density: MindlinPhys has DMT adhesion only");
  }
  std::vector<std::string> head = title;
  head.insert(head.end(), remarks.begin(), remarks.end());
  const double reduced = 0.25 * model.diameter;
  const double weight = 9.81 * model.density * engine::unit::pi / 6.0 * std::pow(model.diameter, 3);
  const double patch = std::cbrt(0.75 * 6.0 * weight * reduced / g.modulus);
  const bool rolls = g.rolling != 0.0 || w.rolling != 0.0;
  return comment_head(head, unsaid, "YADE") +
         filled(script,
                {{"@E1@", exact(model.grain.young)},
                 {"@E2@", exact(model.wall.young)},
                 {"@nu1@", exact(model.grain.poisson)},
                 {"@nu2@", exact(model.wall.poisson)},
                 {"@rho@", exact(model.density)},
                 {"@mu@", exact(g.friction)},
                 {"@muw@", exact(w.friction)},
                 {"@radius@", exact(0.5 * model.diameter)},
                 {"@e@", exact(g.restitution)},
                 {"@ew@", exact(w.restitution)},
                 {"@eta@", exact(0.5 * g.rolling)},
                 {"@etaw@", exact(w.rolling)},
                 {"@krot@", exact(8.0 * g.shear * patch * reduced * reduced)},
                 {"@moment@", rolls ? "True" : "False"},
                 {"@dt@", exact(model.time_step)}});
}

}  // namespace repose::server
