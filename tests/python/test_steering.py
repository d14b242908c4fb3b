"""Simulations that Python steers: forces of one's own, hooks, loads that change, copies."""
from __future__ import annotations

import json
import math
import os
import pickle
import subprocess
import unittest

import numpy as np
from support import ROPE, FolderTest

import ropewalk
from ropewalk.forces import name_of
from ropewalk.programs import find_program

# One tube between clamps, the upper one of which turns.
TUBE = {
    "parameters": "cnt-10-10-tersoff",
    "rope": {"tubes": 1, "length_nm": 20},
    "damping": {"bond_damping_per_ps": 4},
    "grip": [{"end": "lower"}, {"end": "upper", "smooth_ps": 0, "about_z": {"rotation_deg": [[0, 0], [1, 0]]}}],
    "run": {"duration_ps": 100},
}
FREE = {"parameters": "cnt-10-10-tersoff", "rope": {"tubes": 7, "length_nm": 14},
        "damping": {"bond_damping_per_ps": 0, "contact_viscosity_eV_ps_per_nm2": 0}, "run": {"duration_ps": 5}}


class Trap:
    """A spring for every element to its first place, and a field that turns axes towards x."""

    def __init__(self, scene, spring=3.0, field=2.0):  # eV/nm^2, eV
        self.places, self.spring, self.field = scene.start.flat.position, spring, field

    def __call__(self, now):
        away, axis = now.flat.position - self.places, now.flat.axis
        energy = 0.5 * self.spring * (away**2).sum() - self.field * axis[:, 0].sum()
        return -self.spring * away, self.field * np.cross(axis, [1.0, 0, 0]), energy

    def __eq__(self, other):
        return np.array_equal(self.places, other.places)


def pull(now):
    """0.05 eV/nm along x on each element, as from outside."""
    force = np.zeros((len(now.flat), 3))
    force[:, 0] = 0.05
    return force


