#!/usr/bin/env python3
"""Ends of runs with several kinds of friction: ropes.py twisted CAMPAIGN > twisted-ropes.csv; ropes.py loops CAMPAIGN > loops.csv;
ropes.py transfers CAMPAIGN > transfers.csv"""

import csv
import json
import os
import sys

question, campaign = sys.argv[1], sys.argv[2]


def friction_of(point):
    text = point["friction"]
    if text == "[]":
        return "viscosity " + point["damping.contact_viscosity_eV_ps_per_nm2"]
    tubes = "unlike" if "17-0" in text else "like"
    return f"dry, {tubes} tubes" if "dry" in text else f"corrugation, {tubes} tubes"


if question == "twisted":
    print("length_nm,friction,beta_deg,geometric_twist_deg,Q,void_area_nm2,kinetic_eV,dissipated_eV,damping_eV,friction_slip_eV")
elif question == "transfers":
    print("friction,force_nN,work_nN,damping_nN,friction_slip_nN")
else:
    print("rate_deg_per_ps,friction,put_in_eV,lost_eV,damping_eV,friction_slip_eV,kinetic_eV")
for point in csv.DictReader(open(os.path.join(campaign, "table.csv"), encoding="utf-8")):
    if question == "twisted":
        print(point["rope.length_nm"], f'"{friction_of(point)}"',
              *(f"{float(point[k]):.6g}" for k in ("beta_deg", "geometric_twist_deg", "Q", "void_area_nm2", "kinetic_eV",
                                                   "dissipated_eV", "damping_eV", "friction_slip_eV")), sep=",")
        continue
    log = csv.DictReader(open(os.path.join(campaign, "points", point["point"], "log.csv"), encoding="utf-8"))
    if question == "transfers":
        # Over the second half of the way, 1 nm.
        rows = [{k: float(r[k]) for k in ("tension_lower_nN", "work_eV", "damping_eV", "friction_slip_eV")} for r in log]
        rows = rows[len(rows) // 2:]
        print(f'"{friction_of(point)}"', f"{sum(r['tension_lower_nN'] for r in rows) / len(rows):.2f}",
              *(f"{0.1602176634 * (rows[-1][k] - rows[0][k]):.3g}" for k in ("work_eV", "damping_eV", "friction_slip_eV")), sep=",")
        continue
    put_in = max(float(row["work_eV"]) for row in log)
    turn = json.loads(point["grip.1.about_z.rotation_deg"])[1]
    print(f"{turn[1] / turn[0]:g}", f'"{friction_of(point)}"', f"{put_in:.1f}",
          *(f"{float(point[k]):.4g}" for k in ("dissipated_eV", "damping_eV", "friction_slip_eV", "kinetic_eV")), sep=",")
