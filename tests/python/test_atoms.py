"""Elements as atoms of ASE and MDAnalysis, and their atoms as elements."""
from __future__ import annotations

import csv
import pathlib
import unittest
import warnings
import weakref

import numpy as np
from support import ROPE, FolderTest

import ropewalk

try:
    import ase
    import ase.io
except ImportError:
    ase = None
try:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        import MDAnalysis
except ImportError:
    MDAnalysis = None

SMALL = {**ROPE, "parameters": "cnt-5-5-tersoff", "rope": {"tubes": 7, "length_nm": 7}}


class AtomsTest(FolderTest):
    def setUp(self) -> None:
        super().setUp()
        self.run_ = ropewalk.run(SMALL, "run")

    def assert_same_elements(self, frame: ropewalk.Frame, wanted: ropewalk.Frame) -> None:
        """Every element of `wanted` is in `frame`, in whatever tube."""
        self.assertEqual(len(frame.flat), len(wanted.flat))
        apart = np.linalg.norm(frame.flat.position[:, None] - wanted.flat.position[None], axis=2)
        self.assertLess(apart.min(axis=0).max(), 1e-3)
        axes = np.abs((frame.flat.axis[apart.argmin(axis=0)] * wanted.flat.axis).sum(axis=1))
        self.assertGreater(axes.min(), 1 - 1e-6)

    def test_atoms_surround_their_elements(self):
        frame = self.run_.frames[-1]
        atoms = ropewalk.atoms(frame)
        self.assertEqual(atoms.time_ps, frame.time_ps)
        per_length = ropewalk.ParameterSet("cnt-5-5-tersoff")["tube.atoms_per_length"].value
        self.assertAlmostEqual(len(atoms) / (per_length * frame.element_length_nm * len(frame.flat)), 1, delta=0.02)
        for tube, element in ((0, 1), (6, 3)):
            of_it = atoms.position[(atoms.tube == tube) & (atoms.element == element)]
            self.assertLess(np.linalg.norm(of_it.mean(axis=0) - frame.position[tube, element]), 0.08)
        again = ropewalk.atoms(frame, "cnt-5-5-tersoff")
        np.testing.assert_array_equal(again.position, atoms.position)
        np.testing.assert_array_equal(ropewalk.atoms(self.run_).position, atoms.position)
        file = ropewalk.atoms("run/final.csv", "cnt-5-5-tersoff")
        np.testing.assert_allclose(file.position, atoms.position, atol=1e-4)
        part = ropewalk.atoms(frame, tubes=[2], from_nm=2, to_nm=5)
        self.assertEqual(set(part.tube), {2})
        self.assertTrue(np.isin(part.position.round(9), atoms.position.round(9)).all())
        start = ropewalk.atoms(self.run_.scene)
        np.testing.assert_array_equal(ropewalk.atoms(ropewalk.Simulation(SMALL)).position, start.position)
        with self.assertRaisesRegex(TypeError, "parameter set"):
            ropewalk.atoms("run/final.csv")
        with self.assertRaisesRegex(ropewalk.InputError, "there is no tube 7"):
            ropewalk.atoms(frame, tubes=[7])

    def test_no_atoms_bridge_a_break(self):
        scene = ropewalk.Scene({
            "parameters": "cnt-5-5-tersoff", "chain": {"elements": 9}, "failure": {"strain": 0.05},
            "grip": [{"end": "lower"}, {"end": "upper", "z": {"displacement_nm": 3, "rate_nm_per_ps": 1}}],
            "run": {"frames_every_ps": 1}})
        frame = ropewalk.run(scene, "torn").frames[-1]
        simulation = ropewalk.Simulation(scene)
        simulation.step_until(frame.time_ps)
        radius = ropewalk.ParameterSet("cnt-5-5-tersoff")["tube.radius"].value
        for of in (frame, simulation):
            found = ropewalk.atoms(of)
            position = of.flat.position if of is frame else simulation.state.flat.position
            self.assertGreater(np.ptp(position[:, 2]), 8 * frame.element_length_nm + 2, "nm: the ends are apart")
            away = np.linalg.norm(found.position - position[found.element], axis=1)
            self.assertLess(away.max(), np.hypot(radius, 0.53 * frame.element_length_nm), "nm")

    def test_files_become_a_run(self):
        ropewalk.programs._call(["atoms", "run", "-o", "rope.data"])
        coarse = ropewalk.coarsen("rope.data", "coarse")
        self.assert_same_elements(coarse.frames[0], self.run_.frames[-1])
        rows = list(csv.DictReader(pathlib.Path("coarse/found-tubes.csv").read_text().splitlines()))
        self.assertEqual([(row["n"], row["m"], row["pentagons"]) for row in rows], [("5", "5", "0")] * 7)
        with self.assertRaisesRegex(ropewalk.InputError, "is not empty"):
            ropewalk.coarsen(["rope.data"], "coarse")
        ropewalk.coarsen(["rope.data"], "coarse", "cnt-5-5-tersoff", force=True)

    @unittest.skipUnless(ase, "ASE is not installed")
    def test_images_of_ase_become_a_run(self):
        alive, most = [], []

        def images():
            for frame in self.run_.frames:
                image = ropewalk.atoms(frame).to_ase()
                image.rattle(1e-4, seed=1)
                alive.append(weakref.ref(image))
                most.append(sum(ref() is not None for ref in alive))
                yield image

        coarse = ropewalk.coarsen(images(), "coarse")
        self.assertLessEqual(max(most), 3)  # the one that is read, the one before, and this
        self.assertEqual(len(coarse.frames), len(self.run_.frames))
        for frame, wanted in zip(coarse.frames, self.run_.frames):
            self.assertEqual(frame.time_ps, wanted.time_ps)
            self.assert_same_elements(frame, wanted)
        self.assertAlmostEqual(coarse.log["beta_deg"][-1], self.run_.log["beta_deg"][-1], delta=0.02)
        again = ropewalk.run({"parameters": "cnt-5-5-tersoff", "state": {"file": "coarse/final.csv"},
                              "run": {"duration_ps": 0.1}}, "again")
        self.assertEqual(again.status, "finished")

    @unittest.skipUnless(ase, "ASE is not installed")
    def test_velocities_and_boxes_of_ase(self):
        image = ropewalk.atoms(self.run_.scene, tubes=[0]).to_ase()
        image.set_velocities(np.tile([0, 0, 2 / ase.units.fs * 1e-3], (len(image), 1)))  # 2 Å/ps
        whole = image.copy()
        image.set_cell([[40, 0, 0], [8, 40, 0], [0, 0, 90]])
        image.pbc = True
        image.positions += [33, 1, 60]
        image.wrap()
        state = ropewalk.coarsen([image, image], "moving", frame_ps=0.5).frames
        self.assertEqual([frame.time_ps for frame in state], [0, 0.5])
        ends = [np.ptp(np.sort(frame.flat.position[:, 2])) for frame in state]
        wanted = np.ptp(self.run_.scene.start.position[0, :, 2])
        np.testing.assert_allclose(ends, wanted, atol=1e-3)
        rows = list(csv.DictReader(l for l in pathlib.Path("moving/final.csv").read_text().splitlines() if l[0] != "#"))
        np.testing.assert_allclose([float(row["vz_nm_per_ps"]) for row in rows], 0.2, atol=1e-9)
        water = ase.Atoms("OH2", positions=[[0, 0, 0], [1, 0, 0], [0, 1, 0]])
        with self.assertRaisesRegex(ropewalk.InputError, "no carbon nanotube"):
            ropewalk.coarsen(water, "water")
        with self.assertRaisesRegex(ropewalk.InputError, "image 1 has other atoms"):
            ropewalk.coarsen([whole, whole[:-1]], "other")
        with self.assertRaisesRegex(TypeError, "int: atoms of ASE"):
            ropewalk.coarsen([1, 2], "numbers")

    @unittest.skipUnless(MDAnalysis, "MDAnalysis is not installed")
    def test_universes_become_a_run(self):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            universe = ropewalk.atoms_universe(self.run_)
            times = [frame.time_ps for frame in self.run_.frames]
            even = [k * times[1] for k in range(len(times))]  # a DCD holds nothing else
            self.assertEqual([ts.time for ts in universe.trajectory], times)
            self.assertEqual(len(universe.residues), 7)
            universe.atoms.write("md.dcd", frames="all", dt=universe.trajectory.dt)
            universe.atoms.write("md.pdb")
            read = MDAnalysis.Universe("md.pdb", "md.dcd")
            for k, given in enumerate((universe, read, read.select_atoms("name C"))):
                coarse = ropewalk.coarsen(given, f"coarse-{k}")
                np.testing.assert_allclose([frame.time_ps for frame in coarse.frames], even if k else times, rtol=1e-6)
                for frame, wanted in zip(coarse.frames, self.run_.frames):
                    self.assert_same_elements(frame, wanted)
            apart = ropewalk.coarsen(read, "apart", frame_ps=0.25).frames
            self.assertEqual([frame.time_ps for frame in apart[:3]], [0, 0.25, 0.5])
            one = ropewalk.atoms(self.run_, tubes=[1, 3]).to_mdanalysis()
            self.assertEqual(one.residues.resids.tolist(), [1, 3])
            self.assertEqual(set(one.atoms.tempfactors), set(range(self.run_.frames[0].position.shape[1])))
            one.del_TopologyAttr("elements")
            one.del_TopologyAttr("masses")
            one.atoms.types = ["1", "2"] * (len(one.atoms) // 2) + ["1"] * (len(one.atoms) % 2)
            with self.assertRaisesRegex(ropewalk.InputError, "2 types of atoms without elements and masses"):
                ropewalk.coarsen(one, "typed")

    @unittest.skipUnless(MDAnalysis, "MDAnalysis is not installed")
    def test_times_that_a_trajectory_does_not_hold_are_said(self):
        from MDAnalysis.lib.formats.libdcd import DCDFile

        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            universe = ropewalk.atoms_universe(self.run_.frames[:3])
            universe.atoms.write("md.pdb")
            # The header is that of a dump every 50 steps from step 100 on, in metal units and in real ones.
            for unit, delta in (("ps", 0.001), ("fs", 1.0)):
                with DCDFile(f"{unit}.dcd", "w") as file:
                    file.write_header(remarks="Written by LAMMPS", natoms=len(universe.atoms), istart=100, nsavc=50,
                                      delta=delta, is_periodic=0)
                    for timestep in universe.trajectory:
                        file.write(timestep.positions, np.zeros(6))
                for reader in ("DCD", "LAMMPS"):
                    read = MDAnalysis.Universe("md.pdb", f"{unit}.dcd", format=reader)
                    with self.assertLogs("ropewalk", "WARNING") as told:
                        coarse = ropewalk.coarsen(read, "coarse", force=True)
                    self.assertIn(f"is taken as {unit}, and frames are 0.05 ps apart", told.output[0])
                    np.testing.assert_allclose([frame.time_ps for frame in coarse.frames], [0.1, 0.15, 0.2], rtol=1e-6)
            for name in ("md.xyz", "md.dcd"):
                universe.atoms.write(name, frames="all")
                with self.assertLogs("ropewalk", "WARNING") as told:
                    coarse = ropewalk.coarsen(MDAnalysis.Universe("md.pdb", name), "coarse", force=True)
                self.assertIn(f"{name}: MDAnalysis has no times of it", told.output[0])
                np.testing.assert_allclose([frame.time_ps for frame in coarse.frames], [0, 1, 2], rtol=1e-6)


if __name__ == "__main__":
    unittest.main()
