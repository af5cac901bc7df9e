#!/usr/bin/env python3
"""The whole story of a study on one page: calibrate, compare, diagnose, extend, compare.

  tests/hidden/transcript.py STUDY.json [--draft] [--evaluations N] [--workers N] [--out FILE]

Prints every command with what it answered. The effect that is added is the one that the diagnosis
puts in front; where it names none, the story ends there. --draft searches in drafts and confirms at
standard, so that the drafts' bias is learnt and carried. Runs are kept in --db: an interrupted story
goes on where it was.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]


class Story:
    def __init__(self, repose, database, workers, out):
        self.repose, self.database, self.workers, self.out = repose, database, workers, out

    def tell(self, text=""):
        print(text, file=self.out, flush=True)

    def run(self, *words, shown=True):
        """The answer; told with its command unless it is for us alone."""
        started = time.time()
        done = subprocess.run([str(self.repose), *map(str, words), "--db", str(self.database)],
                              stdout=subprocess.PIPE, text=True, check=False)
        if shown:
            self.tell(f"$ repose {' '.join(map(str, words))}\n\n{done.stdout}"
                      f"[{time.time() - started:.0f} s, exit {done.returncode}]\n")
        if done.returncode != 0:
            sys.exit(f"repose {words[0]} gave up: exit {done.returncode}")
        return done.stdout

    def newest(self):
        return max(item["id"] for item in json.loads(self.run("list", "--json", shown=False))["items"])


def study_of(asked, folder):
    study = json.loads(asked.study.read_text())
    if asked.draft:
        study["budget"].update(fidelity="draft", confirm_fidelity="standard")
    if asked.evaluations:
        study["budget"]["evaluations"] = asked.evaluations
    path = folder / asked.study.name
    path.write_text(json.dumps(study, indent=1))
    return path


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("study", type=pathlib.Path)
    parser.add_argument("--draft", action="store_true")
    parser.add_argument("--evaluations", type=int)
    parser.add_argument("--workers", type=int, default=1)
    parser.add_argument("--repose", type=pathlib.Path, default=ROOT / "build/repose")
    parser.add_argument("--db", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path, help="default: beside the study, .txt")
    parser.add_argument("--most", type=int, default=3, help="effects added in turn")
    asked = parser.parse_args()
    folder = ROOT / "build/hidden"
    folder.mkdir(parents=True, exist_ok=True)
    database = asked.db or folder / f"{asked.study.stem}.db"
    out = asked.out or asked.study.with_suffix(".txt")
    with out.open("w") as file:
        story = Story(asked.repose.resolve(), database, asked.workers, file)
        story.tell(f"{asked.study.name}; {os.cpu_count()} processors, load "
                   f"{os.getloadavg()[0]:.1f} at the start\n")
        plain = ["--workers", asked.workers, "--no-pictures", "--report", folder / "report.html"]
        story.run("calibrate", study_of(asked, folder), *plain)
        at = story.newest()
        story.run("compare", at)
        for _ in range(asked.most):
            story.run("diagnose", at, "--workers", asked.workers)
            told = json.loads(story.run("diagnose", at, "--workers", asked.workers, "--json",
                                        shown=False))["result"]
            if told["verdict"] not in ("named", "family", "pair"):
                break
            for effect in told["refits"][0]["effects"]:
                story.run("extend", at, "--effect", effect["name"], *plain)
                at = story.newest()
            story.run("compare", at)


if __name__ == "__main__":
    main()
