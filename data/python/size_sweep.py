#!/usr/bin/env python3
"""A sweep: ropes of 1, 7 and 19 tubes and two lengths, turned by 30 degrees. Which torque does a tube take?

    python3 size_sweep.py [FOLDER]      # some seconds; started again it goes on where it was
"""
import os
import sys

import ropewalk

folder = sys.argv[1] if len(sys.argv) > 1 else "size-sweep"
rope = ropewalk.Scene({
    "parameters": "cnt-10-10-tersoff",
    "rope": {"tubes": 7, "length_nm": 20},
    "grip": [
        {"end": "lower", "tilt_free": True},
        {"end": "upper", "tilt_free": True, "about_z": {"rotation_deg": [[0, 0], [20, 30]]}},
    ],
    "run": {"log_every_ps": 0.5, "duration_ps": 30},
})
campaign = ropewalk.sweep(
    rope,
    {"rope.tubes": [1, 7, 19], "rope.length_nm": [14, 28]},
    os.path.join(folder, "campaign"),
)

# The table has a row for each point: here means over the last 5 ps.
table = ropewalk.gather(campaign, mean_ps=5, columns=["torque_upper_nN_nm", "stored_MJ_per_kg"])
print("tubes  length nm  nN nm per tube   MJ/kg")
for tubes, length, torque, stored in zip(*(table[name] for name in ("rope.tubes", "rope.length_nm",
                                                                   "torque_upper_nN_nm", "stored_MJ_per_kg"))):
    print(f"{tubes:5.0f} {length:10.0f} {torque / tubes:15.2f} {stored:7.4f}")

# Every point is a run of its own.
for name, run in campaign.runs.items():
    passed = [limit["key"] for limit in run.limits if limit["passed"]]
    print(f"{name}: {run.status}, {len(run.frames)} frames, limits passed: {', '.join(passed) or 'none'}")