class OwnForceTest(FolderTest):
    # The run does the steps of a simulation with the same forces, and only goes on with them.
    def test_a_run_takes_forces_of_ones_own(self):
        scene = ropewalk.Scene(FREE)
        for force in (Trap(scene, 0.3, 30), pull):
            simulation = ropewalk.Simulation(scene, forces=[force])
            run = ropewalk.run(scene, "run", steps=40, forces=[force], threads=1, force=True)
            simulation.step(40)
            np.testing.assert_allclose(run.frames[-1].flat.position, simulation.state.flat.position, atol=1e-9)
            with self.assertRaisesRegex(ropewalk.InputError, r"in Python: \w+( \(no energy\))?; it would go on with: none"):
                ropewalk.resume("run")
            again = ropewalk.resume("run", steps=60, forces=[force], threads=1)
            simulation.step(20)
            self.assertEqual(again.log["step"][-1], 60)
            np.testing.assert_allclose(again.frames[-1].flat.position, simulation.state.flat.position, atol=1e-9)

    # The program and the package know that the run had a force, and compute nothing of it without this force.
    def test_nothing_repeats_a_run_without_its_forces(self):
        program = find_program()
        for force in (Trap(ropewalk.Scene(FREE)), pull):
            name = name_of(force)
            run = ropewalk.run(FREE, "run", steps=40, forces=[force], force=True)
            self.assertIn(name, run.manifest["own_forces"])
            for arguments in (["errors", "run"], ["check", "run", "--accuracy"], ["export", "run", "--lammps", "out"],
                              ["modes", "run", "--anyway"], ["resume", "run", "--steps", "50"]):
                said = subprocess.run([program, *arguments], capture_output=True, text=True)
                self.assertEqual(said.returncode, 2, (arguments, said.stderr))
                self.assertIn(name, said.stderr, arguments)
                self.assertIn("ropewalk.resume(", said.stderr, arguments)
            self.assertFalse(os.path.exists("out"))
            self.assertFalse(os.path.exists("run/errors"))
            for again in (run.simulation, lambda: ropewalk.Simulation(run.scene), lambda: ropewalk.run(run.scene, "b")):
                with self.assertRaisesRegex(ropewalk.InputError, name):
                    again()
            self.assertEqual(run.simulation(forces=[force]).step_number, 40)

    # Whoever reads the run finds the force by its name, and its energy among the parts.
    def test_the_files_of_a_run_name_its_forces(self):
        run = ropewalk.run(FREE, "run", steps=40, forces=[Trap(ropewalk.Scene(FREE), 0.3, 30), pull])
        self.assertEqual(run.manifest["own_forces"], "Trap, pull (no energy)")
        log = run.log
        self.assertLess(log["own_forces_eV"][-1], -1)
        total = sum(log[f"{part}_eV"] for part in ("stretch", "shear", "bend", "twist", "vdw", "own_forces", "kinetic"))
        np.testing.assert_allclose(total - total[0] - log["work_eV"] + log["dissipated_eV"], log["balance_eV"], atol=1e-9)
        with open("run/report.html", encoding="utf-8") as page:
            html = page.read()
        self.assertIn("Trap, pull (no energy)", html)
        self.assertRegex(html, r"own forces (<b>)?.\d")
        said = subprocess.run([find_program(), "observe", "run"], capture_output=True, text=True)
        self.assertIn("Trap, pull (no energy)", said.stderr)

    def test_other_forces_are_known_by_name_and_energy(self):
        def push(now):
            return -pull(now)

        ropewalk.run(FREE, "run", steps=40, forces=[pull])
        with self.assertRaisesRegex(ropewalk.InputError, r"pull \(no energy\); it would go on with: Trap"):
            ropewalk.resume("run", steps=50, forces=[Trap(ropewalk.Scene(FREE))])
        with self.assertRaisesRegex(ropewalk.InputError, r"pull \(no energy\) -> push \(no energy\)"):
            ropewalk.resume("run", steps=50, forces=[push])
        run = ropewalk.resume("run", steps=50, forces=[push], accept_changes=True)
        self.assertEqual(run.manifest["own_forces"], "push (no energy)")

    def test_a_force_with_an_energy_closes_the_account(self):
        scene, off = ropewalk.Scene(FREE), []
        for parts in (1, 2):
            simulation = ropewalk.Simulation(scene, forces=[Trap(scene, 0.3, 30)])
            simulation.divided = parts
            before = simulation.energies
            self.assertEqual(before.terms, 0)
            simulation.step(200)
            after = simulation.energies
            self.assertGreater(after.kinetic, 1000)
            self.assertLess(after.terms, -1000)
            self.assertAlmostEqual(after.total - before.total, simulation.measure("balance_eV"), places=9)
            self.assertLess(abs(simulation.measure("work_eV")), 1e-12)
            off.append(abs(after.total - before.total))
        self.assertLess(off[0], 1e-3 * after.kinetic)
        self.assertLess(off[1], 0.35 * off[0])  # of second order in the step

    def test_a_force_without_an_energy_does_work(self):
        simulation = ropewalk.Simulation(FREE, forces=[pull])
        begin = simulation.state.flat.position[:, 0].mean()
        simulation.step(200)
        path = simulation.state.flat.position[:, 0].mean() - begin
        work = 0.05 * 70 * path
        time, mass = simulation.time_ps, simulation.scene._core.mass[0]
        self.assertAlmostEqual(path / (0.5 * 0.05 / mass * time**2), 1, delta=1e-7)
        self.assertAlmostEqual(simulation.measure("work_eV") / work, 1, delta=1e-9)
        self.assertLess(abs(simulation.measure("balance_eV")), 2e-3 * work)

    def test_it_is_the_tether_of_the_program(self):
        def spring(now):
            z = now.flat.position[-1] - [0, 0, 30]
            force = np.zeros((len(now.flat), 3))
            force[-1] = -k * (1 - 10 / np.linalg.norm(z)) * z
            return force, None, 0.5 * k * (np.linalg.norm(z) - 10) ** 2

        k = 0.5 / 0.1602176634  # nN/nm in eV/nm^2
        typed = ropewalk.Simulation({**FREE, "tether": [{
            "tube": 6, "elements": [-1], "to_point_nm": [0, 0, 30], "stiffness_nN_per_nm": 0.5, "rest_nm": 10}]})
        own = ropewalk.Simulation(ropewalk.Scene({**FREE, "run": {"duration_ps": 5, "time_step_fs": typed.time_step_fs}}),
                                  forces=[spring])
        for simulation in (typed, own):
            simulation.step(100)
        np.testing.assert_allclose(own.state.flat.position, typed.state.flat.position, atol=1e-9)
        self.assertAlmostEqual(own.energies.terms, typed.energies.terms, places=7)
        self.assertGreater(np.abs(own.state.flat.velocity).max(), 1e-3)

    def test_bits_depend_on_neither_threads_nor_calls_nor_checkpoints(self):
        scene = ropewalk.Scene({**FREE, "rope": {"tubes": 37, "length_nm": 28}})
        before = ropewalk.threads()
        self.addCleanup(ropewalk.set_threads, before)
        ends = []
        for n in (1, 2):
            ropewalk.set_threads(n)
            simulation = ropewalk.Simulation(scene, forces=[Trap(scene), pull])
            simulation.step(10)
            here = simulation.checkpoint()
            simulation.step(10)
            ends.append(simulation.checkpoint())
            simulation.restore(here)
            for _ in range(10):
                simulation.step()
            ends.append(simulation.checkpoint())
        self.assertEqual(len(set(ends)), 1)

    def test_what_it_raises_leaves_the_step_before(self):
        def fails(now):
            if now.step == 3 and failing:
                raise failing[0]("no")
            return pull(now)

        for error in (RuntimeError, KeyboardInterrupt):
            failing = []
            whole = ropewalk.Simulation(FREE, forces=[fails])
            whole.step(6)
            failing = [error]
            broken = ropewalk.Simulation(FREE, forces=[fails])
            with self.assertRaisesRegex(error, "no"):
                broken.step(6)
            self.assertEqual(broken.step_number, 2)
            failing = []
            broken.step(4)
            self.assertEqual(broken.checkpoint(), whole.checkpoint())

    def test_a_relaxation_finds_the_minimum_with_it(self):
        scene = ropewalk.Scene({**FREE, "run": {"mode": "relax"}})
        simulation = ropewalk.Simulation(scene, forces=[Trap(scene)])
        self.assertTrue(simulation.relax(1e-4).at_rest)
        self.assertLess(simulation.energies.terms, -3)
        self.assertLess(simulation.largest_force_eV_per_nm, 1e-4)

    def test_what_is_wrong_is_said(self):
        for wrong, words in ((lambda now: np.zeros((3, 3)), r"\(70, 3\) is needed"),
                             (lambda now: np.where(now.flat.position > now.step, 0, np.nan) if now.step else None,
                              r"<lambda>, a force of one's own, at 0\.0\d+ ps, is not finite: \[.*\] on element \d+"),
                             (lambda now: np.zeros((70, 3), complex), "complex128: real numbers are needed"),
                             (lambda now: np.ma.masked_array(np.zeros((70, 3)), True), "masked array"),
                             (lambda now: np.full((70, 3), "1"), "real numbers are needed"),
                             (lambda now: (None, None, math.inf), "energy"),
                             (lambda now: (None, None, 1j), "energy"),
                             (lambda now: (None, None, None if now.step else 1.0), "an energy at some times")):
            with self.assertRaisesRegex((ValueError, TypeError), words):
                ropewalk.Simulation(FREE, forces=[wrong]).step()

    def test_a_missing_return_is_told_once(self):
        def forgets(now):
            pull(now)

        with self.assertLogs("ropewalk") as logged:
            ropewalk.Simulation(FREE, forces=[forgets]).step(3)
        self.assertEqual(len(logged.output), 1)
        self.assertIn("forgets gives None at 0 ps", logged.output[0])

    def test_the_manifest_says_in_one_line_why_a_force_ended_the_run(self):
        def fails(now):
            if now.step == 3:
                raise RuntimeError("no wind")
            return pull(now)

        with self.assertLogs("ropewalk") as logged, self.assertRaisesRegex(RuntimeError, "no wind"):
            ropewalk.run(FREE, "run", forces=[fails])
        self.assertIn("ropewalk.resume(\"run\", forces=...) goes on", logged.output[-1])
        with open("run/manifest.json", encoding="utf-8") as file:
            reason = json.load(file)["reason"]
        self.assertIn("RuntimeError: no wind", reason)
        self.assertNotRegex(reason, r"\n|\\n|At:")


