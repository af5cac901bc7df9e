"""What is seen in the grains of any code: frames in, the experiments' observables out.

A frame is its time in seconds and the grains by number, each (x, y, z, vx) in SI. The rules are
those of engine/experiments, written again from their text: on repose's own frames they give what
repose gives, which compare.py shows.
"""
import array
import base64
import math
import re


def dump_frames(path, step):
    """Of a text dump with columns id x y z vx, as LIGGGHTS and LAMMPS write it."""
    frames, grains = [], None
    with open(path) as lines:
        for line in lines:
            if line.startswith("ITEM: TIMESTEP"):
                grains = {}
                frames.append((int(next(lines)) * step, grains))
            elif not line.startswith("ITEM:"):
                words = line.split()
                if len(words) == 5:
                    grains[int(words[0])] = tuple(map(float, words[1:]))
    return frames


def vtp_frames(folder):
    """Of the files that `repose evaluate --frames` writes."""
    listed = re.findall(r'timestep="([^"]+)" part="0" file="([^"]+)"',
                        (folder / "frames.pvd").read_text())
    return [(float(time), vtp_grains((folder / name).read_text())) for time, name in listed]


def vtp_grains(text):
    def numbers(name, kind):
        packed = re.search(rf'Name="{name}"[^>]*format="binary">([^<]*)<', text).group(1)
        return array.array(kind, base64.b64decode(packed)[4:])  # after their count

    places, speeds = numbers("Points", "d"), numbers("velocity", "d")
    return {n: (*places[3 * k:3 * k + 3], speeds[3 * k])
            for k, n in enumerate(numbers("id", "q"))}


def stage_end(frames, interval):
    """Index of the first frame that comes out of turn: a stage of the protocol ended there."""
    return next(k for k in range(1, len(frames))
                if frames[k][0] - frames[k - 1][0] < 0.9 * interval)


def line(points):
    """Slope and intercept by least squares."""
    n = len(points)
    mean_x, mean_y = sum(x for x, _ in points) / n, sum(y for _, y in points) / n
    slope = (sum((x - mean_x) * (y - mean_y) for x, y in points) /
             sum((x - mean_x)**2 for x, _ in points))
    return slope, mean_y - slope * mean_x


def crossing(points, level, rising=True):
    """Where a curve of (x, y) first passes a level."""
    for (x0, y0), (x1, y1) in zip(points, points[1:]):
        if (y0 < level <= y1) if rising else (y0 > level >= y1):
            return x0 + (x1 - x0) * (level - y0) / (y1 - y0)
    return math.nan


def degrees(slope):
    return math.degrees(math.atan(slope))


def surface_along_x(grains, radius, width, low, high, places, points):
    """(x, height) of the places covered at half their points or more: at each the mean, over points
    across a periodic y, of the top of the uppermost grain above the point."""
    pitch, across = (high - low) / places, width / points
    tops = [[-math.inf] * points for _ in range(places)]
    for x, y, z, _ in grains.values():
        first = max(0, math.ceil((x - radius - low) / pitch - 0.5))
        last = min(places - 1, math.floor((x + radius - low) / pitch - 0.5))
        for i in range(first, last + 1):
            half = radius**2 - (low + (i + 0.5) * pitch - x)**2
            if half <= 0:
                continue
            reach, row = math.sqrt(half), tops[i]
            for k in range(math.ceil((y - reach) / across - 0.5),
                           math.floor((y + reach) / across - 0.5) + 1):
                rise = half - ((k + 0.5) * across - y)**2
                if rise > 0:
                    top = z + math.sqrt(rise)
                    if top > row[k % points]:
                        row[k % points] = top
    profile = []
    for i, row in enumerate(tops):
        met = [top for top in row if top > -math.inf]
        if 2 * len(met) >= points:
            profile.append((low + (i + 0.5) * pitch, sum(met) / len(met)))
    return profile


def drop(heights, s):
    """Of the underside of the grain, every half millisecond."""
    lowest = heights.index(min(heights))
    return {"restitution": math.sqrt(max(heights[lowest:]) / s["height"])}


def kettle(grains, s):
    inside = [g for g in grains.values()
              if 0 < g[2] < s["height"] and math.hypot(g[0], g[1]) < 0.5 * s["diameter"]]
    volume = math.pi / 4 * s["diameter"]**2 * s["height"]
    return {"bulk_density": len(inside) * s["mass"] / volume}


