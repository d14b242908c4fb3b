#!/usr/bin/env python3
"""The table of convergence in data/scenes/README.md: torque and tension of 19 tubes turned by 100 degrees, one thing changed in each row.

    python3 convergence.py FOLDER        # two minutes; `ropewalk` must be on the PATH
"""
import csv
import os
import subprocess
import sys

SCENE = """format = "ropewalk-scene-1"
parameters = "cnt-10-10-tersoff"
{top}
[rope]
tubes = 19
length_nm = {length}
{rope}
[contact]
{contact}
[damping]
contact_viscosity_eV_ps_per_nm3 = 26.494399169187087
[start]
seed = {seed}
[[grip]]
end = "lower"
[[grip]]
end = "upper"
about_z = {{ rotation_deg = [[0, 0], [{turn}, 100], [{all:g}, 100]] }}
[run]
duration_ps = {all:g}
log_every_ps = {every:g}
{run}
"""
DEFAULT = dict(top="", length=67.8, rope="", contact="", seed=1, turn=200, run="")


def elements(length, rope):
    """Elements of another length; the free length stays."""
    return dict(top=f"element_length_nm = {length}", length=rope)


ROWS = {
    "default": {},
    "elements of 2.76 nm": elements(2.75518, 67.8),
    "elements of 0.69 nm": elements(0.68879, 66.81),
    "elements of 0.34 nm": elements(0.344397, 66.47),
    "3 nodes": dict(contact="nodes_per_element = 3"),
    "8 nodes": dict(contact="nodes_per_element = 8"),
    "cutoff 2.2 nm": dict(contact="cutoff_nm = 2.2"),
    "cutoff 2.0 nm": dict(contact="cutoff_nm = 2.0"),
    "half the time step": dict(run="time_step_fs = 22.107"),
    "double precision": dict(contact='precision = "double"'),
    "turned in 100 ps": dict(turn=100),
    "turned in 400 ps": dict(turn=400),
    "turned in 800 ps": dict(turn=800),
    **{f"displaced, seed {k}": dict(rope="perturbation_nm = 0.01", seed=k) for k in (1, 2, 3)},
}


def mean(rows, column):
    """Of both ends, and half their difference."""
    ends = [(float(r[f"{column}_upper_{UNIT[column]}"]), float(r[f"{column}_lower_{UNIT[column]}"])) for r in rows]
    return sum(a + b for a, b in ends) / len(ends) / 2, sum(abs(a - b) for a, b in ends) / len(ends) / 2


UNIT = {"torque": "nN_nm", "tension": "nN"}

os.makedirs(sys.argv[1], exist_ok=True)
os.chdir(sys.argv[1])
print("| | 20° | 50° | 80° | at rest, 100° | tension, nN |\n|---|---|---|---|---|---|")
for name, changes in ROWS.items():
    values = {**DEFAULT, **changes}
    values.update(all=1.15 * values["turn"], every=values["turn"] / 200)
    with open("scene.toml", "w") as scene:
        scene.write(SCENE.format(**values))
    subprocess.run(["ropewalk", "run", "scene.toml", "--out", "run", "--force", "--quiet"], check=True,
                   stdout=subprocess.DEVNULL)
    with open("run/log.csv") as log:
        rows = list(csv.DictReader(log))
    turning = [r for r in rows if float(r["time_ps"]) <= 1.0001 * values["turn"]]
    parts = [[r for r in turning if abs(float(r["rotation_deg"]) - angle) <= 3] for angle in (20, 50, 80)]
    parts.append([r for r in rows if float(r["time_ps"]) > 1.01 * values["turn"]])
    cells = ["{:.2f} ({:.2f})".format(*mean(part, "torque")) for part in parts]
    print(f"| {name} | " + " | ".join(cells) + f" | {mean(rows[-20:], 'tension')[0]:.2f} |", flush=True)
