#!/usr/bin/env python3
"""Holds the sources to one place that makes teams of threads: mdem/sim/threads/for_each.hpp, which makes none for one thread.

    tests/structure/threads.py SOURCE_DIR

GCC's OpenMP makes a team of one thread where an if clause is false, and asks the kernel at each of its barriers.
"""
import re
import sys
from pathlib import Path

TEAM = re.compile(r"^\s*#\s*pragma\s+omp\s+(?:parallel|teams|target|task)\b|\b_Pragma\(\s*\"\s*omp\s+parallel", re.M)
# The peak of the machine is measured by every thread, once.
PLACES = {"mdem/sim/threads/for_each.hpp": 3}


def main():
    source = Path(sys.argv[1])
    wrong = []
    for path in sorted(p for folder in ("mdem", "calibrate", "validate") for p in (source / folder).rglob("*")):
        if path.suffix not in (".hpp", ".cpp", ".h"):
            continue
        name, text = path.relative_to(source).as_posix(), path.read_text()
        found = [text.count("\n", 0, at.start()) + 1 for at in TEAM.finditer(text)]
        if name in PLACES and len(found) != PLACES[name]:
            wrong.append(f"{name} makes teams in {len(found)} places, not in {PLACES[name]}")
        if name not in PLACES:
            wrong += [f"{name}:{line}: take for_each(), for_each_uneven() or in_team() of sim/threads/for_each.hpp" for line in found]
    print(*wrong, sep="\n", file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
