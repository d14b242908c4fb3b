"""Reads the frames of a run with MDAnalysis and ASE and compares them with the file's own numbers.

Argument: the directory of a run."""
import sys
import warnings

import numpy as np

warnings.filterwarnings("ignore")
import ase.io  # noqa: E402
import MDAnalysis  # noqa: E402


def frames_of(path):
    """Columns by name, one dictionary for each frame, read here without any library."""
    frames = []
    with open(path) as file:
        for line in file:
            if line.startswith("ITEM: NUMBER OF ATOMS"):
                count = int(next(file))
            elif line.startswith("ITEM: ATOMS"):
                names = line.split()[2:]
                values = np.array([next(file).split() for _ in range(count)], dtype=float)
                frames.append(dict(zip(names, values.T)))
    return frames


def check(name, found, wanted, tolerance):
    worst = np.max(np.abs(np.asarray(found) - np.asarray(wanted)))
    assert worst <= tolerance, f"{name}: off by {worst}"


path = sys.argv[1] + "/frames.lammpstrj"
own = frames_of(path)
assert len(own) > 1, "a run has more than one frame"

universe = MDAnalysis.Universe(path, format="LAMMPSDUMP", topology_format="LAMMPSDUMP")
assert len(universe.trajectory) == len(own), "MDAnalysis misses frames"
for ts, frame in zip(universe.trajectory, own):
    # Its positions are relative to the corner of the box, in single precision.
    low = frame["x"][0] - ts.positions[0, 0]
    check("MDAnalysis, x", ts.positions[:, 0] + low, frame["x"], 1e-4)
    check("MDAnalysis, distance", np.linalg.norm(ts.positions[1] - ts.positions[0]),
          np.linalg.norm([frame[c][1] - frame[c][0] for c in "xyz"]), 1e-4)

images = ase.io.read(path, format="lammps-dump-text", units="nano", index=":")
assert len(images) == len(own), "ASE misses frames"
for atoms, frame in zip(images, own):
    check("ASE, positions", atoms.get_positions()[:, 2] / 10, frame["z"], 1e-6)  # its lengths are in Angstrom
    for column in ("c_tube", "c_time_ps", "c_bond_energy_eV", "c_vdw_energy_eV", "c_bending_moment_eV"):
        assert column in atoms.arrays, f"ASE drops {column}; it has {sorted(atoms.arrays)}"
        check("ASE, " + column, atoms.arrays[column].ravel(), frame[column], 1e-9)
print(f"{len(own)} frames")
