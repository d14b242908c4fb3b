#!/usr/bin/env python3
"""A rope of seven tubes between two discs, twisted by 75 degrees: its torque against the rotation.

    python3 twisted_rope.py [FOLDER]    # some seconds; draws torque.png where matplotlib is installed
"""
import os
import sys

import numpy as np

import ropewalk

folder = sys.argv[1] if len(sys.argv) > 1 else "twisted-rope"
scene = ropewalk.Scene({
    "parameters": "cnt-10-10-tersoff",
    "rope": {"tubes": 7, "length_nm": 27},
    "grip": [
        {"end": "lower", "tilt_free": True},
        {"end": "upper", "tilt_free": True, "about_z": {"rotation_deg": [[0, 0], [60, 75]]}},
    ],
    "run": {"log_every_ps": 1, "frames_every_ps": 10},
})
print(f"{scene.tubes} tubes, {scene.elements} elements, {scene.duration_ps:g} ps in steps of {scene.time_step_fs:.1f} fs")

run = ropewalk.run(scene, os.path.join(folder, "run"), force=True)
rotation, torque = run.log["rotation_deg"], run.log["torque_upper_nN_nm"]
for degrees in (15, 30, 45, 60, 75):
    print(f"{degrees:4} deg {np.interp(degrees, rotation, torque):8.1f} {run.log.units['torque_upper_nN_nm']}")

# The tubes' own torsion, seven times GJ/L, and what the rope adds.
early = (rotation > 20) & (rotation < 60)
slope = np.polyfit(np.radians(rotation[early]), torque[early], 1)[0]
own = 7 * ropewalk.ParameterSet("cnt-10-10-tersoff")["bond.GJ"].value / run.log["ends_apart_nm"][0]
print(f"{slope:.0f} nN nm per radian; the torsion of seven single tubes is {own:.0f}")

# Frames: where the rope bends most at the end.
last = run.frames[-1]
tube, element = np.unravel_index(np.argmax(last.bending_moment), last.bending_moment.shape)
print(f"at {last.time_ps:g} ps tube {tube} bends most, at z = {last.position[tube, element, 2]:.1f} nm")
run.log.to_npz(os.path.join(folder, "log.npz"))

try:
    import matplotlib
except ImportError:
    sys.exit()
matplotlib.use("Agg")
from matplotlib import pyplot

pyplot.plot(rotation, torque)
pyplot.xlabel("rotation (degrees)")
pyplot.ylabel("torque on the upper end (nN nm)")
pyplot.savefig(os.path.join(folder, "torque.png"), dpi=150)
