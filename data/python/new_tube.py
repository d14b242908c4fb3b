#!/usr/bin/env python3
"""A new tube: calibrates (5,5) from its atoms, holds it against theory, and asks how strongly its ropes bind.

    python3 new_tube.py [FOLDER]        # a quarter of a minute; needs ropewalk-calibrate and LAMMPS
"""
import os
import sys

import ropewalk

folder = sys.argv[1] if len(sys.argv) > 1 else "new-tube"
os.makedirs(folder, exist_ok=True)

# Atoms -> parameter set. Every number has a unit and a standard error.
tube = ropewalk.calibrate((5, 5), os.path.join(folder, "cnt-5-5.toml"), force=True)
print(f"{tube.name}: {tube.grade}")
for name in ("tube.radius", "bond.EA", "bond.EI", "bond.GJ", "contact.line.pair_energy"):
    print(f"  {name:26} {tube[name]}")

# Does the model with this set keep to theory?
for case in ropewalk.validate(["euler-buckling", "wave-speeds"], parameters=tube, out=os.path.join(folder, "validation")):
    print(f"{case.name}: {case.verdict}")
    for check in case.checks:
        print(f"  {check.name:44} {check.value:10.5g} {check.unit:6} theory {check.reference:.5g}")

# A rope of it: relax it and read off how much energy holds a tube in the rope.
for tubes in (7, 19):
    rope = ropewalk.Simulation({"parameters": tube.path, "rope": {"tubes": tubes, "length_nm": 10},
                                "run": {"mode": "relax"}})
    rope.relax()
    print(f"{tubes} tubes: {rope.energies.vdw / tubes / 10:.3f} eV/nm hold a tube")