def heap(grains, s):
    low, high = 0.1 * s["disc_diameter"], 0.4 * s["disc_diameter"]
    rings, sectors = max(3, round((high - low) / s["grain"])), 12
    tops = [[None] * sectors for _ in range(rings)]
    for x, y, z, _ in grains.values():
        ring = math.floor((math.hypot(x, y) - low) / (high - low) * rings)
        hangs = z > s["fill"]  # in the cylinder: the heap is lower
        if 0 <= ring < rings and not hangs:
            share = math.atan2(y, x) / (2 * math.pi) + 0.5
            sector, top = min(int(share * sectors), sectors - 1), z + 0.5 * s["grain"]
            tops[ring][sector] = max(top, tops[ring][sector] or top)
    points = []
    for ring, row in enumerate(tops):
        met = [top for top in row if top is not None]
        points.append((low + (ring + 0.5) / rings * (high - low), sum(met) / len(met)))
    return {"heap_angle": degrees(-line(points)[0])}


def drum(frames, s, axis):
    """Of frames every hundredth of a second while the bed flows; what hangs overhead is left out.
    axis: its height in them."""
    mantle, grain = 0.5 * s["diameter"], s["grain"]
    reach = 0.55 * mantle

    def of_bed(x, z):
        return z < axis or mantle - math.hypot(x, z - axis) > 1.5 * grain

    slopes = [line(surface_along_x({n: g for n, g in grains.items() if of_bed(g[0], g[2])},
                                   0.5 * grain, s["length"], -reach, reach, 24, 24))[0]
              for _, grains in frames]
    return {"dynamic_angle": sum(map(degrees, map(abs, slopes))) / len(slopes)}


def tilting_box(frames, s):
    """Of the frames from the moment that the box starts to turn."""
    (start, first), d, clear = frames[0], s["grain"], 0.02
    top = [n for n, g in first.items()
           if g[2] > s["depth"] - d and clear < g[0] < s["length"] - clear]
    moved, speed = [(0.0, 0.0)], [(0.0, 0.0)]
    for time, grains in frames[1:]:
        there = [n for n in top if n in grains]
        angle = math.degrees(s["rate"]) * (time - start)
        moved.append((angle, sum(grains[n][0] - first[n][0] for n in there) / len(there)))
        speed.append((angle, sum(grains[n][3] for n in there) / len(there)))
    return {"static_angle": crossing(moved, 0.5 * d), "onset_angle": crossing(speed, 0.01)}


def discharge_rate(held, s):
    """Of (time, mass held): slope of the discharged mass between 20 and 70 % of the final one."""
    filling = held[0][1]
    gone = [(time, filling - mass) for time, mass in held]
    total = gone[-1][1]
    steady = [(time, mass) for time, mass in gone if 0.2 * total <= mass <= 0.7 * total]
    return {"discharge_rate": line(steady)[0] / s["width"]}


def drain_angle(grains, s):
    beside = 0.5 * (s["length"] - s["slot"])
    angles = []
    for side in (-1, 1):
        edge = 0.5 * (s["length"] + side * s["slot"])
        low, high = sorted((edge + side * 0.2 * beside, edge + side * 0.8 * beside))
        profile = surface_along_x(grains, 0.5 * s["grain"], s["width"], low, high, 30, 60)
        outward, points = profile[::side], []
        for x, height in outward:
            if height > s["depth"] - s["grain"]:
                break  # the level surface that was struck off
            points.append((x, height))
        angles.append(degrees(side * line(points)[0]))
    return {"drain_angle": sum(angles) / 2}


def compression(loading, unloading, s):
    """Of (height of the platen, stress at the base less the bed's weight) going down and back."""
    smooth = 8  # samples

    def smoothed(curve):
        rows = []
        for k in range(len(curve)):
            window = curve[max(0, k - smooth + 1):k + 1]
            rows.append((curve[k][0], sum(stress for _, stress in window) / len(window)))
        return rows

    down, back = smoothed(loading), smoothed(unloading)
    left = 0.05 * s["overshoot"] * s["stress"]
    depth, quarter, full = (crossing(down, share * s["stress"]) for share in (0.01, 0.25, 1.0))
    start, end = crossing(down, left), crossing(back, left, rising=False)
    return {"secant_modulus": 0.75 * s["stress"] * depth / (quarter - full) * 1e-6,
            "residual_strain_ratio": (start - end) / (start - down[-1][0])}
