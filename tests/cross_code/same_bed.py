#!/usr/bin/env python3
"""Tilts beds that repose has filled in LIGGGHTS and LAMMPS, too: what is left is the codes' own.

  tests/cross_code/same_bed.py [--seeds N] [--rolling 0]

Beds differ by more than codes do: a box filled by each code's own rain says little of their laws.
The other codes get the centres of the grains and settle without histories for 0.3 s. LIGGGHTS
has the couple of constant size, LAMMPS the rolling spring, and repose each in turn.
"""
import argparse
import json
import pathlib
import shutil
import statistics
import subprocess
import tempfile

import compare  # first: it knows where the benchmark's scenes are
import apparatus
import reading
from scenes import write_bed, write_stl


class FilledBox(apparatus.TiltingBox):
    settling = 0.3

    def __init__(self, settings, centres):
        super().__init__(settings, seed=None)
        width = settings["width"]
        self.rows = [(x, y % width, z) for x, y, z in centres]

    def prepare(self, folder):
        s = self.s
        corners = [(-0.03, s["length"] + 0.03), (0, s["width"]), (-0.02, 3 * s["depth"])]
        for code, types in (("liggghts", 2), ("lammps", 1)):
            write_bed(folder / f"{code}.data", self.rows, corners, types, 0.0)
        for name, facets in self.meshes().items():
            write_stl(folder / f"{name}.stl", facets)

    def struck_off(self, level):
        return super().struck_off(2 * level)  # done already


def tilted_here(repose, law, asked, seed, folder):
    """The angles, and the centres of the grains when the box starts to turn."""
    words = [repose, "evaluate", "tilting_box", "--seed", seed, "--fidelity", asked.fidelity, "--json",
             "--frames", folder, "--frame-interval", 1e6, *compare.rolling_words(law, asked.rolling)]
    done = subprocess.run(list(map(str, words)), check=True, capture_output=True, text=True)
    angles = {o["name"]: o["value"] for o in json.loads(done.stdout)["observations"]}
    frames = reading.vtp_frames(folder)
    _, filled = frames[reading.stage_end(frames, 1e6)]
    return angles, [grain[:3] for grain in filled.values()]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=8)
    parser.add_argument("--rolling", type=float, default=0.05, help="coefficient, in all codes")
    parser.add_argument("--fidelity", choices=["draft", "standard"], default="draft")
    parser.add_argument("--repose", default=compare.ROOT / "build/repose")
    parser.add_argument("--liggghts", default=shutil.which("liggghts"))
    parser.add_argument("--lammps", default=shutil.which("lmp"))
    asked = parser.parse_args()
    known = compare.settings(asked.repose, "tilting_box", asked.fidelity)
    print("| observable, same beds | repose less the other code: mean, its standard error | beds |")
    print("|---|---|---|")
    for code, law in compare.LAWS.items():
        program = getattr(asked, code)
        if not program:
            continue
        differences = {}
        for seed in range(1, asked.seeds + 1):
            with tempfile.TemporaryDirectory() as folder:
                folder = pathlib.Path(folder)
                ours, bed = tilted_here(asked.repose, law, asked, seed, folder / "frames")
                box = FilledBox(known, bed)
                box.rolling = asked.rolling
                theirs = compare.run_peer(code, program, box, folder).get(code, {})
            for name, value in theirs.items():
                differences.setdefault(name, []).append(ours[name] - value)
        for name, values in differences.items():
            error = statistics.stdev(values) / len(values)**0.5
            print(f"| {name}, {code} | {statistics.mean(values):+.2f} deg, {error:.2f} | {len(values)} |",
                  flush=True)


if __name__ == "__main__":
    main()
