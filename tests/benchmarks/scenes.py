"""The scenes that peers.py times: what each code is given, and how its answer is read."""
import math
import random
import re
import subprocess

RADIUS, DENSITY, POISSON = 3.248e-3, 1228.0, 0.25  # m, kg/m3
MASS = 4.0 / 3.0 * math.pi * RADIUS**3 * DENSITY
SOFT, STIFF = 1.04e6, 41.7e6  # shear modulus, Pa


def time_step(modulus):
    """A fifth of the Rayleigh time, s."""
    rayleigh = math.pi * RADIUS * math.sqrt(DENSITY / modulus) / (0.1631 * POISSON + 0.8766)
    return 0.2 * rayleigh


def write_bed(path, rows, corners, types, speed=0.0):
    """Grains as read_data of both codes has them, each component of velocity at random up to
    `speed`, m/s."""
    shake = random.Random(2)
    lines = ["grains", "", f"{len(rows)} atoms", f"{types} atom types", ""]
    lines += [f"{low} {high} {axis}lo {axis}hi" for (low, high), axis in zip(corners, "xyz")]
    lines += ["", "Atoms", ""]
    lines += [f"{k + 1} 1 {2 * RADIUS} {DENSITY} {x:.17g} {y:.17g} {z:.17g}"
              for k, (x, y, z) in enumerate(rows)]
    lines += ["", "Velocities", ""]
    lines += [" ".join([str(k + 1), *(f"{shake.uniform(-speed, speed):.17g}" for _ in "xyz"),
                        "0 0 0"]) for k in range(len(rows))]
    path.write_text("\n".join(lines) + "\n")


def all_frames(path):
    """Steps of a dump, and the centres by id at each."""
    frames, lines = [], iter(path.read_text().splitlines())
    for line in lines:
        words = line.split()
        if line.startswith("ITEM: TIMESTEP"):
            frames.append((int(next(lines)), {}))
        elif len(words) == 4 and words[0] != "ITEM:":
            frames[-1][1][int(words[0])] = tuple(map(float, words[1:]))
    return frames


def write_stl(path, facets):
    text = "solid wall\n"
    for facet in facets:
        text += "facet normal 0 0 0\nouter loop\n"
        text += "".join(f"vertex {x:.9g} {y:.9g} {z:.9g}\n" for x, y, z in facet)
        text += "endloop\nendfacet\n"
    path.write_text(text + "endsolid wall\n")


