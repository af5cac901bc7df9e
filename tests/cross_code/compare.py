#!/usr/bin/env python3
"""Runs the bulk experiments on repose, LIGGGHTS and LAMMPS: same grain, apparatus and reading.

  tests/cross_code/compare.py [--scene NAME]... [--seeds N] [--fidelity draft] [--json FILE]

Needs Debian's packages liggghts and lammps, and a built ./build/repose. Every answer is kept in
--keep as it comes, and not asked for again: an interrupted comparison goes on where it was.
repose's frames are read again by the rules that the other codes' are read by; both are shown.
LAMMPS has no couple of constant size: repose with its own rolling spring stands beside it.
"""
import argparse
import json
import math
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(ROOT / "tests/benchmarks"))  # the decks' physics are the benchmark's

import apparatus  # noqa: E402
import reading  # noqa: E402

SPRING = "repose, rolling spring"
LIKE_WITH_LIKE = [("repose", "liggghts"), (SPRING, "lammps")]
# Each code's rolling law, here.
LAWS = {"liggghts": "rolling_resistance", "lammps": "elastic_rolling_resistance"}


def rolling_words(law, coefficient):
    return [word for each in LAWS.values() for sides in ("grain-grain", "grain-wall") for word in
            ("--set", f"{each}.coefficient:{sides}={coefficient if each == law else 0}")]


# The reference grain's couple of 0.05 as a spring of the same cap.
SPRING_WORDS = rolling_words(LAWS["lammps"], 0.05)


def catalogue(repose):
    """The experiments by name, and what a unit is in SI."""
    text = subprocess.run([repose, "catalogue", "--json"], check=True, capture_output=True).stdout
    told = json.loads(text)
    return ({experiment["name"]: experiment for experiment in told["experiments"]},
            {unit["symbol"]: unit["si_factor"] for unit in told["units"]})


def settings(repose, scene, fidelity):
    """Of the experiment, SI."""
    experiments, factors = catalogue(repose)
    told = experiments[scene]
    return {field["name"]: field["default"][fidelity] * factors[field["unit"]]
            for field in told["settings"] if not isinstance(field["default"][fidelity], str)}


def run_repose(repose, setup, scene, fidelity, folder, more=()):
    words = [repose, "evaluate", scene, "--seed", setup.seed, "--fidelity", fidelity, "--json"]
    words += more
    if setup.read_frames and not more:
        words += ["--frames", folder, "--frame-interval", setup.frame_interval or 1e6]
    done = subprocess.run(list(map(str, words)), capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, words))}: {done.stdout}{done.stderr}")
    told = {o["name"]: o["value"] for o in json.loads(done.stdout)["observations"]}
    if more:
        return {SPRING: told}
    answer = {"repose": told}
    if setup.read_frames:
        answer["repose, read here"] = setup.read_frames(reading.vtp_frames(folder))
    return answer


def run_peer(code, program, setup, folder):
    setup.prepare(folder)
    deck = (ROOT / f"tests/benchmarks/decks/{code}.in").read_text()
    for name, text in setup.parts(code).items():
        deck = deck.replace(f"${name.upper()}$", text)
    (folder / f"{code}.in").write_text(deck)
    words = ["stdbuf", "-o0", program, "-in", f"{code}.in", "-log", "none"]
    for name, value in setup.variables(code).items():
        words += ["-var", name, str(value)]
    # A code that stops on its own assertion may print what is no text.
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, errors="replace")
    if done.returncode != 0:
        told = [line for line in done.stdout.splitlines() if line.startswith("ERROR")]
        print(f"  {code} stopped and is left out: {' '.join(told) or done.stderr[-500:]}",
              file=sys.stderr)
        return {}
    dump = folder / "frames.dump"
    frames = reading.dump_frames(dump, apparatus.STEP) if dump.exists() else []
    return {code: setup.read(frames, done.stdout)}


def ask(programs, scene, fidelity, seed, keep):
    """Readings of every code; what is kept is not run again."""
    answers = {}
    known = settings(programs["repose"], scene, fidelity)
    for code, program in programs.items():
        kept = keep / f"{scene}-{fidelity}-{seed}-{code.replace(', ', '-').replace(' ', '-')}.json"
        if not kept.exists():
            setup = apparatus.ALL[scene](known, seed)
            with tempfile.TemporaryDirectory() as folder:
                folder = pathlib.Path(folder)
                if code in ("repose", SPRING):
                    more = SPRING_WORDS if code == SPRING else ()
                    answer = run_repose(program, setup, scene, fidelity, folder, more)
                else:
                    answer = run_peer(code, program, setup, folder)
            if not answer:
                continue
            kept.write_text(json.dumps(answer))
            print(f"  {kept.stem}: {answer}", file=sys.stderr, flush=True)
        answers.update(json.loads(kept.read_text()))
    return answers


def figure(values):
    spread = f" ({statistics.stdev(values):.2g})" if len(values) > 1 else ""
    return f"{statistics.mean(values):.4g}{spread}"


def apart(ours, theirs):
    """Difference of the means, and over its standard error."""
    if len(ours) < 2 or len(theirs) < 2:
        return ""
    error = math.sqrt(statistics.variance(ours) / len(ours)
                      + statistics.variance(theirs) / len(theirs))
    off = statistics.mean(ours) - statistics.mean(theirs)
    return f"{off:+.2g}, {abs(off) / error:.1f}" if error > 0 else f"{off:+.2g}"


def table(results, codes):
    columns = ["repose", "repose, read here", *(code for code in codes if code != "repose")]
    pairs = [pair for pair in LIKE_WITH_LIKE if set(pair) <= set(codes)]
    titles = columns + [f"{ours} less {theirs}; standard errors" for ours, theirs in pairs]
    print("| observable | " + " | ".join(titles) + " |")
    print("|---" * (1 + len(titles)) + "|")
    for scene, seeds in results.items():
        for name in seeds[0]["repose"]:
            def of(code):
                return [a[code][name] for a in seeds if name in a.get(code, {})]
            cells = [figure(of(code)) if of(code) else "" for code in columns]
            cells += [apart(of(ours), of(theirs)) for ours, theirs in pairs]
            print(f"| {scene}, {name} | " + " | ".join(cells) + " |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scene", action="append", choices=list(apparatus.ALL),
                        help="default: all")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--fidelity", choices=["draft", "standard"], default="standard")
    parser.add_argument("--repose", default=ROOT / "build/repose")
    parser.add_argument("--liggghts", default=shutil.which("liggghts"))
    parser.add_argument("--lammps", default=shutil.which("lmp"))
    parser.add_argument("--keep", type=pathlib.Path, default=ROOT / "build/cross_code")
    parser.add_argument("--json", type=pathlib.Path, help="write every reading there")
    asked = parser.parse_args()
    programs = {"repose": asked.repose, SPRING: asked.repose, "liggghts": asked.liggghts, "lammps": asked.lammps}
    programs = {code: program for code, program in programs.items() if program}
    asked.keep.mkdir(parents=True, exist_ok=True)
    results = {scene: [ask(programs, scene, asked.fidelity, seed, asked.keep)
                       for seed in range(1, asked.seeds + 1)]
               for scene in asked.scene or apparatus.ALL}
    print(f"{asked.fidelity}, {asked.seeds} seeds; mean (standard deviation)\n")
    table(results, list(programs))
    if asked.json:
        asked.json.write_text(json.dumps({"fidelity": asked.fidelity, "scenes": results}, indent=1))


if __name__ == "__main__":
    main()
