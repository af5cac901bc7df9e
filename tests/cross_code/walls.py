"""Grains and walls as the two codes are given them: LIGGGHTS takes meshes, LAMMPS regions."""
import math
import random

from scenes import RADIUS

GRAN = "model ${contacts}"


def rain(number, low, high, seed, fits=lambda x, y, z: True, pitch=2.5):
    """Centres on a shaken lattice over a rectangle, from the bottom up: repose's filling rule."""
    shake, rows, layer = random.Random(seed), [], 0
    cells = [max(1, int((b - a) / (pitch * RADIUS))) for a, b in zip(low, high)]
    size = [(b - a) / n for a, b, n in zip(low, high, cells)] + [pitch * RADIUS]
    free = [0.5 * a - RADIUS for a in size]
    while len(rows) < number and layer < 4000:
        for i in range(cells[0]):
            for j in range(cells[1]):
                place = [o + (n + 0.5) * a + shake.uniform(-f, f)
                         for o, n, a, f in zip((*low, 0.0), (i, j, layer), size, free)]
                if fits(*place) and len(rows) < number:
                    rows.append(place)
        layer += 1
    return rows


def tube(radius, low, high, sides=96):
    """Facets of a prism round z with the circle's area, cut so that none is a needle."""
    swell = math.sqrt(2 * math.pi / sides / math.sin(2 * math.pi / sides))
    ring = [(swell * radius * math.cos(2 * math.pi * k / sides),
             swell * radius * math.sin(2 * math.pi * k / sides)) for k in range(sides)]
    rows = max(1, round((high - low) / 0.02))
    levels = [low + (high - low) * k / rows for k in range(rows + 1)]
    return [facet for z, top in zip(levels, levels[1:]) for a, b in zip(ring, ring[1:] + ring[:1])
            for facet in (((*a, z), (*b, z), (*b, top)), ((*a, z), (*b, top), (*a, top)))]


def disc(radius, z, sides=96):
    corner = [facet[0] for facet in tube(radius, z, z + 0.02, sides)[::2]]
    return [((0.0, 0.0, z), a, b) for a, b in zip(corner, corner[1:] + corner[:1])]


def plate(a, b, c, d):
    return [(a, b, c), (a, c, d)]


def lying(facets):
    """Turned from round z to round y."""
    return [tuple((x, z, -y) for x, y, z in facet) for facet in facets]


def meshes(kinds, more=""):
    """LIGGGHTS' one wall of meshes, each the file NAME.stl of its type."""
    listed = "".join(f"fix {name} all mesh/surface file {name}.stl type {kind} {more}\n"
                     for name, kind in kinds.items())
    return listed + (f"fix meshes all wall/gran {GRAN} mesh n_meshes {len(kinds)} "
                     f"meshes {' '.join(kinds)}\n")


def region(name, shape, law="rough", more=""):
    """A LAMMPS wall of its own."""
    return (f"region {name} {shape} {more}\n"
            f"fix {name} all wall/gran/region ${{{law}}} region {name}\n")
