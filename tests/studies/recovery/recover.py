#!/usr/bin/env python3
"""How many evaluations on the real engine until a calibration meets its targets, beside the baselines.

    tests/studies/recovery/recover.py --program build/repose --folder results --case synthetic --seeds 3

synthetic  six observables of four experiments, five free parameters; the targets are means of the
           engine's own runs at a truth that no method is told
soybean    bulk density, angle of repose and restitution of the worked example
laboratory all twelve observables of the seven experiments, drop and drum under two conditions, eight free
           parameters: what the worked example ties to the grains is free at the walls

A calibration has solved its study where sixteen fresh runs at the set it recommends are, on average, within one
standard error of every target. Targets and judges scatter, so the truth itself need not solve its study: it is
judged alike, as the method "truth" (synthetic and laboratory): about what a calibration can reach. Each result is a
line of FOLDER/CASE.jsonl, so an interrupted run is taken up where it was; the table is printed again each time.
"""
import argparse, json, math, pathlib, random, statistics, subprocess, sys

SOURCE = pathlib.Path(__file__).resolve().parents[3]
PAIR = ["grain", "grain"]
# Standard errors of a careful laboratory, absolute, or relative where below zero.
SYNTHETIC = [("tilting_box", "static_angle", "deg", 1.0), ("tilting_box", "onset_angle", "deg", 1.5),
             ("heap", "heap_angle", "deg", 1.0), ("compression", "secant_modulus", "MPa", -0.05),
             ("compression", "residual_strain_ratio", "1", 0.02), ("drop", "restitution", "1", 0.02)]
LABORATORY = [*SYNTHETIC, ("kettle", "bulk_density", "kg/m3", 7.0),
              ("draw_down", "discharge_rate", "kg/(s m)", -0.03), ("draw_down", "drain_angle", "deg", 1.5),
              ("drum", "dynamic_angle", "deg", 1.0), ("drum", "dynamic_angle", "deg", 1.0, "speed", 30, "rpm"),
              ("drop", "restitution", "1", 0.02, "height", 50, "mm")]


def run(program, *arguments, text=None):
    done = subprocess.run([program, *arguments], input=text, capture_output=True, text=True)
    if done.returncode not in (0, 3):
        sys.exit(f"{' '.join(arguments)}: {done.stderr}")
    return json.loads(done.stdout)


def example():
    return json.loads((SOURCE / "schemas/examples/valid/boac2010-soybean.json").read_text())


def name_of(parameter):
    return parameter["field"] + ":" + "-".join(parameter["between"])


def place_of(measurement):
    """Where it was measured: the experiment and its conditions."""
    conditions = ((n, s["value"], s["unit"]) for n, s in measurement.get("settings", {}).items()
                  if isinstance(s, dict))
    return measurement["experiment"], tuple(sorted(conditions))


def observe(program, study, values, first_seed, count):
    """Means over `count` seeds of every measurement's observable, in its unit, at one parameter set."""
    means = {}
    for experiment, conditions in sorted({place_of(m) for m in study["measurements"]}):
        settings = [f"--setting={name}={value}{unit}" for name, value, unit in conditions]
        unit = {p["field"]: p["unit"] for p in study["free"]}
        sets = [f"--set={key}={value!r} {unit[key.split(':')[0]]}" for key, value in values.items()]
        path = pathlib.Path(args.folder) / "study.json"
        path.write_text(json.dumps(study))
        answer = run(program, "evaluate", experiment, "--study", str(path), "--fidelity",
                     study["budget"]["fidelity"], "--seed", str(first_seed), "--replicates", str(count),
                     "--json", *sets, *settings)
        for o in answer["observations"]:
            means[(experiment, conditions), o["name"]] = (o["value"], o["unit"])
    return means


def soybean(program, seed):
    study = example()
    study["seed"] = seed
    return study


def truth_of(study, seed):
    """In the middle eight tenths of every range."""
    draw = random.Random(seed)
    truth = {}
    for p in study["free"]:
        u = draw.uniform(0.1, 0.9)
        low, high = p["lower"], p["upper"]
        truth[name_of(p)] = low * (high / low) ** u if p.get("scale") == "log" else low + u * (high - low)
    return truth


def measured(program, study, seed, observed):
    """The targets are means of eight runs at the truth."""
    study["seed"] = seed
    study["measurements"] = [{"experiment": e, "observable": o, "value": 1, "unit": unit, "standard_error": 1,
                              **({"settings": {condition[0]: dict(zip(("value", "unit"), condition[1:]))}}
                                 if condition else {})} for e, o, unit, _, *condition in observed]
    study["budget"]["fidelity"] = "draft"
    means = observe(program, study, truth_of(study, seed), 900001, 8)
    for m, (_, _, _, error, *_) in zip(study["measurements"], observed):
        m["value"], m["unit"] = means[place_of(m), m["observable"]]
        m["standard_error"] = error if error > 0 else -error * m["value"]
    return study


def synthetic(program, seed):
    return measured(program, example(), seed, SYNTHETIC)


def laboratory(program, seed):
    study = example()
    free = {p["field"]: p for p in study["free"]}
    for tie in study.pop("tied"):
        wide = free[tie["field"]]
        study["free"].append({**wide, "between": tie["between"], "lower": wide["lower"] * tie["factor"],
                              "upper": wide["upper"] * tie["factor"]})
    return measured(program, study, seed, LABORATORY)


def judged(program, study, values, result):
    """The result with its standardised residuals: of fresh runs, in standard errors of the measurements."""
    means = observe(program, study, values, 800001, 16)
    z = {" ".join(map(str, (m["experiment"], *place_of(m)[1], m["observable"]))):
         (means[place_of(m), m["observable"]][0] - m["value"]) / m["standard_error"]
         for m in study["measurements"]}
    return dict(result, z=z, solved=all(abs(x) <= 1 for x in z.values()))


def solve(program, case, seed, method):
    path = pathlib.Path(args.folder) / f"{case}-{seed}.json"
    if not path.exists():
        study = CASES[case](program, seed)
        path.write_text(json.dumps(study))
    study = json.loads(path.read_text())
    if method == "truth":
        return judged(program, study, truth_of(study, seed),
                      {"seed": seed, "method": method, "evaluations": 0, "learnt": 0})
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
    return judged(program, study, best, result)


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


CASES = {"synthetic": synthetic, "soybean": soybean, "laboratory": laboratory}


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--program", default=str(SOURCE / "build/repose"))
    parser.add_argument("--folder", default=".")
    parser.add_argument("--case", choices=list(CASES), default="synthetic")
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--methods", default="repose,cma_es,filter")
    parser.add_argument("--evaluations", type=int, default=40)
    args = parser.parse_args()
    if args.case == "soybean" and "truth" in args.methods.split(","):
        parser.error("--methods: the soybean's targets are measured, so that nobody knows their truth")
    pathlib.Path(args.folder).mkdir(parents=True, exist_ok=True)
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
