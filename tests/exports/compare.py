#!/usr/bin/env python3
"""Runs what `repose export` writes for LIGGGHTS and LAMMPS, and holds it against repose itself.

  tests/exports/compare.py [--seeds N] [--scene kettle|tilting_box]... [--keep FOLDER]

A small study of the soybean grain is calibrated (restitution at the wall, from a drop), its fit is
exported, and the two marked places of each file, the domain and the scene, are replaced by the
kettle and the tilting box of tests/benchmarks/scenes.py: nothing of the contact law is touched. Needs
Debian's packages liggghts and lammps, and a built ./build/repose. Seeds differ in the filling.
"""
import argparse
import json
import math
import pathlib
import random
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/benchmarks"))
import scenes  # noqa: E402

PROGRAMS = {"liggghts": "liggghts", "lammps": "lmp"}
SEEDS = (49979687, 67867967, 86028121, 15485867, 32452867)  # LIGGGHTS wants large primes


def value(number, unit):
    return {"value": number, "unit": unit}


def pair(field, between, number):
    return {"field": field, "between": between, **value(number, "1")}


STUDY = {
    "name": "soybean, for export",
    "materials": {
        "grain": {"density": value(1228, "kg/m3"), "diameter": value(6.496, "mm"),
                  "shear_modulus": value(1.04, "MPa"), "poisson_ratio": value(0.25, "1")},
        "wall": {"shear_modulus": value(1.04, "MPa"), "poisson_ratio": value(0.25, "1")}},
    "fixed": [pair("restitution.coefficient", ["grain", "grain"], 0.6),
              pair("sliding_friction.coefficient", ["grain", "grain"], 0.45),
              pair("sliding_friction.coefficient", ["grain", "wall"], 0.30),
              pair("rolling_resistance.coefficient", ["grain", "grain"], 0.05),
              pair("rolling_resistance.coefficient", ["grain", "wall"], 0.05)],
    "free": [{"field": "restitution.coefficient", "between": ["grain", "wall"], "lower": 0.3,
              "upper": 0.9, "unit": "1"}],
    "measurements": [{"experiment": "drop", "observable": "restitution", **value(0.6, "1"),
                      "standard_error": 0.02}],
    "budget": {"evaluations": 20, "batch": 2}}


def repose(*words):
    command = [ROOT / "build/repose", *words]
    return subprocess.run([str(word) for word in command], check=True, capture_output=True,
                          text=True).stdout


def section(deck, name, text):
    """The deck with the lines between a mark and the next one replaced."""
    lines = deck.splitlines()
    begin = next(k for k, line in enumerate(lines) if line.startswith(f"# --- {name}"))
    end = next((k for k in range(begin + 1, len(lines)) if lines[k].startswith("# --- ")),
               len(lines))
    return "\n".join(lines[:begin + 1] + text.splitlines() + lines[end:]) + "\n"


def run_peer(code, deck, scene, folder):
    parts = scene.parts(code)
    deck = section(deck, "domain", f"boundary {parts['boundary']}\n{parts['space']}")
    deck = section(deck, "scene", parts["scene"])
    path = folder / f"{scene.name}-{code}.in"
    path.write_text(deck)
    ran = subprocess.run([PROGRAMS[code], "-in", path, "-log", "none"], cwd=folder, text=True,
                         capture_output=True)
    if ran.returncode != 0:
        sys.exit(f"{code} failed:\n{(ran.stdout + ran.stderr)[-3000:]}")
    return scene.read_peer(code, ran.stdout, {"processor": 1.0, "wall": 1.0}, folder)["observable"]


def run_repose(scene, best, seed):
    words = scene.words(None) + ["--seed", str(seed)]
    for name, number in best.items():
        words += ["--set", f"{name}={number}"]
    answer = repose(*words)
    return scene.read_repose(json.loads(answer[answer.index("{"):]),
                             {"processor": 1.0, "wall": 1.0})["observable"]


def reseeded(seed, text):
    return text.replace("49979687", str(SEEDS[seed]))


def show(rows):
    print(f"{'scene':<12} {'code':<9} {'mean':>9} {'s.d.':>7}  difference from repose, of its own "
          "standard errors")
    for scene, seen in rows.items():
        own = seen["repose"]
        for code, numbers in seen.items():
            mean, spread = statistics.mean(numbers), statistics.stdev(numbers)
            gap = mean - statistics.mean(own)
            error = math.hypot(spread / math.sqrt(len(numbers)),
                               statistics.stdev(own) / math.sqrt(len(own)))
            told = "" if code == "repose" else f"  {gap:+.2f} ({100 * gap / mean:+.2f} %), {gap / error:+.1f}"
            print(f"{scene:<12} {code:<9} {mean:9.2f} {spread:7.2f}{told}", flush=True)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--seeds", type=int, default=3, choices=range(2, len(SEEDS) + 1))
    parser.add_argument("--scene", action="append", choices=["kettle", "tilting_box"])
    parser.add_argument("--keep", type=pathlib.Path, help="keep the files and results there")
    asked = parser.parse_args()
    folder = asked.keep or pathlib.Path(tempfile.mkdtemp())
    folder = folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "study.json").write_text(json.dumps(STUDY))
    database = folder / "a.db"
    repose("calibrate", folder / "study.json", "--db", database, "--no-pictures", "--report",
           folder / "report.html")
    decks = {code: repose("export", 1, "--db", database, "--format", code) for code in PROGRAMS}
    best = {}
    for line in repose("export", 1, "--db", database, "--format", "csv").splitlines()[1:]:
        field, between, number, unit, *_ = line.split(",")
        best[f"{field}:{between}"] = number + ("" if unit == "1" else unit)
    rows = {}
    for name in asked.scene or ["kettle", "tilting_box"]:
        for seed in range(asked.seeds):
            scene = scenes.all_scenes()[name]
            scenes.random = SeededRandom(seed)
            parts = scene.parts
            scene.parts = lambda code: {k: reseeded(seed, text) for k, text in parts(code).items()}
            scene.prepare(None, folder)
            seen = rows.setdefault(name, {})
            for code, deck in decks.items():
                seen.setdefault(code, []).append(run_peer(code, deck, scene, folder))
            own = run_repose(scene, best, seed + 1)
            seen.setdefault("repose", []).append(own)
            (folder / "results.json").write_text(json.dumps(rows))
            print(f"{name}, seed {seed + 1}: " + ", ".join(
                f"{code} {numbers[-1]:.2f}" for code, numbers in seen.items()), file=sys.stderr)
    show(rows)


class SeededRandom:
    """The module `random` as scenes.py uses it, its seeds moved."""

    def __init__(self, seed):
        self.seed = seed

    def Random(self, number):  # noqa: N802
        return random.Random(1000 * self.seed + number)


if __name__ == "__main__":
    main()
