#!/usr/bin/env python3
"""Hides effects in the engine itself and counts how often a diagnosis finds them.

  tests/hidden/own_engine.py [--cases NAME,...] [--workers N] [--keep FOLDER] [--out FILE]

The truth is of the same code as the model, which makes it easier than a real one (an inverse crime):
what is tested is the way from measurements to a name, not whether two codes agree. Six effects of
two grains, and each grain without any in two series of noise, at draft size. Every case is a study
of ten fitted and held-out readings that tells nothing of its truth: calibrate, compare, diagnose,
extend, compare. Runs are kept in --keep, so that an interrupted table goes on where it was.
"""
import argparse
import json
import os
import pathlib
import random
import subprocess
import sys

import make_study
from make_study import ROOT, compare

GG, GW = ["grain", "grain"], ["grain", "wall"]

# What the grains are like where nothing is hidden.
GRAINS = {
    "bean": {"density": 1228, "diameter": 6.496, "restitution": 0.55, "friction": 0.45,
             "wall_friction": 0.45, "rolling": 0.06, "shear_modulus": 1.04},
    "pellet": {"density": 1500, "diameter": 4.5, "restitution": 0.75, "friction": 0.35,
               "wall_friction": 0.35, "rolling": 0.12, "shear_modulus": 2.0},
}

# What is hidden: changes of the truth, the parameters set for it, and the classes of effects that
# leave its trace, any of which is right.
HIDDEN = {
    "nothing": ({}, {}, []),
    "nothing again": ({}, {}, []),
    "rolling": ({"rolling": 0.2}, {}, ["rolling_resistance"]),
    "shape": ({}, {"grain_shape.members:grain": 4}, ["grain_shape"]),
    "adhesion": ({}, {"jkr_adhesion.work:grain-grain": "0.3J/m2",
                      "jkr_adhesion.work:grain-wall": "0.3J/m2"},
                 ["jkr_adhesion", "area_cohesion", "capillary_bridge"]),
    "wall friction": ({"wall_friction": 0.15}, {}, ["wall_friction"]),
    "speed": ({}, {"plastic_restitution.softness:grain-grain": 8,
                   "plastic_restitution.softness:grain-wall": 8},
              ["plastic_restitution", "velocity_restitution"]),
    "sizes": ({}, {"size_spread.deviation:grain": 0.35}, ["size_spread"]),
}

# Experiment, observable, noise, fills, settings, held out.
READINGS = [
    ("drop", "restitution", 0.01, 1, {"height": (50, "mm")}, False),
    ("drop", "restitution", 0.01, 1, {"height": (300, "mm")}, True),
    ("drop", "restitution", 0.01, 1, {"height": (600, "mm")}, False),
    ("kettle", "bulk_density", 0.005, 3, {}, False),
    ("tilting_box", "static_angle", 0.015, 4, {}, False),
    ("draw_down", "discharge_rate", 0.012, 3, {}, False),
    ("draw_down", "drain_angle", 0.02, 3, {}, True),
    ("drum", "dynamic_angle", 0.015, 2, {"speed": (30, "rpm")}, False),
    ("compression", "secant_modulus", 0.03, 2, {}, False),
    ("compression", "residual_strain_ratio", 0.03, 2, {}, False),
]


def truth_of(grain, hidden):
    changes, own, _ = HIDDEN[hidden]
    known = {**GRAINS[grain], **changes}
    truth = {"material.density:grain": f"{known['density']}kg/m3",
             "material.density:wall": f"{known['density']}kg/m3",
             "material.diameter:grain": f"{known['diameter']}mm"}
    for partner, friction in (("grain", known["friction"]), ("wall", known["wall_friction"])):
        truth[f"material.shear_modulus:{partner}"] = f"{known['shear_modulus']}MPa"
        truth[f"restitution.coefficient:grain-{partner}"] = known["restitution"]
        truth[f"sliding_friction.coefficient:grain-{partner}"] = friction
        truth[f"rolling_resistance.coefficient:grain-{partner}"] = known["rolling"]
    return {**truth, **own}


def study_of(grain, hidden):
    """The study without its measurements: one friction for grains and walls, and where rolling
    resistance is hidden a model without it."""
    def free(field, between, lower, upper, unit, scale="linear"):
        return {"field": field, "between": between, "lower": lower, "upper": upper, "unit": unit,
                "scale": scale}

    def tied(field, between, to):
        return {"field": field, "between": between, "to": {"field": field, "between": to},
                "factor": 1.0}
    searched = [free("restitution.coefficient", GG, 0.2, 0.95, "1"),
                free("sliding_friction.coefficient", GG, 0.1, 0.9, "1"),
                free("material.shear_modulus", ["grain"], 0.3, 5.0, "MPa", "log")]
    ties = [tied("restitution.coefficient", GW, GG), tied("sliding_friction.coefficient", GW, GG),
            tied("material.shear_modulus", ["wall"], ["grain"])]
    if hidden != "rolling":
        searched.append(free("rolling_resistance.coefficient", GG, 0.002, 0.3, "1", "log"))
        ties.append(tied("rolling_resistance.coefficient", GW, GG))
    known = GRAINS[grain]
    density = {"value": known["density"], "unit": "kg/m3"}
    poisson = {"value": 0.25, "unit": "1"}
    diameter = {"value": known["diameter"], "unit": "mm"}
    return {"name": grain,
            "materials": {"grain": {"density": density, "diameter": diameter,
                                    "poisson_ratio": poisson},
                          "wall": {"density": density, "poisson_ratio": poisson}},
            "free": searched, "tied": ties,
            "budget": {"evaluations": 28, "batch": 4, "fidelity": "draft"}, "seed": 1}


