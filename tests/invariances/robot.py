#!/usr/bin/env python3
"""Says each of many scenes in two ways that mean the same physics, and compares what comes out.

    tests/invariances/robot.py ROPEWALK                a tenth of all pairs of scene and transformation, seeds fixed
    tests/invariances/robot.py ROPEWALK --all          all pairs, with random numbers of the day
    tests/invariances/robot.py ROPEWALK --all --seed 20260101 --scene rope --transformation mirror
    tests/invariances/robot.py ROPEWALK --all --seed 20260101 --in FOLDER    again, it goes on where it was cut off

The tenth is that of the number in .ci/turn, or of --tenth. Ends with 1 where something was found.
docs/how-to/invariance.md says how to add a transformation.
"""
import argparse
import csv
import datetime
import importlib
import pathlib
import shutil
import sys
import tempfile
import time
import traceback

sys.dont_write_bytecode = True
from bench import Bench, Differs, HERE, Skip  # noqa: E402
from transformations.common import TRANSFORMATIONS  # noqa: E402

for module in sorted((HERE / "transformations").glob("*.py")):
    importlib.import_module(f"transformations.{module.stem}")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="ropewalk in its build folder")
    parser.add_argument("--all", action="store_true", help="all pairs; without --seed by the date of today")
    parser.add_argument("--tenth", type=int, help="which tenth of the pairs, 0 to 9")
    parser.add_argument("--seed", help="of all random numbers [default: 1]")
    parser.add_argument("--scene", default="", help="only scenes with this in their names")
    parser.add_argument("--transformation", default="", help="only transformations with this in their names")
    parser.add_argument("--in", dest="folder", help="work in this folder and keep it; verdicts are in its results.csv, and pairs that stand there are not run again")
    parser.add_argument("--list", action="store_true", help="list the transformations")
    return parser.parse_args()


def judge(bench, kind, name, seed):
    """"held", "found" or "skipped", and the words to that."""
    try:
        TRANSFORMATIONS[name](bench.case(kind, name, seed))
    except Skip as why:
        return "skipped", str(why)
    except Differs as what:
        return "found", str(what)
    except Exception as e:  # a fault of this program, or an answer that it does not understand
        place = traceback.extract_tb(e.__traceback__)[-1]
        return "found", f"{type(e).__name__}: {e} ({place.name}, line {place.lineno})"
    return "held", ""


def read_results(path, seed):
    """Verdicts of an earlier call with this seed, by scene and transformation."""
    if not path.exists():
        return {}
    with path.open(newline="") as file:
        return {(row[1], row[2]): (row[3], row[4]) for row in csv.reader(file) if len(row) == 5 and row[0] == seed}


def print_matrix(results, kinds, names):
    mark = {"held": ".", "found": "F", "skipped": "-"}
    print("\n. held   F found   - skipped\n")
    for number, name in enumerate(names):
        print(f"{number:3} {name}")
    width = max(map(len, kinds))
    print("\n" + " " * width + "  " + " ".join(f"{number:2}" for number in range(len(names))))
    for kind in kinds:
        marks = (mark[results[kind, name][0]] if (kind, name) in results else " " for name in names)
        print(f"{kind:{width}}  " + " ".join(f" {m}" for m in marks))


def print_reasons(results):
    reasons = {}
    for (kind, name), (verdict, words) in results.items():
        if verdict == "skipped":
            reasons.setdefault((name, words), []).append(kind)
    print("\nSkipped:")
    for (name, words), kinds in sorted(reasons.items()):
        print(f"  {name}: {words}: {', '.join(kinds)}")


def main():
    a = arguments()
    if a.list:
        for name, function in TRANSFORMATIONS.items():
            print(f"{name}: {function.__doc__}")
        return 0
    seed = a.seed or (datetime.date.today().strftime("%Y%m%d") if a.all else "1")
    tenth = a.tenth if a.tenth is not None else int((HERE.parent.parent / ".ci" / "turn").read_text()) % 10
    folder = pathlib.Path(a.folder or tempfile.mkdtemp(prefix="ropewalk-invariances-"))
    folder.mkdir(parents=True, exist_ok=True)
    try:
        bench, began = Bench(a.program, folder), time.time()
        kinds = [kind for kind in bench.scenes if a.scene in kind]
        names = [name for name in TRANSFORMATIONS if a.transformation in name]
        # Every tenth has all scenes and all transformations.
        order = {name: k for k, name in enumerate(TRANSFORMATIONS)}
        place = {kind: k for k, kind in enumerate(bench.scenes)}
        pairs = [(kind, name) for kind in kinds for name in names
                 if a.all or (3 * place[kind] + order[name]) % 10 == tenth]
        print(f"{len(pairs)} pairs, seed {seed}" + ("" if a.all else f", tenth {tenth}"), flush=True)
        kept = read_results(folder / "results.csv", str(seed))
        results = {}
        with (folder / "results.csv").open("a", newline="") as file:
            for kind, name in pairs:
                results[kind, name] = verdict, words = kept.get((kind, name)) or judge(bench, kind, name, seed)
                if (kind, name) not in kept:
                    csv.writer(file).writerow([seed, kind, name, verdict, " ".join(words.split())])
                    file.flush()
                if verdict == "found":
                    print(f"found: {kind}, {name}: {words}", flush=True)
    finally:
        if not a.folder:
            shutil.rmtree(folder, ignore_errors=True)
    print_matrix(results, kinds, names)
    print_reasons(results)
    count = {v: sum(r[0] == v for r in results.values()) for v in ("held", "found", "skipped")}
    print(f"\n{len(pairs)} pairs: {count['held']} held, {count['found']} found, {count['skipped']} skipped; "
          f"seed {seed}, {time.time() - began:.0f} s")
    if a.all and not (a.scene or a.transformation) and 3 * count["skipped"] > len(pairs):
        print("More than a third of the pairs are skipped.")
        return 1
    return 1 if count["found"] else 0


sys.exit(main())
