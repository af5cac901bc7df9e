"""The seven experiments as LIGGGHTS and LAMMPS are given them, and how their answer is read.

Walls: meshes in LIGGGHTS, regions in LAMMPS. Type 1 is grain's stuff, type 2 wall's; `rough` and
`wall` are LAMMPS' laws for the two. A plate of LAMMPS is 2 mm thick, ours and LIGGGHTS' are thin.
"""
import math
import re

import reading
from scenes import DENSITY, MASS, RADIUS, SOFT, time_step, write_bed, write_stl
from walls import GRAN, disc, lying, meshes, plate, rain, region, tube

STEP = time_step(SOFT)
G = 9.81  # m/s2
ROUGH = ('variable rough string "granular hertz/material ${wallyoung} 0.4811323444 0.25 damping '
         'tsuji tangential mindlin ${wallshear} ${tangent} ${friction} rolling sds ${roll} 0.0 ${rolling}"\n')


def steps(seconds):
    return max(1, round(seconds / STEP))


class Apparatus:
    """Settings in SI, as repose's catalogue has them for the fidelity."""

    boundary = "f f f"
    skins = {"liggghts": 0.0015, "lammps": 0.0015}  # m
    physics = {}  # variables of the deck other than the reference grain's
    frame_interval = None  # s, of repose's frames that are read again; None: the last one only

    def __init__(self, settings, seed):
        self.s = {**settings, "grain": 2 * RADIUS, "mass": MASS}
        self.seed = seed

    def prepare(self, folder):
        """The files that the decks read."""
        rows, corners = self.grains()
        self.settling = math.sqrt(2 * max(row[2] for row in rows) / G) + 0.5  # s
        for code, types in (("liggghts", 2), ("lammps", 1)):
            write_bed(folder / f"{code}.data", rows, corners, types, 0.2)
        for name, facets in self.meshes().items():
            write_stl(folder / f"{name}.stl", facets)

    def parts(self, code):
        scene = (ROUGH if code == "lammps" else "") + self.scene(code)
        return {"boundary": self.boundary, "space": f"read_data {code}.data", "scene": scene}

    def variables(self, code):
        return {"modulus": SOFT, "dt": repr(STEP), "skin": self.skins[code], **self.physics}

    def struck_off(self, level):
        return (f"run {steps(self.settling)}\n"
                f"region above block INF INF INF INF {level} INF units box\n"
                f"delete_atoms region above compress no\nrun {steps(0.15)}\n")

    @staticmethod
    def dump(columns="id x y z vx", every=1):
        return f"dump frames all custom {every} frames.dump {columns}\n"


class Drop(Apparatus):
    """One grain onto a wall, the impact in some 300 steps: in twenty the rebound is 2 % off."""

    read_frames = None
    step = STEP / 16  # s

    def grains(self):
        high = self.s["height"] + RADIUS
        return [(0.0, 0.0, high)], [(-0.05, 0.05), (-0.05, 0.05), (-0.02, high + 0.02)]

    def prepare(self, folder):
        write_bed(folder / "liggghts.data", *self.grains(), 2)
        write_bed(folder / "lammps.data", *self.grains(), 1)

    def meshes(self):
        return {}

    def scene(self, code):
        law = {"liggghts": f"{GRAN} primitive type 2 zplane 0.0",
               "lammps": "${wall} zplane 0.0 NULL"}[code]
        there_and_back = 2 * math.sqrt(2 * self.s["height"] / G)  # s
        return (f"fix floor all wall/gran {law}\n{self.dump(every=round(5e-4 / self.step))}"
                f"run {round(there_and_back / self.step)}")

    def variables(self, code):
        return {**super().variables(code), "dt": repr(self.step)}

    def read(self, frames, _text):
        return reading.drop([grains[1][2] - RADIUS for _, grains in frames], self.s)


def fill_number(volume):
    """Grains of repose's fill_to: a tenth more than a close packing."""
    return int(1.1 * 0.64 * volume * DENSITY / MASS)


