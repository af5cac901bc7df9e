#!/usr/bin/env python3
"""Measures grains in another code and writes the study of what was read, noise added.

  tests/hidden/make_study.py tests/hidden/sealed/NAME.json STUDY.json [--keep FOLDER]

The sealed file says what the grains are truly like: the code, its deck's variables, and the study
without its measurements. The study tells nothing of it. Apparatus and reading are those of
tests/cross_code; every reading is the mean of some fills, its standard error the scatter of their
mean and the noise. Readings are kept in --keep as they come. Needs Debian's liggghts, lammps or yade.
"""
import argparse
import json
import math
import os
import pathlib
import random
import shutil
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SHARED = [str(ROOT / "tests/benchmarks"), str(ROOT / "tests/cross_code")]
sys.path += SHARED

import apparatus  # noqa: E402
import compare  # noqa: E402

PROGRAMS = {"liggghts": "liggghts", "lammps": "lmp", "yade": "yade"}


class Laboratory:
    def __init__(self, sealed, repose, keep):
        self.sealed, self.repose, self.keep = sealed, repose, keep
        self.code = sealed["code"]
        self.program = shutil.which(PROGRAMS[self.code])
        if not self.program:
            sys.exit(f"{self.code} is not installed")

    def read(self, experiment, settings, seed):
        """Every observable of one fill; empty where the code stopped on an assertion of its own."""
        told = "".join(f"-{name}={value:.6g}" for name, value in sorted(settings.items()))
        kept = self.keep / f"{experiment}{told}-{seed}.json"
        if not kept.exists():
            kept.write_text(json.dumps(self.answer(experiment, settings, seed)))
            print(f"  {kept.stem}: {kept.read_text()}", file=sys.stderr, flush=True)
        return json.loads(kept.read_text())

    def answer(self, experiment, settings, seed):
        known = {**compare.settings(self.repose, experiment, "draft"), **settings}
        if self.code == "yade":
            return self.in_yade({"experiment": experiment, "settings": known, "seed": seed,
                                 "physics": self.sealed["physics"]})
        setup = apparatus.ALL[experiment](known, seed)
        setup.physics = self.sealed["physics"]
        with tempfile.TemporaryDirectory() as folder:
            return compare.run_peer(self.code, self.program, setup,
                                    pathlib.Path(folder)).get(self.code, {})

    def in_yade(self, asked):
        done = subprocess.run([self.program, "-x", "-n", str(ROOT / "tests/cross_code/in_yade.py")],
                              env={**os.environ, "PYTHONPATH": os.pathsep.join(SHARED),
                                   "REPOSE_YADE": json.dumps(asked)},
                              capture_output=True, text=True, check=False)
        told = [line for line in done.stdout.splitlines() if line.startswith("ANSWER ")]
        if not told:
            print(f"  yade stopped and is left out: {done.stderr[-500:]}", file=sys.stderr)
        return json.loads(told[0].removeprefix("ANSWER ")) if told else {}

    def fills(self, experiment, observable, settings, count):
        """So many readings; a seed that the code cannot fill by, or that left nothing to read, is
        passed over."""
        found, seed = [], 0
        while len(found) < count:
            seed += 1
            if seed > 5 * count:
                sys.exit(f"{experiment} {settings}: {observable} was read in {len(found)} of "
                         f"{5 * count} fills")
            value = self.read(experiment, settings, seed).get(observable, math.nan)
            if not math.isnan(value):
                found.append(value)
        return found


def measure(laboratory, reading, info, factors, noise):
    own = {name: q["value"] * factors[q["unit"]] for name, q in reading["settings"].items()}
    fills = laboratory.fills(reading["experiment"], reading["observable"], own, reading["fills"])
    mean = statistics.mean(fills)
    scatter = statistics.stdev(fills) / math.sqrt(len(fills)) if len(fills) > 1 else 0.0
    settings = dict(reading["settings"])
    for field in info["settings"]:  # the draft's apparatus, said
        name, default = field["name"], field["default"]
        if name not in settings and default["draft"] != default["standard"]:
            settings[name] = {"value": default["draft"], "unit": field["unit"]}
    unit = next(o["unit"] for o in info["observables"] if o["name"] == reading["observable"])
    answer = {"experiment": reading["experiment"], "observable": reading["observable"],
              "value": float(f"{mean * (1 + reading['noise'] * noise.gauss(0, 1)):.5g}"),
              "unit": unit,
              "standard_error": float(f"{math.hypot(scatter, reading['noise'] * mean):.3g}"),
              "settings": settings}
    if reading.get("held_out"):
        answer["role"] = "held_out"
    return answer


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("sealed", type=pathlib.Path)
    parser.add_argument("study", type=pathlib.Path)
    parser.add_argument("--repose", default=ROOT / "build/repose")
    parser.add_argument("--keep", type=pathlib.Path)
    asked = parser.parse_args()
    sealed = json.loads(asked.sealed.read_text())
    keep = asked.keep or ROOT / "build/hidden" / asked.sealed.stem
    keep.mkdir(parents=True, exist_ok=True)
    laboratory = Laboratory(sealed, asked.repose, keep)
    experiments, factors = compare.catalogue(asked.repose)
    noise = random.Random(sealed["noise_seed"])
    study = dict(sealed["study"])
    study["measurements"] = [measure(laboratory, {"settings": {}, **reading},
                                     experiments[reading["experiment"]], factors, noise)
                             for reading in sealed["readings"]]
    asked.study.write_text(json.dumps(study, indent=1) + "\n")


if __name__ == "__main__":
    main()
