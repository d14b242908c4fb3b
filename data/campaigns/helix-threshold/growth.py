#!/usr/bin/env python3
"""Growth rates (1/ns) from what growth.sh leaves in the present directory."""
import csv
import math
from pathlib import Path


def rows(path):
    with open(path) as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def line(run):
    return [(float(r["time_ps"]), float(r["middle_amplitude_nm"])) for r in rows(Path(run) / "log.csv")]


def amplitude_at(points, time):
    for (t, a), (u, b) in zip(points, points[1:]):
        if t <= time <= u:
            return math.exp(math.log(a) + math.log(b / a) * (time - t) / (u - t))
    raise ValueError(f"no row at {time} ps")


def fitted(points, low, high):
    """Least squares of the logarithm, in the last rise from low to high."""
    end = next(k for k, (_, a) in enumerate(points) if a > high)
    begin = end
    while begin > 0 and points[begin - 1][1] > low:
        begin -= 1
    part = [(t, math.log(a)) for t, a in points[begin:end]]
    t0, a0 = (sum(column) / len(part) for column in zip(*part))
    return 1e3 * sum((t - t0) * (a - a0) for t, a in part) / sum((t - t0) ** 2 for t, _ in part)


def apart(one, other):
    return math.sqrt(sum((float(a[c]) - float(b[c])) ** 2 for a, b in zip(rows(one), rows(other))
                         for c in ("x_nm", "y_nm", "z_nm")))


for scene in sorted(Path().glob("straight-*.toml")):
    name = scene.stem.removeprefix("straight-")
    times = sorted(int(p.stem.rsplit("-", 1)[1]) for p in Path().glob(f"straight-{name}-*.csv"))
    eigen = [float(rows(f"straight-{name}-{t}.csv")[0]["rate_per_ns"]) for t in times]
    mean = sum((a + b) / 2 * (u - t) for a, b, t, u in zip(eigen, eigen[1:], times, times[1:])) / (times[-1] - times[0])
    path = line(f"straight-{name}")
    seen = 1e3 * math.log(amplitude_at(path, times[-1]) / amplitude_at(path, times[0])) / (times[-1] - times[0])
    print(f"{name}: eigenvalues {[round(x, 1) for x in eigen]} at {times} ps, mean {mean:.1f}; the run {seen:.1f}; "
          f"from a wave {fitted(line(f'wave-{name}'), 0.3, 1):.1f}")
    for time, rate in zip(times, eigen):
        still, moved = (f"moved-{name}-{time}-{far}" for far in ("1e-9", "0.02"))
        ahead = 1e3 * math.log(apart(f"{still}/final.csv", f"{moved}/final.csv")
                               / apart(f"{still}.csv", f"{moved}.csv")) / 10
        print(f"  {time} ps: eigenvalue {rate:.1f}, two runs part by {ahead:.1f} in 10 ps")
