#!/usr/bin/env python3
"""Times repose beside LIGGGHTS and LAMMPS on the same scenes, one core, in turn.

  tests/benchmarks/peers.py [--quick] [--scene NAME]... [--rounds N] [--json FILE]

Needs Debian's packages liggghts and lammps, and a built ./build/repose. A code that is not there is
left out. Figures are processor time (/proc/PID/schedstat), which others on the machine disturb less
than wall time; whole experiments are given in both. Ratios above 1: repose is faster.
"""
import argparse
import json
import math
import os
import pathlib
import platform
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

import scenes

ROOT = pathlib.Path(__file__).resolve().parents[2]


def processor_seconds(pid):
    try:
        return int(pathlib.Path(f"/proc/{pid}/schedstat").read_text().split()[0]) * 1e-9
    except (OSError, ValueError, IndexError):
        return math.nan


def run(command, folder, core):
    """The output, and the processor seconds of each timed loop: from its header to its end."""
    child = subprocess.Popen(["taskset", "-c", str(core), "stdbuf", "-oL", *map(str, command)],
                             cwd=folder, text=True, stdout=subprocess.PIPE,
                             stderr=subprocess.STDOUT, env={**os.environ, "OMP_NUM_THREADS": "1"})
    begin, loops, lines, timed, since = time.time(), [], [], False, math.nan
    for line in child.stdout:
        lines.append(line)
        if line.startswith("TIMED"):
            timed = True
        elif timed and re.match(r"\s*Step\b", line):
            since = processor_seconds(child.pid)
        elif timed and line.startswith("Loop time"):
            loops.append(processor_seconds(child.pid) - since)
    _, status, used = os.wait4(child.pid, 0)
    child.returncode = status
    text = "".join(lines)
    if status != 0:
        sys.exit(f"{' '.join(map(str, command))} failed:\n{text[-2000:]}")
    return text, {"loops": loops, "wall": time.time() - begin,
                  "processor": used.ru_utime + used.ru_stime}


def run_peer(code, program, scene, folder, core):
    deck = (ROOT / f"tests/benchmarks/decks/{code}.in").read_text()
    parts = scene.parts(code)
    for name, text in parts.items():
        deck = deck.replace(f"${name.upper()}$", text)
    path = folder / f"{scene.name}-{code}.in"
    path.write_text(deck)
    words = [program, "-in", path, "-log", "none"]
    for name, value in scene.variables(code).items():
        words += ["-var", name, value]
    return run(words, folder, core)


def figures(scene, code, program, folder, core):
    """Particle-steps per second, seconds and the observable of one run."""
    if code == "repose":
        text, took = run([program, *scene.words(folder)], folder, core)
        return scene.read_repose(json.loads(text[text.index("{"):]), took)
    text, took = run_peer(code, program, scene, folder, core)
    return scene.read_peer(code, text, took, folder)


def compare(scene, programs, rounds, folder, core):
    scene.prepare(programs["repose"], folder)
    runs = {code: [] for code in programs}
    for number in range(rounds):
        order = list(programs) if number % 2 == 0 else list(programs)[::-1]
        for code in order:
            runs[code].append(figures(scene, code, programs[code], folder, core))
            print(f"  {scene.name}, round {number + 1}: {code} {runs[code][-1]}", file=sys.stderr)
    return {"scene": scene.name, "runs": runs}


def middle(values, digits=3):
    values = sorted(values)
    text = f"{statistics.median(values):.{digits}g}"
    return text if len(values) == 1 else f"{text} ({values[0]:.{digits}g} to {values[-1]:.{digits}g})"


def ratios(result, code, key, invert):
    """Round by round, so that what disturbs both does not count."""
    ours, theirs = result["runs"]["repose"], result["runs"][code]
    pairs = [(a[key], b[key]) for a, b in zip(ours, theirs) if a.get(key) and b.get(key)]
    return [b / a if invert else a / b for a, b in pairs]


def table(results):
    print("| scene | code | M particle-steps/s | processor s | observable | repose is faster by, rate "
          "| by, whole run |")
    print("|---|---|---|---|---|---|---|")
    for result in results:
        for code, runs in result["runs"].items():
            rate = middle([run["rate"] * 1e-6 for run in runs])
            whole = middle([run["processor"] for run in runs]) if runs[0].get("processor") else ""
            seen = middle([run["observable"] for run in runs], 5) if runs[0].get("observable") else ""
            faster = [middle(ratios(result, code, "rate", False)),
                      middle(ratios(result, code, "processor", True))
                      if runs[0].get("processor") else ""] if code != "repose" else ["", ""]
            print(f"| {result['scene']} | {code} | {rate} | {whole} | {seen} | {faster[0]} "
                  f"| {faster[1]} |")


def machine():
    model = re.search(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text())
    return f"{model.group(1) if model else platform.machine()}, {os.cpu_count()} processors, " \
           f"load {os.getloadavg()[0]:.1f} at the start"


def main():
    known = scenes.all_scenes()
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="the bed of 5,000, one round")
    parser.add_argument("--scene", action="append", choices=list(known), help="default: all")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--core", type=int, default=0, help="processor that all runs are bound to")
    parser.add_argument("--repose", default=ROOT / "build/repose")
    parser.add_argument("--liggghts", default=shutil.which("liggghts"))
    parser.add_argument("--lammps", default=shutil.which("lmp"), help="another build of LAMMPS")
    parser.add_argument("--json", type=pathlib.Path, help="write every run there")
    asked = parser.parse_args()
    programs = {"repose": asked.repose, "liggghts": asked.liggghts, "lammps": asked.lammps}
    programs = {code: program for code, program in programs.items() if program}
    names = ["bed_5k"] if asked.quick else asked.scene or list(known)
    described = machine()
    results = []
    with tempfile.TemporaryDirectory() as folder:
        for name in names:
            rounds = 1 if asked.quick else asked.rounds
            results.append(compare(known[name], programs, rounds, pathlib.Path(folder), asked.core))
    print(f"{described}; one core; median (least to most) of the rounds\n")
    table(results)
    if asked.json:
        asked.json.write_text(json.dumps({"machine": described, "scenes": results}, indent=1))


if __name__ == "__main__":
    main()
