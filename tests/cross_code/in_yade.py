"""The seven experiments as YADE is given them; YADE itself runs this file.

  PYTHONPATH=tests/cross_code:tests/benchmarks yade -x -n tests/cross_code/in_yade.py

What is asked is the environment's REPOSE_YADE: {"experiment", "settings", "seed", "physics"} in SI.
Grains and meshes are those of apparatus.py, and what was seen is read by reading.py; the last line
says what was read. YADE's collider hangs on walls, and on facets as large as the cell, where sides
repeat: they are of small facets there. A facet's contact has two thirds of a grain's radius, a
wall's a half, where the others' have the whole: stiffer walls make up for it.
"""
import json
import math
import os
import random

from yade import *  # noqa: F401,F403

import apparatus
import reading
from apparatus import G, STEP, steps
from scenes import DENSITY, MASS, POISSON, RADIUS, SOFT
from walls import plate

YOUNG = 2 * SOFT * (1 + POISSON)
# As the other decks say it; adhesion is a surface energy after DMT, J/m2.
PHYSICS = {"restitution": 0.6, "friction": 0.45, "wallfriction": 0.30, "rolling": 0.05,
           "adhesion": 0.0}
WALL, FACET = math.sqrt(2), math.sqrt(1.5)  # root of a grain's radius over that of YADE's contact
APART = 2.0  # m, the period where nothing is to meet its image


def cut(facet, largest):
    """The facet in pieces without a longer edge."""
    a, b, c = max((facet, facet[1:] + facet[:1], facet[2:] + facet[:2]),
                  key=lambda turned: math.dist(*turned[:2]))
    if math.dist(a, b) <= largest:
        return [facet]
    middle = tuple(0.5 * (p + q) for p, q in zip(a, b))
    return cut((a, middle, c), largest) + cut((middle, b, c), largest)


class Scene:
    def __init__(self, setup, physics, step=STEP):
        self.setup, self.s, self.step = setup, setup.s, step
        self.known = {**PHYSICS, **physics}
        self.largest = math.inf  # edge of a facet, m
        self.grain = self.stuff(1.0, self.known["friction"])
        reduced = SOFT / (2 * (2 - POISSON))
        turning = 8 * reduced * 2.06e-4 * (0.5 * RADIUS)**2  # N m, of the rolling spring
        self.collider = InsertionSortCollider(
            [Bo1_Sphere_Aabb(), Bo1_Facet_Aabb(), Bo1_Wall_Aabb()], allowBiggerThanPeriod=True)
        law = Ip2_FrictMat_FrictMat_MindlinPhys(
            en=self.known["restitution"], krot=turning, ktwist=0.0,
            eta=0.5 * self.known["rolling"], gamma=self.known["adhesion"])
        self.newton = NewtonIntegrator(gravity=(0, 0, -G), damping=0.0)
        O.engines = [
            ForceResetter(), self.collider,
            InteractionLoop(
                [Ig2_Sphere_Sphere_ScGeom(), Ig2_Facet_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()],
                [law],
                [Law2_ScGeom_MindlinPhys_Mindlin(includeMoment=True,
                                                 includeAdhesion=self.known["adhesion"] > 0)]),
            self.newton, PyRunner(iterPeriod=500, command="SCENE.lose()")]
        O.dt = step

    def stuff(self, swell, friction):
        return O.materials.append(FrictMat(young=YOUNG / (2 / swell - 1), poisson=POISSON,
                                           density=DENSITY, frictionAngle=math.atan(friction)))

    def add(self, place, velocity=(0, 0, 0)):
        body = utils.sphere(place, RADIUS, material=self.grain)
        body.state.vel = velocity
        O.bodies.append(body)

    def fill(self, period=None):
        """The apparatus' grains, shaken as the other codes' are; a period is along x and y, m."""
        if period:
            O.periodic = True
            O.cell.setBox(*period, APART)
            self.largest = min(period) / 3
        shake = random.Random(2)
        rows, corners = self.setup.grains()
        self.low = corners[2][0]
        for place in rows:
            self.add(place, [shake.uniform(-0.2, 0.2) for _ in "xyz"])
        self.settling = math.sqrt(2 * max(row[2] for row in rows) / G) + 0.5  # s

    def mesh(self, facets, friction):
        stuff = self.stuff(FACET, self.known[friction])
        return O.bodies.append([utils.facet(small, material=stuff, wire=False)
                                for facet in facets for small in cut(facet, self.largest)])

    @staticmethod
    def grains():
        return [body for body in O.bodies if isinstance(body.shape, Sphere) and body.dynamic]

    def take(self, gone):
        """Out of the way: the periodic collider hangs where bodies are erased."""
        for body in self.grains():
            if gone(body.state.pos):
                body.dynamic = False
                body.state.vel = body.state.angVel = (0, 0, 0)
                body.state.pos = (0, 0, 0.75 * APART)

    def lose(self):
        self.take(lambda place: place[2] < self.low)

    @staticmethod
    def run(seconds):
        O.run(steps(seconds), True)

    def strike_off(self, level):
        self.run(self.settling)
        self.take(lambda place: place[2] > level)
        self.run(0.15)

    def frame(self):
        return (O.iter * self.step, {body.id: (*body.state.pos, body.state.vel[0])
                                     for body in self.grains()})

    def watch(self, every, note, seconds=None):
        """What `note` gives every so many steps, for a time or until it gives nothing."""
        seen = []

        def look():
            seen.append(note())
            if seen[-1] is None:
                O.pause()
        self.look = look
        O.engines = O.engines + [PyRunner(iterPeriod=every, command="SCENE.look()")]
        O.run(-1 if seconds is None else round(seconds / self.step), True)
        O.engines = O.engines[:-1]
        return [each for each in seen if each is not None]


