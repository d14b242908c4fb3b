#!/usr/bin/env python3
"""Forces of a pull-out campaign, means over the last three quarters of the way: forces.py CAMPAIGN > pull-outs.csv"""

import csv
import os
import re
import sys

EV_PER_NM = 0.1602176634  # nN

print("around,length_nm,speed_m_per_s,force_nN,work_nN,binding_nN,damping_nN,least_nN,most_nN")
for point in csv.DictReader(open(os.path.join(sys.argv[1], "table.csv"), encoding="utf-8")):
    log = list(csv.DictReader(open(os.path.join(sys.argv[1], "points", point["point"], "log.csv"), encoding="utf-8")))
    rows = [{k: float(r[k]) for k in ("time_ps", "tension_lower_nN", "tension_upper_nN", "work_eV", "vdw_eV", "damping_eV")}
            for r in log]
    rows = [r for r in rows if r["time_ps"] > 0.25 * rows[-1]["time_ps"]]
    speed = float(re.search(r"rate_nm_per_ps = ([0-9.]+)", point["grip.1.z"]).group(1))
    way = speed * (rows[-1]["time_ps"] - rows[0]["time_ps"])
    per_way = {k: EV_PER_NM * (rows[-1][k] - rows[0][k]) / way for k in ("work_eV", "vdw_eV", "damping_eV")}
    upper = [r["tension_upper_nN"] for r in rows]
    around = "17,0" if "1" in point["tube_types"] else "10,10"
    print(f'"{around}"', point["rope.length_nm"], f"{1000 * speed:g}",
          f"{sum(r['tension_lower_nN'] for r in rows) / len(rows):.4f}", f"{per_way['work_eV']:.4f}",
          f"{per_way['vdw_eV']:.4f}", f"{per_way['damping_eV']:.4f}", f"{min(upper):.3f}", f"{max(upper):.3f}", sep=",")
