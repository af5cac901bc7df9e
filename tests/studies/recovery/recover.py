#!/usr/bin/env python3
"""How many evaluations on the real engine until a calibration meets its targets, beside the baselines.

    tests/studies/recovery/recover.py --program build/repose --folder results --case synthetic --seeds 3

synthetic  six observables of four experiments, five free parameters; the targets are means of the
           engine's own runs at a truth that no method is told
soybean    bulk density, angle of repose and restitution of the worked example

A calibration has solved its study where four fresh runs at the set it recommends are, on average, within one
standard error of every target. Each result is a line of FOLDER/CASE.jsonl, so an interrupted run is taken up
where it was; the table is printed again each time.
"""
import argparse, json, math, pathlib, random, statistics, subprocess, sys

SOURCE = pathlib.Path(__file__).resolve().parents[3]
PAIR = ["grain", "grain"]
# Standard errors of a careful laboratory, absolute, or relative where below zero.
OBSERVED = [("tilting_box", "static_angle", "deg", 1.0), ("tilting_box", "onset_angle", "deg", 1.5),
            ("heap", "heap_angle", "deg", 1.0), ("compression", "secant_modulus", "MPa", -0.05),
            ("compression", "residual_strain_ratio", "1", 0.02), ("drop", "restitution", "1", 0.02)]


def run(program, *arguments, text=None):
    done = subprocess.run([program, *arguments], input=text, capture_output=True, text=True)
    if done.returncode not in (0, 3):
        sys.exit(f"{' '.join(arguments)}: {done.stderr}")
    return json.loads(done.stdout)


def example():
    return json.loads((SOURCE / "schemas/examples/valid/boac2010-soybean.json").read_text())


def name_of(parameter):
    return parameter["field"] + ":" + "-".join(parameter["between"])


def observe(program, study, values, first_seed, count):
    """Means over `count` seeds of every measurement's observable, in its unit, at one parameter set."""
    means = {}
    for experiment in sorted({m["experiment"] for m in study["measurements"]}):
        unit = {p["field"]: p["unit"] for p in study["free"]}
        sets = [f"--set={key}={value!r} {unit[key.split(':')[0]]}" for key, value in values.items()]
        path = pathlib.Path(args.folder) / "study.json"
        path.write_text(json.dumps(study))
        answer = run(program, "evaluate", experiment, "--study", str(path), "--fidelity",
                     study["budget"]["fidelity"], "--seed", str(first_seed), "--replicates", str(count),
                     "--json", *sets)
        for o in answer["observations"]:
            means[experiment, o["name"]] = (o["value"], o["unit"])
    return means


def soybean(program, seed):
    study = example()
    study["seed"] = seed
    return study


def synthetic(program, seed):
    """Truth in the middle eight tenths of every range; the targets are means of eight runs."""
    study = example()
    study["seed"] = seed
    draw = random.Random(seed)
    truth = {}
    for p in study["free"]:
        u = draw.uniform(0.1, 0.9)
        low, high = p["lower"], p["upper"]
        truth[name_of(p)] = low * (high / low) ** u if p.get("scale") == "log" else low + u * (high - low)
    study["measurements"] = [{"experiment": e, "observable": o} for e, o, _, _ in OBSERVED]
    study["budget"]["fidelity"] = "draft"
    bare = dict(study, measurements=[dict(m, value=1, unit=u, standard_error=1) for m, (_, _, u, _) in
                                     zip(study["measurements"], OBSERVED)])
    means = observe(program, bare, truth, 900001, 8)
    for m, (e, o, unit, error) in zip(study["measurements"], OBSERVED):
        value, m["unit"] = means[e, o]
        m["value"] = value
        m["standard_error"] = error if error > 0 else -error * value
    return study


def solve(program, case, seed, method):
    path = pathlib.Path(args.folder) / f"{case}-{seed}.json"
    if not path.exists():
        study = {"synthetic": synthetic, "soybean": soybean}[case](program, seed)
        path.write_text(json.dumps(study))
    study = json.loads(path.read_text())
    study["budget"] = {"evaluations": args.evaluations, "batch": 4, "fidelity": "draft", "method": method}
    study["name"] = f"{case} {seed} {method}"
    database = pathlib.Path(args.folder) / f"{case}.db"
    document = run(program, "calibrate", "-", "--db", str(database), "--no-pictures", "--json", "--workers", "1",
                   text=json.dumps(study))
    fit = document["fit"]
    result = {"seed": seed, "method": method, "stop": fit["stop"], "evaluations": fit["evaluations"],
              "learnt": sum(d["learnt"] for d in fit["directions"]), "misfit": fit["misfit"],
              "next": [n["experiment"] + " " + n["observable"] for n in fit.get("next_measurements", [])]}
    if not fit["parameters"]:
        return dict(result, solved=False)
    best = {name_of(p): p["value"] for p in fit["parameters"]}
    means = observe(program, study, best, 800001, 4)
    z = {f"{m['experiment']} {m['observable']}": (means[m["experiment"], m["observable"]][0] - m["value"]) /
         m["standard_error"] for m in study["measurements"]}
    return dict(result, z=z, solved=all(abs(x) <= 1 for x in z.values()))


def table(results):
    print(f"{'method':10} {'studies':>7} {'solved':>7} {'evaluations':>11} {'worst |z|':>9} {'learnt':>6}")
    for method in args.methods.split(","):
        rows = [r for r in results if r["method"] == method]
        if not rows:
            continue
        worst = statistics.median(max(map(abs, r.get("z", {"": math.inf}).values())) for r in rows)
        print(f"{method:10} {len(rows):7} {sum(r['solved'] for r in rows):7} "
              f"{statistics.median(r['evaluations'] for r in rows):11g} {worst:9.2f} "
              f"{statistics.median(r['learnt'] for r in rows):6g}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--program", default=str(SOURCE / "build/repose"))
    parser.add_argument("--folder", default=".")
    parser.add_argument("--case", choices=["synthetic", "soybean"], default="synthetic")
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--methods", default="repose,cma_es,filter")
    parser.add_argument("--evaluations", type=int, default=40)
    args = parser.parse_args()
    log = pathlib.Path(args.folder) / f"{args.case}.jsonl"
    results = [json.loads(line) for line in log.read_text().splitlines()] if log.exists() else []
    for seed in range(1, args.seeds + 1):
        for method in args.methods.split(","):
            if any(r["seed"] == seed and r["method"] == method for r in results):
                continue
            results.append(solve(args.program, args.case, seed, method))
            with log.open("a") as file:
                file.write(json.dumps(results[-1]) + "\n")
            print(json.dumps(results[-1]), file=sys.stderr)
    table(results)