def flat(length, width, z):
    return plate((0, 0, z), (length, 0, z), (length, width, z), (0, width, z))


def drop(scene):
    s = scene.s
    (place,), _ = scene.setup.grains()
    scene.low = -1.0
    scene.add(place)
    O.bodies.append(utils.wall((0, 0, 0), axis=2, sense=1,
                               material=scene.stuff(WALL, scene.known["wallfriction"])))
    ball = scene.grains()[0]
    heights = scene.watch(round(5e-4 / scene.step), lambda: ball.state.pos[2] - RADIUS,
                          2 * math.sqrt(2 * s["height"] / G))
    return reading.drop(heights, s)


def kettle(scene):
    s = scene.s
    radius, low, tall = 0.5 * s["diameter"], s["height"] + s["drop"], 8 * RADIUS
    number = int(1.15 * 737.0 * math.pi * radius**2 * s["height"] / MASS)
    scene.low = -0.01
    scene.mesh(scene.setup.vessel(), "wallfriction")
    choose, owed, placed, every = random.Random(scene.setup.seed), 0.0, 0, steps(0.02)
    while placed < number:
        owed += s["rate"] / MASS * every * STEP
        near = [tuple(b.state.pos) for b in scene.grains() if b.state.pos[2] > low - 2 * RADIUS]
        for _ in range(4000):
            if owed < 1 or placed == number:
                break
            away = (0.5 * s["opening"] - RADIUS) * math.sqrt(choose.random())
            turn = choose.uniform(0, 2 * math.pi)
            place = (away * math.cos(turn), away * math.sin(turn),
                     low + choose.uniform(RADIUS, tall - RADIUS))
            if all(math.dist(place, other) > 2 * RADIUS for other in near):
                scene.add(place, (0, 0, -s["speed"]))
                near.append(place)
                owed, placed = owed - 1, placed + 1
        O.run(every, True)
    scene.run(1.2)
    return reading.kettle(scene.frame()[1], s)