class Kettle(Apparatus):
    """Poured at repose's rate until 15 % more than the kettle's content has come."""

    skins = {"liggghts": 0.002, "lammps": 0.0015}

    def vessel(self):
        radius = 0.5 * self.s["diameter"]
        return tube(radius, 0.0, self.s["height"]) + disc(radius, 0.0)

    def prepare(self, folder):
        write_stl(folder / "kettle.stl", self.vessel())

    def parts(self, code):
        s, radius = self.s, 0.5 * self.s["diameter"]
        number = int(1.15 * 737.0 * math.pi * radius**2 * s["height"] / MASS)
        rate, low, tall = s["rate"] / MASS, s["height"] + s["drop"], 8 * RADIUS
        side, high = 1.3 * radius, low + tall + 0.01
        opening = (f"region opening cylinder z 0 0 {0.5 * s['opening']} {low} {low + tall} "
                   "units box\n")
        if code == "liggghts":
            walls = meshes({"kettle": 2})
            stream = f"""fix one all particletemplate/sphere 15485863 atom_type 1 &
 density constant {DENSITY} radius constant {RADIUS}
fix mix all particledistribution/discrete 32452843 1 one 1.0
fix stream all insert/rate/region seed {next_prime(32452843 + 1001 * self.seed)} &
 distributiontemplate mix nparticles {number} particlerate {rate} insert_every {steps(0.02)} &
 maxattempt 2000 overlapcheck yes all_in yes vel constant 0 0 {-s['speed']} region opening
"""
        else:
            walls = region("kettle", f"cylinder z 0 0 {radius} 0.0 {s['height']}", "wall", "open 2")
            passing = (math.sqrt(s["speed"]**2 + 2 * G * tall) - s["speed"]) / G  # s, the opening
            share = (s["rate"] / DENSITY * passing / (math.pi * (0.5 * s["opening"])**2 * tall))
            stream = f"""fix stream all pour {number} 1 {32452843 + self.seed} region opening &
 diam one {2 * RADIUS} dens {DENSITY} {DENSITY} vol {share} 2000 vel 0 0 0 0 {-s['speed']}
"""
        # A second more than the stream takes: what finds no room at once comes later, and rests.
        scene = (walls + opening + stream + f"run {steps(number / rate + 1.2)}\n"
                 + self.dump() + "run 0")
        space = (f"region all block -{side} {side} -{side} {side} -0.01 {high} units box\n"
                 f"create_box {2 if code == 'liggghts' else 1} all")
        return {"boundary": self.boundary, "space": space,
                "scene": (ROUGH if code == "lammps" else "") + scene}

    def read(self, frames, _text):
        return reading.kettle(frames[-1][1], self.s)

    def read_frames(self, frames):
        return reading.kettle(frames[-1][1], self.s)


def next_prime(n):
    while any(n % k == 0 for k in range(2, math.isqrt(n) + 1)):
        n += 1
    return n


class TiltingBox(Apparatus):
    boundary = "f p f"
    steepest = 60.0  # degrees to which the peers turn; cohesive beds slide late
    frame_interval = 0.004

    def grains(self):
        s = self.s
        number = int(1.2 * 0.64 * s["length"] * s["width"] * s["depth"] * DENSITY / MASS)
        rows = rain(number, (0, 0), (s["length"], s["width"]), self.seed)
        return rows, [(-0.03, s["length"] + 0.03), (0, s["width"]), (-0.02, rows[-1][2] + 0.02)]

    def meshes(self):
        s = self.s
        return {"ends": [facet for x in (0.0, s["length"])
                         for facet in plate((x, 0, 0), (x, s["width"], 0),
                                            (x, s["width"], s["depth"]), (x, 0, s["depth"]))]}

    def scene(self, code):
        s = self.s
        walls = {"liggghts": f"fix floor all wall/gran {GRAN} primitive type 1 zplane 0.0\n"
                             + meshes({"ends": 2}),
                 "lammps": "fix floor all wall/gran ${rough} zplane 0.0 NULL\n"
                           + region("ends", f"block 0.0 {s['length']} INF INF 0.0 {s['depth']}",
                                    "wall", "open 3 open 4 open 5 open 6")}[code]
        rate = math.degrees(s["rate"])
        start = steps(self.settling) + steps(0.15)
        turning = f"variable angle equal {rate}*PI/180.0*(step-{start})*dt\n"
        return walls + self.struck_off(s["depth"]) + turning + f"""\
variable gx equal sin(v_angle)
variable gz equal -cos(v_angle)
unfix weight
fix weight all gravity {G} vector v_gx 0 v_gz
{self.dump(every=steps(0.002))}run {steps(self.steepest / rate)}"""

    def read(self, frames, _text):
        return reading.tilting_box(frames, self.s)

    def read_frames(self, frames):
        return reading.tilting_box(frames[reading.stage_end(frames, self.frame_interval):], self.s)