class ChangeTest(FolderTest):
    def test_a_torque_is_held_by_turning(self):
        wanted, angle, every = 15.0, 0.0, 40  # nN nm, deg
        simulation = ropewalk.Simulation(TUBE)
        simulation.divided = 4  # each jump of the clamp's speed costs the account an error of first order in the step

        def control(s):
            nonlocal angle
            now, ahead = s.time_ps, every * 1e-3 * s.time_step_fs
            more = float(np.clip(0.2 * (wanted - s.measure("torque_upper_nN_nm")), -2, 2))
            s.change({"grip.1.about_z.rotation_deg": [[0, 0], [now, angle], [now + ahead, angle + more]] if now else
                      [[0, 0], [ahead, more]]})
            angle += more

        simulation.add_hook(control, every)
        simulation.step(every * 150)
        torques = []
        simulation.add_observer(lambda s: torques.append(s.measure("torque_upper_nN_nm")), every)
        simulation.step(every * 10)
        self.assertAlmostEqual(np.mean(torques), wanted, delta=0.02 * wanted)
        # The clamp has turned as the schedule says, and as the stiffness of the tube asks.
        self.assertAlmostEqual(simulation.measure("rotation_deg"), angle, delta=1e-6)
        stiffness = ropewalk.ParameterSet("cnt-10-10-tersoff")["bond.GJ"].value
        length = (simulation.scene.elements - 1) * simulation.scene.element_length_nm
        self.assertAlmostEqual(math.radians(angle) * stiffness / length, wanted, delta=0.03 * wanted)
        self.assertLess(abs(simulation.measure("balance_eV")), 0.005 * simulation.measure("work_eV"))

    def test_a_change_is_what_the_other_scene_does(self):
        faster = {"grip.1.about_z.rotation_deg": [[0, 0], [5, 50]]}
        slow = ropewalk.Scene(TUBE).changed({"grip.1.about_z.rotation_deg": [[0, 0], [5, 10]], "grip.1.smooth_ps": None})
        one, other = ropewalk.Simulation(slow), ropewalk.Simulation(slow.changed(faster))
        one.change(faster)
        for simulation in (one, other):
            simulation.step(50)
        np.testing.assert_array_equal(one.state.position, other.state.position)
        self.assertEqual(one.scene, other.scene)

    def test_moments_change_and_their_work_counts(self):
        simulation = ropewalk.Simulation(ROPE)
        simulation.step(20)
        before = simulation.measure("moment_nN_nm")
        simulation.change({"twist.moment_nN_nm": 2})
        self.assertEqual((simulation.measure("moment_nN_nm"), simulation.scene["twist.moment_nN_nm"]), (2, 2))
        self.assertGreater(before, 2)
        simulation.step(50)
        self.assertLess(abs(simulation.measure("balance_eV")), 0.02 * simulation.measure("work_eV"))

    def test_checkpoints_hold_the_change(self):
        simulation = ropewalk.Simulation(TUBE)
        simulation.step(10)
        simulation.change({"grip.1.about_z.rotation_deg": [[0, 0], [5, 50]]})
        simulation.step(10)
        simulation.save("here")
        again = ropewalk.Simulation(TUBE)
        begin = again.checkpoint()
        again.restore("here")
        self.assertEqual(again.scene, simulation.scene)
        for s in (simulation, again):
            s.step(10)
        self.assertEqual(again, simulation)
        again.restore(begin)
        self.assertEqual(again, ropewalk.Simulation(TUBE))
        damaged = bytearray(simulation.checkpoint())
        damaged[-40] ^= 1  # in the text of the change
        with self.assertRaisesRegex(ropewalk.InputError, "damaged"):
            again.restore(bytes(damaged))
        self.assertEqual(again, ropewalk.Simulation(TUBE))

    def test_the_bath_changes_and_its_heat_counts(self):
        scene = ropewalk.Scene({
            "parameters": "cnt-10-10-tersoff", "chain": {"elements": 60}, "damping": {"bond_damping_per_ps": 0},
            "start": {"temperature_K": 600}, "thermostat": {"temperature_K": 300, "coupling_per_ps": 5},
            "run": {"duration_ps": 20}})
        hot = ropewalk.Simulation(scene)

        def kinetic():  # eV, mean of the last 4 of 6 ps, by which the bath has its way
            values = []
            hot.step(round(2 / (1e-3 * hot.time_step_fs)))
            for _ in range(100):
                hot.step(round(0.04 / (1e-3 * hot.time_step_fs)))
                values.append(hot.measure("kinetic_eV"))
            return np.mean(values)

        cold = kinetic()
        hot.change({"thermostat.temperature_K": 900})
        self.assertEqual(hot.scene["thermostat.temperature_K"], 900)
        self.assertAlmostEqual(kinetic() / cold, 3, delta=0.5)
        hot.save("warm")
        again = ropewalk.Simulation(scene)
        again.restore("warm")
        for s in (hot, again):
            s.step(20)
        np.testing.assert_array_equal(again.state.velocity, hot.state.velocity)
        self.assertLess(abs(hot.measure("balance_eV")), 0.02 * abs(hot.measure("thermostat_eV")))

    def test_the_rest_of_the_scene_stays(self):
        simulation = ropewalk.Simulation(TUBE)
        before = simulation.checkpoint()
        for changes, words in (({"rope.tubes": 7}, "rope: stays as it is"), ({"grip.1.elements": 3}, "other elements"),
                               ({"grip.1.about_z.rotation_deg": [[0, 1], [2, 3]]}, "begins at 1"),
                               ({"grip.0.ende": "upper"}, "ende")):
            with self.assertRaisesRegex(ropewalk.InputError, words):
                simulation.change(changes)
        self.assertEqual(simulation.checkpoint(), before)

    def test_hooks_are_called_before_steps(self):
        simulation, seen = ropewalk.Simulation(ROPE), []
        hook = lambda s: seen.append(s.step_number)  # noqa: E731
        simulation.add_hook(hook, 3)
        simulation.step(4)
        simulation.step(3)
        self.assertEqual(seen, [0, 3, 6])
        simulation.remove_hook(hook)
        simulation.step(3)
        self.assertEqual(seen, [0, 3, 6])
        simulation.add_hook(lambda s: s.step())
        with self.assertRaisesRegex(ropewalk.Error, "cannot step"):
            simulation.step()


class CopyTest(FolderTest):
    def test_simulations(self):
        scene = ropewalk.Scene(ROPE)
        simulation = ropewalk.Simulation(scene, forces=[Trap(scene)])
        simulation.step(5)
        again = pickle.loads(pickle.dumps(simulation))
        self.assertEqual(again, simulation)
        again.step()
        self.assertNotEqual(again, simulation)
        simulation.step()
        self.assertEqual(again, simulation)
        state = pickle.loads(pickle.dumps(simulation.state))
        self.assertEqual(state, simulation.state)


if __name__ == "__main__":
    unittest.main()
