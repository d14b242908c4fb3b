"""Reads the frames of a run, GSD and dump, with gsd, MDAnalysis and ASE and compares them with the file's own numbers.

Argument: the directory of a run."""
import sys
import warnings

import numpy as np

warnings.filterwarnings("ignore")
import ase.io  # noqa: E402
import gsd.hoomd  # noqa: E402
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
trajectory = gsd.hoomd.open(sys.argv[1] + "/frames.gsd", "rb")
universe = MDAnalysis.Universe(sys.argv[1] + "/frames.gsd")
assert len(trajectory) == len(universe.trajectory) == len(own), "frames are missing"
tubes = int(own[0]["mol"].max())
assert len(universe.bonds) == universe.atoms.n_atoms - tubes, "MDAnalysis misses bonds"
for k, (snapshot, frame) in enumerate(zip(trajectory, own)):
    at = {int(e) - 1: row for row, e in enumerate(frame["id"])}
    order = [at[e] for e in range(snapshot.particles.N)]
    column = {name: values[order] for name, values in frame.items()}
    assert snapshot.configuration.step == trajectory[k].configuration.step
    check("gsd, time", snapshot.log["time_ps"][0], column["c_time_ps"][0], 1e-9)
    check("gsd, tube", snapshot.particles.body + 1, column["mol"], 0)
    check("gsd, type", snapshot.particles.typeid + 1, column["type"], 0)
    check("MDAnalysis, positions", universe.trajectory[k].positions, snapshot.particles.position, 0)
    for c, axis in enumerate("xyz"):
        check("gsd, " + axis, snapshot.particles.position[:, c], column[axis], 1e-5)
    for c, name in enumerate(("c_orient[4]", "c_orient[1]", "c_orient[2]", "c_orient[3]")):
        check("gsd, " + name, snapshot.particles.orientation[:, c], column[name], 1e-6)
    for name in ("bond_energy_eV", "vdw_energy_eV", "bending_moment_eV", "twist_angle_rad"):
        values = snapshot.log["particles/" + name]
        check("gsd, " + name, values, column["c_" + name], 1e-5 * (1 + np.abs(values).max()))
    for c, kind in enumerate(np.unique(snapshot.particles.typeid)):  # the mesh is the tube
        mesh = np.array(snapshot.particles.type_shapes[kind]["vertices"])
        element = int(np.argmax(snapshot.particles.typeid == kind))
        check("gsd, radius", np.hypot(mesh[:, 0], mesh[:, 1]).max(), column["c_shape[1]"][element], 1e-3)
        check("gsd, length", np.ptp(mesh[:, 2]), column["c_shape[3]"][element], 1e-3)
print(f"{len(own)} frames")