class Heap(Apparatus):
    def grains(self):
        s, radius = self.s, 0.5 * self.s["cylinder_diameter"]
        rows = rain(fill_number(math.pi * radius**2 * s["fill"]), (-radius, -radius),
                    (radius, radius), self.seed,
                    lambda x, y, z: math.hypot(x, y) + RADIUS < 0.99 * radius)
        side = s["disc_diameter"]
        self.tall = rows[-1][2] + 0.01
        return rows, [(-side, side), (-side, side), (-0.02, self.tall + s["fill"] + 0.1)]

    def meshes(self):
        s, radius = self.s, 0.5 * self.s["disc_diameter"]
        return {"disc": disc(radius, 0.0) + tube(radius, 0.0, s["rim"] * s["grain"]),
                "pipe": tube(0.5 * s["cylinder_diameter"], 0.0, self.tall)}

    def scene(self, code):
        s, radius = self.s, 0.5 * self.s["disc_diameter"]
        lifting = 0.6 * s["fill"] / s["lift_speed"]  # s: then it is above every grain of the heap
        settled = self.struck_off(s["fill"])
        end = f"run {steps(1.0)}\n{self.dump()}run 0"  # lifted on and on
        if code == "liggghts":
            return (meshes({"disc": 1, "pipe": 2}) + settled
                    + f"fix lift all move/mesh mesh pipe linear 0. 0. {s['lift_speed']}\n"
                    + f"run {steps(lifting)}\n" + end)
        start = steps(self.settling) + steps(0.15)
        return (region("disc", f"cylinder z 0 0 {radius} -0.002 0.0", more="side out")
                + region("rim", f"cylinder z 0 0 {radius} 0.0 {s['rim'] * s['grain']}",
                         more="open 1 open 2")
                + "variable lifted equal 0.0\n"
                + region("pipe", f"cylinder z 0 0 {0.5 * s['cylinder_diameter']} 0.0 {self.tall}",
                         "wall", "open 1 open 2 move NULL NULL v_lifted")
                + settled + f"variable lifted equal {s['lift_speed']}*(step-{start})*dt\n"
                + f"run {steps(lifting)}\n" + end)

    def read(self, frames, _text):
        return reading.heap(frames[-1][1], self.s)

    def read_frames(self, frames):
        return reading.heap(frames[-1][1], self.s)