class OwnLaboratory(make_study.Laboratory):
    """The engine in the place of another code. Its seeds are apart from those of a calibration."""

    def __init__(self, truth, repose, keep, catalogue, factors):
        self.truth, self.repose, self.keep = truth, repose, keep
        self.catalogue, self.factors = catalogue, factors

    def answer(self, experiment, settings, seed):
        units = {field["name"]: field.get("unit") for field in self.catalogue[experiment]["settings"]}
        words = [word for key, value in self.truth.items() for word in ("--set", f"{key}={value}")]
        for name, value in settings.items():
            unit = units[name]
            shown = f"{value / self.factors[unit]:.9g}{'' if unit == '1' else unit}"
            words += ["--setting", f"{name}={shown}"]
        done = subprocess.run([self.repose, "evaluate", experiment, "--fidelity", "draft", "--json",
                               "--seed", str(900_000 + seed), *words],
                              capture_output=True, text=True, check=False)
        if done.returncode == 2:
            sys.exit(done.stderr)
        if done.returncode != 0:
            return {}
        return {o["name"]: o["value"] for o in json.loads(done.stdout)["observations"]}


def name_of(grain, hidden):
    return f"{grain} {hidden}".replace(" ", "-")


class Case:
    def __init__(self, grain, hidden, asked, catalogue, factors):
        self.grain, self.hidden, self.asked = grain, hidden, asked
        self.folder = asked.keep / name_of(grain, hidden)
        self.folder.mkdir(parents=True, exist_ok=True)
        self.study = self.folder / "study.json"
        if not self.study.exists():
            laboratory = OwnLaboratory(truth_of(grain, hidden), asked.repose, self.folder, catalogue,
                                       factors)
            noise = random.Random(f"{grain} {hidden}")
            study = study_of(grain, hidden)
            study["measurements"] = [
                make_study.measure(laboratory,
                                   {"experiment": experiment, "observable": observable,
                                    "noise": share, "fills": fills, "held_out": held_out,
                                    "settings": {name: {"value": value, "unit": unit}
                                                 for name, (value, unit) in settings.items()}},
                                   catalogue[experiment], factors, noise)
                for experiment, observable, share, fills, settings, held_out in READINGS]
            self.study.write_text(json.dumps(study, indent=1) + "\n")

    def run(self, *words):
        done = subprocess.run([self.asked.repose, *map(str, words), "--json",
                               "--db", self.folder / "runs.db"],
                              capture_output=True, text=True, check=False)
        if done.returncode != 0:
            sys.exit(f"{self.folder.name}: repose {words[0]}: exit {done.returncode}\n{done.stderr}")
        return json.loads(done.stdout)

    def newest(self):
        return max(item["id"] for item in self.run("list")["items"])

    def row(self):
        plain = ["--workers", self.asked.workers, "--no-pictures",
                 "--report", self.folder / "report.html"]
        self.run("calibrate", self.study, *plain)
        at = self.newest()
        before = self.run("compare", at)
        told = self.run("diagnose", at, "--workers", self.asked.workers)["result"]
        row = {"grain": self.grain, "hidden": self.hidden, "verdict": told["verdict"],
               "grade": told["grade"], "names": [], "right": None, "evaluations":
               told["evaluations"], "before": errors(before), "after": None}
        right = HIDDEN[self.hidden][2]
        if told["verdict"] in ("named", "family", "pair"):
            row["names"] = [e["name"] for e in told["refits"][0]["effects"]]
            row["right"] = all(name in right for name in row["names"])
            for name in row["names"]:
                self.run("extend", at, "--effect", name, *plain)
                at = self.newest()
            row["after"] = errors(self.run("compare", at))
        elif not right:
            row["right"] = told["verdict"] == "adequate"
        else:
            row["right"] = False
        return row


def errors(comparison):
    """rms in standard errors: fitted, held out."""
    return [round(comparison["fitted_z"], 2), round(comparison["held_out_z"], 2)]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    cases = {name_of(grain, hidden): (grain, hidden) for hidden in HIDDEN for grain in GRAINS}
    parser.add_argument("--cases", help="as bean-shape,pellet-nothing; default: all sixteen")
    parser.add_argument("--workers", type=int, default=os.cpu_count())
    parser.add_argument("--repose", default=ROOT / "build/repose")
    parser.add_argument("--keep", type=pathlib.Path, default=ROOT / "build/hidden/own")
    parser.add_argument("--out", type=pathlib.Path)
    asked = parser.parse_args()
    names = asked.cases.split(",") if asked.cases else list(cases)
    if unknown := set(names) - set(cases):
        sys.exit(f"--cases: there is no {', '.join(sorted(unknown))}; there are {', '.join(cases)}")
    catalogue, factors = compare.catalogue(asked.repose)
    rows = []
    for name in names:
        rows.append(Case(*cases[name], asked, catalogue, factors).row())
        print(json.dumps(rows[-1]), flush=True)
        if asked.out:
            asked.out.write_text(json.dumps(rows, indent=1) + "\n")


if __name__ == "__main__":
    main()
