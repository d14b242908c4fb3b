#!/usr/bin/env python3
"""Joins the tables of several searches, which differ in the keys that vary: join.py RUNS THRESHOLDS.csv TRIALS.csv"""
import csv
import sys
from pathlib import Path

RENAMED = {"damping.contact_viscosity_eV_ps_per_nm2": "viscosity_eV_ps_per_nm2", "twist.hold_ps": "hold_ps",
           "rope.tubes": "tubes", "rope.length_nm": "length_nm"}
KEYS = ["search", "tubes", "length_nm", "viscosity_eV_ps_per_nm2", "hold_ps"]
SEARCHES = ["sizes-7", "sizes-19", "sizes-37", "sizes-61", "sizes-91", "viscosity", "wait-7", "wait-19"]


def join(runs, name, out):
    rows = []
    for search in SEARCHES:
        for row in csv.DictReader((runs / search / name).open()):
            row = {RENAMED.get(k, k): v for k, v in row.items()}
            rows.append({"search": search, "viscosity_eV_ps_per_nm2": "20", "hold_ps": "300", **row})
    columns = KEYS + [k for k in rows[0] if k not in KEYS]
    with open(out, "w", newline="") as file:
        writer = csv.DictWriter(file, columns, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


join(Path(sys.argv[1]), "thresholds.csv", sys.argv[2])
join(Path(sys.argv[1]), "trials.csv", sys.argv[3])