class DrawDown(Apparatus):
    boundary = "f p f"
    frame_interval = 0.005
    emptying = 2.5  # s

    def grains(self):
        s = self.s
        rows = rain(fill_number(s["length"] * s["width"] * s["depth"]), (0, 0),
                    (s["length"], s["width"]), self.seed)
        self.tall = rows[-1][2] + 0.01
        return rows, [(-0.01, s["length"] + 0.01), (0, s["width"]), (-0.17, self.tall + 0.01)]

    def meshes(self):
        s, w = self.s, self.s["width"]
        left, right = 0.5 * (s["length"] - s["slot"]), 0.5 * (s["length"] + s["slot"])

        def floor(low, high):
            return plate((low, 0, 0), (high, 0, 0), (high, w, 0), (low, w, 0))

        # LIGGGHTS stops where a facet is much longer than the period.
        pieces = math.ceil(self.tall / (4 * w))
        levels = [self.tall * i / pieces for i in range(pieces + 1)]
        return {"ends": [facet for x in (0.0, s["length"])
                         for low, high in zip(levels, levels[1:])
                         for facet in plate((x, 0, low), (x, w, low), (x, w, high), (x, 0, high))],
                "floor": floor(0.0, left) + floor(right, s["length"]), "cover": floor(left, right)}

    def scene(self, code):
        s = self.s
        left, right = 0.5 * (s["length"] - s["slot"]), 0.5 * (s["length"] + s["slot"])
        if code == "liggghts":
            walls = meshes({"ends": 2, "floor": 1, "cover": 1})
            # LIGGGHTS' one wall cannot lose a mesh: the cover drops faster than grains follow.
            opened = ("fix drop all move/mesh mesh cover linear 0. 0. -2.\n"
                      f"run {steps(0.07)}\nunfix drop\n")
        else:
            walls = region("ends", f"block 0.0 {s['length']} INF INF -1.0 1.0", "wall",
                           "open 3 open 4 open 5 open 6")
            for name, low, high in (("left", -0.005, left), ("cover", left, right),
                                    ("right", right, s["length"] + 0.005)):
                walls += region(name, f"block {low} {high} INF INF -0.002 0.0", more="side out")
            opened = "unfix cover\n"
        return (walls + self.struck_off(s["depth"])
                + "region inside block INF INF INF INF 0.0 INF units box\n"
                + "variable held equal count(all,inside)\n"
                + "thermo_style custom step atoms ke v_held\n"
                + f"thermo_modify lost ignore norm no flush yes\nthermo {steps(0.002)}\n"
                + f'print "SERIES"\n{opened}run {steps(self.emptying)}\n{self.dump()}run 0')

    def read(self, frames, text):
        held = [(row[0] * STEP, row[3] * MASS) for row in series(text)]
        return {**reading.discharge_rate(held, self.s),
                **reading.drain_angle(frames[-1][1], self.s)}

    def read_frames(self, frames):
        flowing = frames[reading.stage_end(frames, self.frame_interval):]
        held = [(time, MASS * sum(g[2] > 0 for g in grains.values())) for time, grains in flowing]
        return {**reading.discharge_rate(held, self.s),
                **reading.drain_angle(frames[-1][1], self.s)}


class Drum(Apparatus):
    boundary = "f p f"
    frame_interval = 0.01

    def grains(self):
        s, radius = self.s, 0.5 * self.s["diameter"]
        number = int(0.6 * s["fill"] * math.pi * radius**2 * s["length"] * DENSITY / MASS)
        clear = radius - s["grain"]
        # Tighter than repose's rain, which comes in two portions: turning forgets the filling.
        rows = rain(number, (-radius, 0), (radius, s["length"]), self.seed,
                    lambda x, y, z: math.hypot(x, z - radius) + RADIUS < clear, 2.2)
        return ([(x, y, z - radius) for x, y, z in rows],
                [(-1.1 * radius, 1.1 * radius), (0, s["length"]), (-1.1 * radius, 1.1 * radius)])

    def prepare(self, folder):
        super().prepare(folder)
        self.settling = 0.8

    def meshes(self):
        s, radius = self.s, 0.5 * self.s["diameter"]
        facets = lying(tube(radius, 0.0, s["length"], 128))
        for k in range(int(s["ribs"])):
            angle = 2 * math.pi * k / s["ribs"]
            inner, outer = ((r * math.sin(angle), -r * math.cos(angle))
                            for r in (radius - s["grain"], radius))
            (a, b), (c, d), w = inner, outer, s["length"]
            facets += plate((a, 0, b), (c, 0, d), (c, w, d), (a, w, b))
        return {"mantle": facets}

    def scene(self, code):
        s, radius = self.s, 0.5 * self.s["diameter"]
        period = 2 * math.pi / s["speed"]
        before = max(1.0, 0.35 * period)
        if code == "liggghts":
            walls = meshes({"mantle": 1})
            turn = ("fix turn all move/mesh mesh mantle rotate origin 0. 0. 0. axis 0. 1. 0. "
                    f"period {period}\n")
        else:
            walls = "variable turned equal 0.0\n" + region(
                "mantle", f"cylinder y 0 0 {radius} INF INF", more="rotate v_turned 0 0 0 0 1 0")
            for k in range(int(s["ribs"])):
                walls += f"variable turned{k} equal {2 * math.pi * k / s['ribs']}+v_turned\n"
                walls += region(f"rib{k}",
                                f"block {radius - s['grain']} {radius} INF INF -1e-4 1e-4",
                                more=f"side out rotate v_turned{k} 0 0 0 0 1 0")
            turn = f"variable turned equal {s['speed']}*(step-{steps(self.settling)})*dt\n"
        return (walls + f"run {steps(self.settling)}\n" + turn + f"run {steps(before)}\n"
                + self.dump(every=steps(0.01)) + f"run {steps(s['seconds'])}")

    def read(self, frames, _text):
        return reading.drum(frames[1:], self.s, 0.0)

    def read_frames(self, frames):
        end = frames[-1][0]
        flowing = [f for f, after in zip(frames, frames[1:] + [(math.inf, {})])
                   if f[0] > end - self.s["seconds"] + 1e-3 and after[0] - f[0] > 1e-3]
        return reading.drum(flowing, self.s, 0.5 * self.s["diameter"])


