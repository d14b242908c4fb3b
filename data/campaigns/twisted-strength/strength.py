#!/usr/bin/env python3
"""Strength by the angle of the outermost tubes before the pull: strength.py CAMPAIGN > strength.csv"""

import csv
import math
import os
import sys

pulled_from = 80  # ps
breaks_at = 1.16  # stretch, by [failure] of rope.toml

print("rotation_deg,beta_deg,strength_GPa,specific_strength_N_per_tex,strain,first_break_strain,theory_strain")
for point in csv.DictReader(open(os.path.join(sys.argv[1], "table.csv"), encoding="utf-8")):
    path = os.path.join(sys.argv[1], "points", point["point"], "log.csv")
    rows = [{k: float(v) for k, v in r.items()} for r in csv.DictReader(open(path, encoding="utf-8"))]
    before = next(r for r in rows if r["time_ps"] >= pulled_from)
    most = max(rows, key=lambda r: r["stress_GPa"])
    broken = next(r for r in rows if r["bonds_broken"] > 0)
    print(f"{before['rotation_deg']:.1f},{before['beta_deg']:.2f},{most['stress_GPa']:.2f},"
          f"{most['specific_stress_N_per_tex']:.2f},{most['ends_strain']:.4f},{broken['ends_strain']:.4f},"
          f"{math.sqrt(breaks_at ** 2 - math.tan(math.radians(before['beta_deg'])) ** 2) - 1:.4f}")