def tilting_box(scene):
    s = scene.s
    scene.fill((APART, s["width"]))
    scene.mesh(flat(s["length"], s["width"], 0.0), "friction")
    scene.mesh(scene.setup.meshes()["ends"], "wallfriction")
    scene.strike_off(s["depth"])
    start = O.iter

    def turn():
        angle = s["rate"] * (O.iter - start) * STEP
        scene.newton.gravity = (G * math.sin(angle), 0, -G * math.cos(angle))
    scene.turn = turn
    O.engines = O.engines + [PyRunner(iterPeriod=5, command="SCENE.turn()")]
    return reading.tilting_box(scene.watch(steps(0.002), scene.frame, scene.setup.steepest
                                           / math.degrees(s["rate"])), s)


def heap(scene):
    s = scene.s
    scene.fill()
    meshes = scene.setup.meshes()
    scene.mesh(meshes["disc"], "friction")
    pipe = scene.mesh(meshes["pipe"], "wallfriction")
    scene.strike_off(s["fill"])
    for facet in pipe:
        O.bodies[facet].state.vel = (0, 0, s["lift_speed"])
    scene.run(0.6 * s["fill"] / s["lift_speed"] + 1.0)
    return reading.heap(scene.frame()[1], s)


def draw_down(scene):
    s = scene.s
    scene.fill((APART, s["width"]))
    meshes = scene.setup.meshes()
    scene.mesh(meshes["ends"], "wallfriction")
    scene.mesh(meshes["floor"], "friction")
    cover = scene.mesh(meshes["cover"], "friction")
    scene.strike_off(s["depth"])
    for facet in cover:
        O.bodies[facet].state.pos += (0, 0, 0.75 * APART)
    frames = scene.watch(steps(0.005), scene.frame, scene.setup.emptying)
    held = [(time, MASS * sum(g[2] > 0 for g in grains.values())) for time, grains in frames]
    return {**reading.discharge_rate(held, s), **reading.drain_angle(scene.frame()[1], s)}


def drum(scene):
    s = scene.s
    scene.fill((APART, s["length"]))
    mantle = scene.mesh(scene.setup.meshes()["mantle"], "friction")
    scene.run(0.8)
    O.engines = O.engines + [RotationEngine(rotateAroundZero=True, zeroPoint=(0, 0, 0),
                                            rotationAxis=(0, 1, 0), angularVelocity=s["speed"],
                                            ids=mantle)]
    scene.run(max(1.0, 0.35 * 2 * math.pi / s["speed"]))
    return reading.drum(scene.watch(steps(0.01), scene.frame, s["seconds"]), s, 0.0)


def compression(scene):
    s = scene.s
    scene.fill((s["side"], s["side"]))
    base = scene.mesh(flat(s["side"], s["side"], 0.0), "wallfriction")
    scene.strike_off(s["depth"])
    # The platen starts on the highest grain.
    top = max(body.state.pos[2] for body in scene.grains()) + RADIUS
    platen = scene.mesh(flat(s["side"], s["side"], top), "wallfriction")
    weight = G * MASS * len(scene.grains())
    most = s["overshoot"] * s["stress"]

    def press(speed, on):
        for facet in platen:
            O.bodies[facet].state.vel = (0, 0, speed)

        def note():
            force = -sum(O.forces.f(facet)[2] for facet in base)
            stress = (force - weight) / s["side"]**2
            return (O.bodies[platen[0]].state.pos[2], stress) if on(stress) else None
        return scene.watch(steps(5e-6 / s["speed"]), note)
    down = press(-s["speed"], lambda stress: stress < most)
    return reading.compression(down, press(s["speed"], lambda stress: stress > 0.02 * most), s)


ASKED = json.loads(os.environ["REPOSE_YADE"])
NAME = ASKED["experiment"]
SETUP = apparatus.ALL[NAME](ASKED["settings"], ASKED["seed"])
SCENE = Scene(SETUP, ASKED["physics"], getattr(SETUP, "step", STEP))
print("ANSWER " + json.dumps(globals()[NAME](SCENE)), flush=True)