class Compression(Apparatus):
    boundary = "p p f"
    read_frames = None  # frames tell no forces

    def grains(self):
        s = self.s
        rows = rain(fill_number(s["side"]**2 * s["depth"]), (0, 0), (s["side"],) * 2, self.seed)
        self.tall = rows[-1][2] + 0.01
        return rows, [(0, s["side"]), (0, s["side"]), (-0.02, self.tall)]

    def meshes(self):
        a = self.s["side"]
        return {"platen": plate((0, 0, 0), (a, 0, 0), (a, a, 0), (0, a, 0))}

    def scene(self, code):
        s = self.s
        most, stride = s["overshoot"] * s["stress"], steps(5e-6 / s["speed"])
        start = steps(self.settling) + steps(0.15)
        again = {"liggghts": "jump liggghts.in", "lammps": "jump SELF"}[code]

        def until(label, condition):
            return (f'print "SERIES {label}"\nlabel {label}\nrun {10 * stride}\n'
                    f'variable now equal ${{stress}}\nif "{condition}" then "{again} {label}"\n')

        def press(speed):
            return ("" if code == "lammps" else "unfix press\n" if speed > 0 else "") + (
                f"fix press all move/mesh mesh platen linear 0. 0. {speed}\n"
                if code == "liggghts" else "")

        if code == "liggghts":
            base = f"fix base all wall/gran {GRAN} primitive type 2 zplane 0.0 store_force yes\n"
            platen, force = meshes({"platen": 2}, "move 0. 0. ${z0}"), "f_force_base[3]"
        else:
            base = "fix base all wall/gran ${wall} zplane 0.0 NULL contacts\n"
            platen = region("platen", "plane 0 0 ${z0} 0 0 -1", "wall", "move NULL NULL v_way")
            force = "f_base[4]"
        # The platen starts on the highest grain.
        return base + self.struck_off(s["depth"]) + f"""compute ups all reduce max z
thermo_style custom step atoms ke c_ups
run 0
variable ups equal c_ups
variable top equal ${{ups}}+{RADIUS}
variable z0 equal ${{top}}
variable way equal -{s['speed']}*(step-{start})*dt
{platen}compute force all reduce sum {force}
variable height equal ${{z0}}+v_way
variable stress equal (c_force-{G * MASS}*atoms)/{s['side']**2}
thermo_style custom step atoms ke v_height v_stress
thermo_modify lost ignore norm no flush yes
thermo {stride}
{press(-s['speed'])}{until("down", f"${{now}} < {most}")}variable turned equal step
variable turn equal ${{turned}}
variable way equal {s['speed']}*(step-2*${{turn}}+{start})*dt
{press(s['speed'])}{until("back", f"${{now}} > {0.02 * most}")}"""

    def read(self, _frames, text):
        down, back = (series(text, f"SERIES {name}") for name in ("down", "back"))
        return reading.compression(*([(row[3], row[4]) for row in rows] for rows in (down, back)),
                                   self.s)


def series(text, mark="SERIES"):
    """The rows of figures after a mark, each step once, up to the next mark."""
    rows = {}
    for line in text.split(f"\n{mark}")[1].split("\nSERIES")[0].splitlines():
        if re.fullmatch(r"\s*\d+\s+\d+(\s+\S+)+\s*", line):
            words = [float(word) for word in line.split()]
            rows[words[0]] = words
    return list(rows.values())


ALL = {"drop": Drop, "kettle": Kettle, "tilting_box": TiltingBox, "heap": Heap,
       "draw_down": DrawDown, "drum": Drum, "compression": Compression}