class Bed:
    """A settled bed between periodic sides; repose's own, read by all."""

    def __init__(self, name, grains, modulus, skins):
        self.name, self.grains, self.modulus, self.skins = name, grains, modulus, skins
        self.steps, self.loops = max(50, 2_000_000 // grains), 3

    def prepare(self, repose, folder):
        self.bed = folder / f"{self.name}.bed"
        words = [repose, *self.words(folder), "--bed", self.bed]
        subprocess.run([str(word) for word in words], check=True, capture_output=True)
        side, *rows = [tuple(map(float, line.split())) for line in self.bed.read_text().splitlines()]
        top = max(row[2] for row in rows) + 0.02
        for code, types in (("liggghts", 2), ("lammps", 1)):
            write_bed(folder / f"{self.name}-{code}.data", rows,
                      [(0, side[0]), (0, side[1]), (-0.01, top)], types)

    def words(self, _folder):
        words = ["bench", "engine", "--scene", "static", "--grains", self.grains, "--rounds", "3",
                 "--json"]
        return [str(word) for word in words] + (["--stiff"] if self.modulus == STIFF else [])

    def parts(self, code):
        floor = {"liggghts": "fix floor all wall/gran model hertz tangential history "
                             "rolling_friction cdt primitive type 2 zplane 0.0",
                 "lammps": "fix floor all wall/gran ${wall} zplane 0.0 NULL"}[code]
        again = {"liggghts": f"jump {self.name}-liggghts.in again",
                 "lammps": "jump SELF again"}[code]
        return {"boundary": "p p f", "space": f"read_data {self.name}-{code}.data",
                "scene": f"{floor}\nrun 100\nprint \"TIMED\"\nvariable r loop {self.loops}\n"
                         f"label again\nrun {self.steps}\nnext r\n{again}\nprint \"ENDTIMED\""}

    def variables(self, code):
        return {"modulus": self.modulus, "dt": repr(time_step(self.modulus)),
                "skin": self.skins[code]}

    def read_repose(self, answer, _took):
        return {"rate": answer["scenes"][0]["particle_steps_per_second"]}

    def read_peer(self, _code, _text, took, _folder):
        rates = sorted(self.grains * self.steps / seconds for seconds in took["loops"])
        return {"rate": rates[len(rates) // 2]}


class Experiment:
    """A whole virtual experiment at its standard size."""

    def read_repose(self, answer, took):
        seen = next(o for o in answer["observations"] if o["name"] == self.observable)
        return {"rate": answer["grain_steps"] / took["processor"], "wall": took["wall"],
                "processor": took["processor"], "observable": seen["value"]}

    def variables(self, code):
        return {"modulus": SOFT, "dt": repr(time_step(SOFT)), "skin": self.skins[code]}

    @staticmethod
    def grain_steps(text):
        """From the lines that tell the grains every so many steps."""
        told = [(int(a), int(b)) for a, b in re.findall(r"^\s*(\d+)\s+(\d+)\s+\S+\s*$", text, re.M)]
        return sum((b - a) * (n + m) / 2 for (a, n), (b, m) in zip(told, told[1:]) if b > a)


class Kettle(Experiment):
    """A kettle under a stream of 0.288 kg/s at 1 m/s, until it has overflowed and is at rest. The
    peers get the time and the grains that this takes; they let what overflows fall away, too."""

    name, observable = "kettle", "bulk_density"
    skins = {"liggghts": 0.002, "lammps": 0.0015}  # m, each code's best
    radius, height, seconds, grains = 0.5 * 0.117475, 0.1016, 4.1, 5400

    def words(self, _folder):
        return ["evaluate", "kettle", "--json", "--setting", "source=stream", "--setting",
                "rate=0.288kg/s", "--setting", "speed=1m/s"]

    def prepare(self, _repose, folder):
        sides, facets = 64, []
        swell = math.sqrt(2 * math.pi / sides / math.sin(2 * math.pi / sides))  # the circle's area
        corner = [(swell * self.radius * math.cos(2 * math.pi * k / sides),
                   swell * self.radius * math.sin(2 * math.pi * k / sides)) for k in range(sides)]
        for a, b in zip(corner, corner[1:] + corner[:1]):
            facets.append(((0, 0, 0), (*a, 0), (*b, 0)))
            facets.append(((*a, 0), (*b, 0), (*b, self.height)))
            facets.append(((*a, 0), (*b, self.height), (*a, self.height)))
        write_stl(folder / "kettle.stl", facets)

    def parts(self, code):
        steps = int(self.seconds / time_step(SOFT))
        space = "region all block -0.075 0.075 -0.075 0.075 -0.01 0.185 units box\ncreate_box "
        opening = "region opening cylinder z 0 0 0.015875 0.1524 0.1724 units box"
        rate = 0.288 / MASS
        if code == "liggghts":
            space += "2 all"
            scene = f"""fix mesh all mesh/surface file kettle.stl type 2
fix kettle all wall/gran model hertz tangential history rolling_friction cdt mesh n_meshes 1 meshes mesh
{opening}
fix one all particletemplate/sphere 15485863 atom_type 1 density constant {DENSITY} radius constant {RADIUS}
fix all all particledistribution/discrete 32452843 1 one 1.0
fix stream all insert/rate/region seed 49979687 distributiontemplate all nparticles {self.grains} particlerate {rate} insert_every {int(0.0183 / time_step(SOFT))} maxattempt 2000 overlapcheck yes all_in yes vel constant 0 0 -1.0 region opening"""
        else:
            space += "1 all"
            scene = f"""region kettle cylinder z 0 0 {self.radius} 0.0 {self.height} open 2
fix kettle all wall/gran/region ${{wall}} region kettle
{opening}
fix stream all pour {self.grains} 1 49979687 region opening diam one {2 * RADIUS} dens {DENSITY} {DENSITY} vol 0.28 2000 vel 0 0 0 0 -1.0"""
        scene += f"\nthermo 1000\nrun {steps}\ndump end all custom 1 kettle.dump id x y z\nrun 0"
        return {"boundary": "f f f", "space": space, "scene": scene}

    def read_peer(self, code, text, took, folder):
        inside = [row for row in all_frames(folder / "kettle.dump")[-1][1].values()
                  if 0 < row[2] < self.height and math.hypot(row[0], row[1]) < self.radius]
        volume = math.pi * self.radius**2 * self.height
        return {"rate": self.grain_steps(text) / took["processor"], "wall": took["wall"],
                "processor": took["processor"], "observable": len(inside) * MASS / volume}


class TiltingBox(Experiment):
    """The box of 240 x 120 x 40 mm: rain, rest, strike-off, rest, and gravity turned at 90 degrees
    a second. The peers get 0.65 s to settle and 0.1 s after the strike-off, and turn to 36
    degrees; static_angle is read from their frames by repose's rule."""

    name, observable = "tilting_box", "static_angle"
    skins = {"liggghts": 0.0015, "lammps": 0.0015}  # m
    length, width, depth, grains, steepest = 0.24, 0.12, 0.04, 6000, 36.0

    def words(self, _folder):
        return ["evaluate", "tilting_box", "--json"]

    def prepare(self, _repose, folder):
        shake, rows = random.Random(1), []
        # As repose rains: loose and shaken, or an ordered bed comes of it that slides earlier.
        pitch = (self.length / 29, self.width / 14, 2.5 * RADIUS)
        for k in range(self.grains):
            cell = (k % 29, k // 29 % 14, k // 406)
            rows.append([(n + 0.5 + shake.uniform(-0.5, 0.5) * (1 - 2 * RADIUS / a)) * a
                         for n, a in zip(cell, pitch)])
        for code, types in (("liggghts", 2), ("lammps", 1)):
            write_bed(folder / f"{self.name}-{code}.data", rows,
                      [(-0.03, 0.27), (0, self.width), (-0.02, 0.16)], types, 0.2)
        ends = []
        for x in (0.0, self.length):
            a, b = (x, 0.0, 0.0), (x, self.width, 0.0)
            c, d = (x, self.width, self.depth), (x, 0.0, self.depth)
            ends += [(a, b, c), (a, c, d)]
        write_stl(folder / "ends.stl", ends)

    def parts(self, code):
        dt = time_step(SOFT)
        walls = {"liggghts": """fix floor all wall/gran model hertz tangential history rolling_friction cdt primitive type 1 zplane 0.0
fix ends all mesh/surface file ends.stl type 2
fix box all wall/gran model hertz tangential history rolling_friction cdt mesh n_meshes 1 meshes ends""",
                 "lammps": f"""region box block 0.0 {self.length} INF INF 0.0 {self.depth} open 6 open 3 open 4
fix box all wall/gran/region ${{wall}} region box"""}[code]
        scene = f"""{walls}
run {int(0.65 / dt)}
region above block INF INF INF INF {self.depth} INF units box
delete_atoms region above compress no
run {int(0.1 / dt)}
variable start equal {int(0.65 / dt) + int(0.1 / dt)}
variable angle equal 90.0*PI/180.0*(step-${{start}})*dt
variable gx equal sin(v_angle)
variable gz equal -cos(v_angle)
unfix weight
fix weight all gravity 9.81 vector v_gx 0 v_gz
thermo 1000
dump frames all custom {int(0.002 / dt)} tilting_box.dump id x y z
run {int(self.steepest / 90.0 / dt)}"""
        return {"boundary": "f p f", "space": f"read_data {self.name}-{code}.data", "scene": scene}

    def read_peer(self, code, text, took, folder):
        frames = all_frames(folder / "tilting_box.dump")
        (start, first), d = frames[0], 2 * RADIUS
        top = [n for n, row in first.items()
               if row[2] > self.depth - d and 0.02 < row[0] < self.length - 0.02]
        angle, before = math.nan, (0.0, 0.0)
        for step, rows in frames[1:]:
            there = [n for n in top if n in rows]
            moved = sum(rows[n][0] - first[n][0] for n in there) / len(there)
            now = (90.0 * (step - start) * time_step(SOFT), moved)
            if math.isnan(angle) and moved >= 0.5 * d:
                share = (0.5 * d - before[1]) / (moved - before[1])
                angle = before[0] + share * (now[0] - before[0])
            before = now
        steps = self.grain_steps(text)
        return {"rate": steps / took["processor"], "wall": took["wall"],
                "processor": took["processor"], "observable": angle}


def all_scenes():
    thin = {"liggghts": 0.0001, "lammps": 0.0003}  # m, each code's best for a bed at rest
    scenes = [Bed("bed_1k", 1000, SOFT, thin), Bed("bed_5k", 5000, SOFT, thin),
              Bed("bed_50k", 50000, SOFT, thin), Bed("bed_200k", 200000, SOFT, thin),
              Bed("bed_5k_stiff", 5000, STIFF, thin), Kettle(), TiltingBox()]
    return {scene.name: scene for scene in scenes}
