"""Directories of runs: log, frames, manifest, limits."""
from __future__ import annotations

import concurrent.futures
import copy
import csv
import json
import multiprocessing
import pathlib
import pickle
import unittest

import numpy as np
from support import ROPE, FolderTest

import ropewalk


AS_TEXT = {**ROPE, "run": {**ROPE["run"], "frames_format": "lammpstrj"}}


def frames_of(path: str) -> list[dict[str, np.ndarray]]:
    """The columns of each frame, read here by hand."""
    frames = []
    with open(path, encoding="utf-8") as file:
        for line in file:
            if line.startswith("ITEM: TIMESTEP"):
                step = int(next(file))
            elif line.startswith("ITEM: NUMBER OF ATOMS"):
                count = int(next(file))
            elif line.startswith("ITEM: ATOMS"):
                names = line.split()[2:]
                values = np.array([next(file).split() for _ in range(count)], dtype=float)
                frames.append({"step": step, **dict(zip(names, values.T))})
    return frames


def end_of(scene: ropewalk.Scene) -> tuple[ropewalk.Scene, np.ndarray]:
    simulation = ropewalk.Simulation(scene)
    simulation.step(5)
    return scene, simulation.state.position.copy()


class RunTest(FolderTest):
    def setUp(self) -> None:
        super().setUp()
        self.run_ = ropewalk.run(AS_TEXT, "run")

    def test_log_has_the_numbers_of_the_file(self):
        log = self.run_.log
        rows = list(csv.DictReader(pathlib.Path("run/log.csv").read_text().splitlines()))
        self.assertEqual(log.rows, len(rows))
        self.assertEqual(list(log), list(rows[0]))
        for name in log:
            np.testing.assert_array_equal(log[name], [float(row[name]) for row in rows], name)
            self.assertEqual(log[name].shape, (len(rows),))
        self.assertEqual(log["step"].dtype, np.int64)
        self.assertEqual(log.units["torque_upper_nN_nm"], "nN nm")
        self.assertEqual(log.units["Q"], "")
        with self.assertRaisesRegex(ropewalk.InputError, 'did you mean "torque_upper_nN_nm"'):
            log["torque_uper_nN_nm"]
        self.assertNotIn("torque_uper_nN_nm", log)

    def test_log_as_a_table_of_pandas(self):
        try:
            import pandas
        except ImportError:
            self.skipTest("pandas is not installed")
        log = self.run_.log
        wanted = pandas.read_csv("run/log.csv")
        for table in (log.to_dataframe(), pandas.DataFrame(log)):
            pandas.testing.assert_frame_equal(table, wanted, check_dtype=False)  # the file has 0 for 0.0
        self.assertEqual(log.to_dataframe().attrs["units"]["torque_upper_nN_nm"], "nN nm")

    def test_frames_as_atoms_of_ase(self):
        try:
            import ase  # noqa: F401
        except ImportError:
            self.skipTest("ASE is not installed")
        frame = self.run_.frames[-1]
        atoms = frame.to_ase()
        np.testing.assert_allclose(atoms.positions, 10 * frame.flat.position)
        np.testing.assert_array_equal(atoms.get_array("tube"), frame.tube)
        np.testing.assert_allclose(atoms.get_array("axis"), frame.flat.axis)
        self.assertEqual(atoms.info["time_ps"], frame.time_ps)
        carbon = ropewalk.ParameterSet("cnt-10-10-tersoff")["tube.atoms_per_length"].value * frame.element_length_nm
        self.assertAlmostEqual(atoms.get_masses()[0] / (12.011 * carbon), 1, delta=1e-3)

    def test_frames_in_mdanalysis_have_their_times(self):
        try:
            import MDAnalysis  # noqa: F401
        except ImportError:
            self.skipTest("MDAnalysis is not installed")
        run = ropewalk.run(ROPE, "binary")
        universe = run.to_mdanalysis()
        self.assertEqual(len(universe.trajectory), len(run.frames))
        for ts, frame in zip(universe.trajectory, run.frames):
            self.assertEqual(ts.time, frame.time_ps)
            np.testing.assert_allclose(ts.positions, 10 * frame.flat.position, atol=1e-4)
            # A cube about the origin that holds all elements.
            self.assertGreater(ts.dimensions[0], 20 * np.abs(frame.flat.position).max())
            np.testing.assert_array_equal(ts.dimensions[3:], 90)
            self.assertEqual(ts.dt, run.frames[1].time_ps - run.frames[0].time_ps)
        self.assertEqual(universe.trajectory.dt, run.frames[1].time_ps - run.frames[0].time_ps)
        tube = ropewalk.ParameterSet("cnt-10-10-tersoff")
        atoms = tube["tube.atoms_per_length"].value * run.frames[0].element_length_nm
        np.testing.assert_allclose(universe.atoms.masses, 12.011 * atoms, rtol=1e-3)
        np.testing.assert_allclose(universe.atoms.radii, 10 * tube["tube.radius"].value, rtol=1e-6)
        self.assertEqual(universe.trajectory[2].time, run.frames[2].time_ps)
        self.assertEqual(len(universe.select_atoms("resid 3 and segid cnt-10-10-tersoff")), run.frames[0].position.shape[1])
        with self.assertRaisesRegex(ropewalk.InputError, "frames.gsd"):
            self.run_.to_mdanalysis()

    def test_scenes_runs_logs_and_frames_are_copied_and_compared(self):
        with open("rope.toml", "w", encoding="utf-8") as file:
            file.write(ropewalk.Scene(ROPE).text + "# a comment\n")
        for scene in (ropewalk.Scene(ROPE), ropewalk.Scene("rope.toml")):
            for again in (copy.deepcopy(scene), pickle.loads(pickle.dumps(scene))):
                self.assertEqual((again, again.text, again.name, hash(again)), (scene, scene.text, scene.name, hash(scene)))
        self.assertNotEqual(scene, scene.changed({"rope.tubes": 19}))
        run = self.run_
        for thing in (run, run.log, run.frames, run.frames[-1], run.scene, run.limits, run.scene.start):
            for again in (copy.deepcopy(thing), pickle.loads(pickle.dumps(thing))):
                self.assertEqual(again, thing)
        frame = pickle.loads(pickle.dumps(run.frames[1]))
        self.assertEqual(frame.measure("beta_deg"), run.frames[1].measure("beta_deg"))
        self.assertNotEqual(run.frames[0], run.frames[1])
        self.assertNotEqual(run.log, ropewalk.run(ROPE, "shorter", steps=10).log)

    def test_a_pool_over_scenes(self):
        scenes = [ropewalk.Scene(ROPE).changed({"rope.tubes": tubes}) for tubes in (1, 7)]
        with concurrent.futures.ProcessPoolExecutor(2, multiprocessing.get_context("spawn")) as pool:
            for scene, (again, position) in zip(scenes, pool.map(end_of, scenes)):
                self.assertEqual(again, scene)
                np.testing.assert_array_equal(position, end_of(scene)[1])

    def test_mean_of_a_column(self):
        log = self.run_.log
        mean = log.mean("time_ps")
        self.assertAlmostEqual(mean.value, log["time_ps"].mean())
        self.assertTrue(np.isnan(mean.error), "time drifts")
        last = log["time_ps"][-1] - log["time_ps"][-2]
        self.assertAlmostEqual(log.mean("time_ps", last_ps=last).value, log["time_ps"][-2:].mean())

    def test_log_as_npz(self):
        self.run_.log.to_npz("log.npz")
        stored = np.load("log.npz")
        self.assertEqual(list(stored["names"]), list(self.run_.log))
        self.assertEqual(dict(zip(stored["names"], stored["units"])), self.run_.log.units)
        for name in stored["names"]:
            np.testing.assert_array_equal(stored[name], self.run_.log[name])
        with self.assertRaises(OSError):
            self.run_.log.to_npz("absent/log.npz")

    def test_frames_have_the_numbers_of_the_file(self):
        own, frames = frames_of("run/frames.lammpstrj"), self.run_.frames
        self.assertEqual(len(frames), len(own))
        for frame, wanted in zip(frames, own):
            self.assertEqual(frame.step, wanted["step"])
            self.assertEqual(frame.time_ps, wanted["c_time_ps"][0])
            self.assertEqual(frame.position.shape, (7, 10, 3))
            np.testing.assert_array_equal(frame.flat.position.T, [wanted[c] for c in "xyz"])
            quaternion = [wanted[f"c_orient[{k}]"] for k in (4, 1, 2, 3)]
            np.testing.assert_allclose(frame.flat.orientation.T, quaternion, atol=1e-7)
            np.testing.assert_array_equal(frame.tube + 1, wanted["mol"])
            for name in ("bond_energy", "vdw_energy"):
                np.testing.assert_array_equal(getattr(frame, name).ravel(), wanted[f"c_{name}_eV"])
            np.testing.assert_array_equal(frame.bending_moment.ravel(), wanted["c_bending_moment_eV"])
            np.testing.assert_array_equal(frame.twist_angle.ravel(), wanted["c_twist_angle_rad"])
        with self.assertRaisesRegex(ropewalk.Error, "velocity is not known"):
            frames[0].velocity

    def test_frames_are_a_sequence(self):
        frames = self.run_.frames
        steps = [frame.step for frame in frames]
        self.assertEqual(frames[-1].step, steps[-1])
        self.assertEqual(frames[1].step, steps[1])
        self.assertEqual([f.step for f in frames[::-2]], steps[::-2])
        self.assertEqual([f.step for f in frames[1:][1:]], steps[2:])
        self.assertEqual(frames[1:3][-1].step, steps[2])
        self.assertEqual(len(frames[5:1]), 0)
        for index in (len(steps), -len(steps) - 1):
            with self.assertRaises(IndexError):
                frames[index]
        kept = frames[0]
        before = kept.position.copy()
        frames[2]
        np.testing.assert_array_equal(kept.position, before)

    def test_frames_measure_what_the_log_has(self):
        log, frame = self.run_.log, self.run_.frames[-1]
        row = list(log["step"]).index(frame.step)
        self.assertAlmostEqual(frame.measure("beta_deg"), log["beta_deg"][row], places=4)
        self.assertNotIn("twist_eV", frame.measure())
        with self.assertRaisesRegex(ropewalk.InputError, "take it from run.log"):
            frame.measure("twist_eV")

    def test_frames_of_a_killed_run_and_of_a_damaged_one(self):
        path = pathlib.Path("run/frames.lammpstrj")
        text, count = path.read_text(), len(self.run_.frames)
        path.write_text(text[:-200])
        self.assertEqual(len(self.run_.frames), count - 1)
        path.write_text(text.replace("c_orient[4]", "nothing", 1))
        with self.assertRaisesRegex(ropewalk.InputError, r"frames.lammpstrj:\d+: column c_orient\[4\] is missing"):
            self.run_.frames[0]

    def test_binary_frames_are_those_of_the_text(self):
        binary = ropewalk.run(ROPE, "binary")
        self.assertTrue(pathlib.Path("binary/frames.gsd").exists())
        self.assertEqual(len(binary.frames), len(self.run_.frames))
        for index in (-1, 0, 2):
            one, other = binary.frames[index], self.run_.frames[index]
            self.assertEqual(one.step, other.step)
            self.assertAlmostEqual(one.time_ps, other.time_ps, places=8)  # the text has ten digits
            for name in ("position", "orientation", "bond_energy", "vdw_energy", "bending_moment", "twist_angle"):
                np.testing.assert_allclose(getattr(one, name), getattr(other, name), rtol=1e-5, atol=1e-6)
        with self.assertRaises(IndexError):
            binary.frames[len(binary.frames)]

    def test_manifest_limits_and_scene(self):
        run = ropewalk.open("run")
        manifest = json.loads(pathlib.Path("run/manifest.json").read_text())
        self.assertEqual(run.manifest, manifest)
        self.assertEqual(run.status, "finished")
        self.assertEqual(run.manifest["steps"], run.log["step"][-1])
        limits = json.loads(pathlib.Path("run/limits.json").read_text())
        self.assertEqual((run.limits, run.refinements), (limits["limits"], limits["refinements"]))
        self.assertEqual(run.scene.keys["rope"], AS_TEXT["rope"])
        # The scene of a run stands for itself: its sets are the run's copies.
        again = ropewalk.run(run.scene.changed({"run.duration_ps": 1}), "again")
        self.assertLess(again.log["time_ps"][-1], 1.05)

    def test_a_run_beyond_a_limit_says_so(self):
        run = ropewalk.run({**ROPE, "limits": {"twist_deg": 0.001}}, "beyond")
        first = run.first_limit
        self.assertEqual(first["key"], "twist_deg")
        self.assertRegex(repr(run), "<Run beyond: finished, beyond twist_deg from [0-9.]+ ps on>")
        results = run.results
        self.assertEqual((results["status"], results["first_limit"]), ("finished", "twist_deg"))
        self.assertEqual(results["first_limit_ps"], first["passed_at_ps"])
        torque = 0.5 * (run.log["torque_upper_nN_nm"] + run.log["torque_lower_nN_nm"])
        self.assertAlmostEqual(results["torque_max_nN_nm"], np.abs(torque).max(), places=9)
        within = ropewalk.run({**ROPE, "limits": {"shock": 0}}, "within")
        self.assertIsNone(within.first_limit)
        self.assertEqual(repr(within), "<Run within: finished>")

    def test_what_is_no_run_is_refused(self):
        with self.assertRaisesRegex(ropewalk.InputError, "is not the directory of a run"):
            ropewalk.open(".")
        with self.assertRaisesRegex(ropewalk.InputError, "no directory"):
            ropewalk.open("nowhere")


if __name__ == "__main__":
    unittest.main()
