"""Simulations driven from Python: the program's own bits, views, observers, checkpoints, interruption."""
from __future__ import annotations

import gc
import os
import pathlib
import signal
import subprocess
import sys
import threading
import unittest

import numpy as np
from support import ROPE, FolderTest, signals_of_a_terminal

import ropewalk
from ropewalk.state import Elements


class StepTest(FolderTest):
    def test_the_motion_is_that_of_the_program(self):
        run = ropewalk.run(ROPE, "run")
        simulation = ropewalk.Simulation(ROPE)
        simulation.step_until(2.0)
        simulation.write_state("mine.csv")
        self.assertEqual(pathlib.Path("mine.csv").read_text(), pathlib.Path("run/final.csv").read_text())
        log = run.log
        self.assertEqual(simulation.step_number, log["step"][-1])
        for name in ("time_ps", "twist_eV", "vdw_eV", "kinetic_eV", "balance_eV", "beta_deg", "Q", "moment_nN_nm"):
            self.assertEqual(simulation.measure(name), log[name][-1], name)

    def test_calls_and_energies_change_no_bit(self):
        one, many = ropewalk.Simulation(ROPE), ropewalk.Simulation(ROPE)
        one.step(30)
        for n in (1, 2, 7, 20):
            many.step(n, energies=False)
        np.testing.assert_array_equal(one.state.position, many.state.position)
        # Energies that the last step left out are made good.
        self.assertAlmostEqual(many.energies.vdw, one.energies.vdw, places=9)
        self.assertAlmostEqual(many.energies.bonds, one.energies.bonds, places=9)
        self.assertNotEqual(one.energies.twist, ropewalk.Simulation(ROPE).energies.twist)

    def test_threads_change_no_bit(self):
        ends = []
        before = ropewalk.threads()
        self.addCleanup(ropewalk.set_threads, before)
        for n in (1, 2):
            ropewalk.set_threads(n)
            self.assertEqual(ropewalk.threads(), n)
            simulation = ropewalk.Simulation({**ROPE, "rope": {"tubes": 37, "length_nm": 28}})
            simulation.step(20)
            ends.append(simulation.state.position.copy())
        np.testing.assert_array_equal(*ends)

    def test_divided_steps_take_time_as_far(self):
        simulation = ropewalk.Simulation(ROPE)
        simulation.divided = 2
        simulation.step(3)
        self.assertAlmostEqual(simulation.time_ps, 3e-3 * simulation.time_step_fs)
        self.assertEqual(simulation.step_number, 3)
        self.assertAlmostEqual(simulation.measure("time_step_fs"), simulation.time_step_fs / 2)
        with self.assertRaises(ValueError):
            simulation.divided = 0

    def test_relaxation_comes_to_rest(self):
        simulation = ropewalk.Simulation({**{k: v for k, v in ROPE.items() if k != "twist"}, "run": {"mode": "relax"}})
        before = simulation.energies.potential
        end = simulation.relax(1e-4)
        self.assertTrue(end.at_rest)
        self.assertLess(end.force_eV_per_nm, 1e-4)
        self.assertLess(simulation.largest_force_eV_per_nm, 1e-4)
        self.assertLess(simulation.energies.potential, before)
        self.assertEqual(np.abs(simulation.state.velocity).max(), 0)
        self.assertFalse(ropewalk.Simulation(ROPE).relax(max_steps=2).at_rest)

    def test_a_failure_is_a_numerical_error(self):
        rope = {k: v for k, v in ROPE.items() if k != "twist"}
        rope["grip"] = [{"end": "lower"}, {"end": "upper", "about_z": {"rotation_deg": [[0, 0], [50, 3000]]}}]
        simulation = ropewalk.Simulation(rope)
        with self.assertRaises(ropewalk.NumericalError) as caught:
            simulation.step(20000)
        self.assertGreater(caught.exception.step, 0)
        self.assertIn(f"step {caught.exception.step}", str(caught.exception))


class ForkTest(FolderTest):
    def test_a_forked_process_steps(self):
        before = ropewalk.threads()
        self.addCleanup(ropewalk.set_threads, before)
        ropewalk.set_threads(2)
        simulation = ropewalk.Simulation({**ROPE, "rope": {"tubes": 37, "length_nm": 28}})
        simulation.step(5)
        child = os.fork()
        if child == 0:
            signal.alarm(60)  # else it would wait for ever for threads that are not there
            simulation.step(5)
            simulation.save("child")
            os._exit(0)
        self.assertEqual(os.waitpid(child, 0)[1], 0)
        simulation.step(5)
        self.assertEqual(pathlib.Path("child").read_bytes(), simulation.checkpoint())


class ViewTest(FolderTest):
    def test_views_are_no_copies_and_follow(self):
        simulation = ropewalk.Simulation(ROPE)
        state = simulation.state
        position, flat, velocity = state.position, state.flat.position, state.velocity
        self.assertTrue(np.shares_memory(position, flat))
        self.assertTrue(np.shares_memory(position, simulation.state.position))
        before = position.copy()
        simulation.step(10)
        self.assertFalse(np.array_equal(before, position))
        np.testing.assert_array_equal(position.reshape(-1, 3), simulation.state.flat.position)
        # The text of the state has the same numbers in the same order.
        simulation.write_state("state.csv")
        table = np.loadtxt("state.csv", delimiter=",", skiprows=1)
        np.testing.assert_array_equal(table[:, 1:4], flat)
        np.testing.assert_array_equal(table[:, 4:8], state.flat.orientation)
        np.testing.assert_array_equal(table[:, 8:11], velocity.reshape(-1, 3))
        np.testing.assert_array_equal(table[:, 11:14], state.flat.angular_velocity)

    def test_views_stay_where_they_are(self):
        simulation = ropewalk.Simulation(ROPE)
        state, force = simulation.state, simulation.force
        checkpoint = simulation.checkpoint()
        simulation.step(5)
        simulation.relax(max_steps=20)
        simulation.restore(checkpoint)
        simulation.step(5)
        for name in ("position", "orientation", "velocity", "angular_velocity"):
            old, new = getattr(state, name), getattr(simulation.state, name)
            self.assertEqual(old.ctypes.data, new.ctypes.data, name)
        self.assertEqual(force.ctypes.data, simulation.force.ctypes.data)

    def test_views_are_read_only(self):
        simulation = ropewalk.Simulation(ROPE)
        for view in (simulation.state.position, simulation.state.flat.velocity, simulation.force, simulation.torque):
            with self.assertRaises(ValueError):
                view[0] = 0

    def test_a_view_keeps_its_simulation(self):
        simulation = ropewalk.Simulation(ROPE)
        core, position = simulation._core, simulation.state.position
        references = sys.getrefcount(core)
        wanted = position.copy()
        del simulation
        gc.collect()
        self.assertGreaterEqual(sys.getrefcount(core), references - 1)
        del core
        gc.collect()
        junk = [ropewalk.Simulation(ROPE) for _ in range(3)]  # takes the memory if it was free
        np.testing.assert_array_equal(position, wanted)
        del junk

    def test_unequal_tubes(self):
        simulation = ropewalk.Simulation(self.unequal_scene())
        simulation.step(3)
        self.assertEqual(simulation.state.flat.position.shape, (22, 3))
        with self.assertRaisesRegex(ropewalk.Error, "flat.position"):
            simulation.state.position


class ObserverTest(FolderTest):
    def test_they_are_called_at_their_steps(self):
        simulation = ropewalk.Simulation(ROPE)
        seen, energies = [], []
        simulation.add_observer(lambda s: seen.append(s.step_number), 4)
        observer = lambda s: energies.append((s.step_number, s.measure("twist_eV")))  # noqa: E731
        simulation.add_observer(observer, 6)
        simulation.step(5)
        simulation.step(8, energies=False)
        self.assertEqual(seen, [4, 8, 12])
        self.assertEqual([step for step, _ in energies], [6, 12])
        self.assertGreater(energies[1][1], energies[0][1])
        simulation.remove_observer(observer)
        simulation.step(11)
        self.assertEqual(len(energies), 2)
        plain = ropewalk.Simulation(ROPE)
        plain.step(24)
        np.testing.assert_array_equal(plain.state.position, simulation.state.position)

    def test_what_they_raise_ends_the_step(self):
        simulation = ropewalk.Simulation(ROPE)

        def stop(s):
            raise KeyError("enough")

        simulation.add_observer(stop, 3)
        with self.assertRaises(KeyError):
            simulation.step(10)
        self.assertEqual(simulation.step_number, 3)

    def test_they_cannot_move_the_simulation(self):
        """Each call that moves the state, from each kind of function that a simulation calls."""
        scene = ropewalk.Scene(ROPE)
        begin = ropewalk.Simulation(scene).checkpoint()
        moves = {"step": lambda s: s.step(), "step_until": lambda s: s.step_until(1), "relax": lambda s: s.relax(),
                 "restore": lambda s: s.restore(begin)}
        for name, move in moves.items():
            for kind in ("hook", "observer", "force"):
                with self.subTest(f"{name} in a {kind}"):
                    called = []

                    def force(now, move=move, called=called):
                        if now.step == 2:
                            called.append(1)
                            move(simulation)

                    simulation = ropewalk.Simulation(scene, forces=[force] if kind == "force" else [])
                    if kind == "hook":
                        simulation.add_hook(lambda s, move=move: s.step_number == 2 and move(s))
                    if kind == "observer":
                        simulation.add_observer(lambda s, move=move: s.step_number == 2 and move(s), 1)
                    with self.assertRaisesRegex(ropewalk.Error, f"cannot {name.split('_')[0]} the simulation that calls it"):
                        simulation.step(4)
                    self.assertLessEqual(simulation.step_number, 2)
                    simulation.step(0)

    def test_what_is_read_changes_nothing(self):
        """Each call that reads, from an observer."""
        read = {"repr": repr, "state": lambda s: s.state.position.sum(), "force": lambda s: s.force.sum(),
                "energies": lambda s: s.energies, "measure": lambda s: s.measure("kinetic_eV"),
                "checkpoint": lambda s: s.checkpoint(), "write_state": lambda s: s.write_state("now.csv"),
                "save": lambda s: s.save("now.bin"), "largest_force": lambda s: s.largest_force_eV_per_nm}
        plain = ropewalk.Simulation(ROPE)
        plain.step(6)
        for name, look in read.items():
            with self.subTest(name):
                simulation = ropewalk.Simulation(ROPE)
                simulation.add_observer(look, 2)
                simulation.step(6)
                np.testing.assert_array_equal(plain.state.position, simulation.state.position)

    def test_numbers_are_real_and_finite(self):
        simulation = ropewalk.Simulation(ROPE)
        calls = (simulation.step, simulation.step_until, simulation.relax, lambda x: simulation.relax(energy=x),
                 lambda x: simulation.relax(max_steps=x), lambda x: simulation.add_observer(print, x),
                 lambda x: simulation.add_hook(print, x), lambda x: setattr(simulation, "divided", x))
        for call in calls:
            for wrong in (float("nan"), float("inf"), -1, 1j, "1", None if call is simulation.step else float("-inf")):
                with self.assertRaises((ValueError, TypeError)):
                    call(wrong)
        self.assertEqual(simulation.step_number, 0)


class MeasureTest(FolderTest):
    def test_all_observables_by_name(self):
        simulation = ropewalk.Simulation(ROPE)
        simulation.step(10)
        values = simulation.measure()
        self.assertEqual(list(values), [o.name for o in ropewalk.observables()])
        self.assertAlmostEqual(values["twist_eV"], simulation.energies.twist, places=12)
        with self.assertRaisesRegex(ropewalk.InputError, 'did you mean "beta_deg"'):
            simulation.measure("bta_deg")

    def test_means_since_the_last_step_that_was_measured(self):
        names = ("torque_upper_nN_nm", "torque_lower_nN_nm")
        one, two = ropewalk.Simulation(ROPE), ropewalk.Simulation(ROPE)
        for n in (10, 10):
            one.step(n)
            two.step(n)
            at_once = one.measure()
            # Asking for them one by one makes no difference.
            self.assertEqual([two.measure(name) for name in names], [at_once[name] for name in names])
        whole = ropewalk.Simulation(ROPE)
        whole.step(20)
        self.assertNotEqual(whole.measure(names[0]), at_once[names[0]])

    def test_energy_of_a_state(self):
        simulation = ropewalk.Simulation(ROPE)
        simulation.step(20)
        simulation.write_state("state.csv")
        by_file = ropewalk.energy("state.csv", "cnt-10-10-tersoff")
        for other in (ropewalk.energy(simulation), ropewalk.energy(simulation.state, "cnt-10-10-tersoff"),
                      ropewalk.energy(simulation, "cnt-10-10-tersoff", reference=True)):
            # The scene leaves out more along a tube than a state alone, so that bonds and forces agree, not bits.
            np.testing.assert_allclose(other.bonds, by_file.bonds, rtol=1e-9)
            np.testing.assert_allclose(other.vdw, by_file.vdw, rtol=1e-9)
            np.testing.assert_allclose(other.force, by_file.force, atol=1e-7)
        self.assertLess(np.abs(by_file.net_force).max(), 1e-9)
        self.assertLess(np.abs(by_file.net_torque).max(), 1e-8)
        self.assertEqual(ropewalk.energy(simulation.state, "cnt-10-10-tersoff", law="none").vdw, 0)
        with self.assertRaisesRegex(ropewalk.InputError, "--law: there is no contact law 'glue'"):
            ropewalk.energy(simulation.state, "cnt-10-10-tersoff", law="glue")
        with self.assertRaises(TypeError):
            ropewalk.energy(simulation.state)

    def test_energy_has_what_friction_links_and_broken_tubes_remember(self):
        simulation = ropewalk.Simulation({
            "parameters": "cnt-10-10-tersoff", "rope": {"tubes": 7, "length_nm": 14},
            "links": [{"per_nm": 0.3, "stiffness_nN_per_nm": 100, "breaks_at_nN": 5}],
            "failure": {"strain": 0.02}, "friction": [{"from": "atoms"}], "contact": {"precision": "double"},
            "grip": [{"end": "lower"}, {"end": "upper", "z": {"strain": [[0, 0], [3, 0.05]]}}],
            "run": {"duration_ps": 4},
        })
        simulation.step_until(4)
        self.assertGreater(simulation.measure("bonds_broken"), 0)
        self.assertGreater(abs(simulation.energies.terms), 1e-3)
        for reference in (False, True):
            found = ropewalk.energy(simulation, reference=reference)
            for name in ("stretch", "bend", "vdw", "terms"):
                self.assertAlmostEqual(getattr(found, name), getattr(simulation.energies, name), delta=1e-6)

    def test_energy_of_a_collapsed_tube_needs_its_free_length(self):
        simulation = ropewalk.Simulation({
            "parameters": "cnt-10-10-tersoff", "rope": {"tubes": 1, "length_nm": 14},
            "grip": [{"end": "lower"}, {"end": "upper", "about_z": {"rotation_deg": [[0, 0], [4, 55]]}}],
            "run": {"duration_ps": 8},
        })
        simulation.step_until(8)
        simulation.write_state("state.csv")
        with self.assertLogs("ropewalk", "WARNING") as said:
            short = ropewalk.energy("state.csv", "cnt-10-10-tersoff")
        self.assertIn("beyond the collapse", said.output[0])
        self.assertGreater(abs(short.twist - simulation.energies.twist), 1e-3)
        whole = ropewalk.energy("state.csv", "cnt-10-10-tersoff", free_length_nm=9 * 1.3775870846515064)
        self.assertAlmostEqual(whole.twist, simulation.energies.twist, delta=1e-6)

    def test_energy_is_a_number_or_an_error(self):
        start = ropewalk.Scene(ROPE).start

        def of(position, orientation, **more):
            flat = Elements(position.reshape(-1, 3), orientation.reshape(-1, 4))
            state = ropewalk.State(flat, start.tube_begin, start.element_length_nm)
            ropewalk.energy(state, "cnt-10-10-tersoff", **more)

        of(start.position, start.orientation)
        for value in (np.nan, np.inf):
            position = start.position.copy()
            position[0, 2, 1] = value
            with self.assertRaisesRegex(ropewalk.InputError, "state: element 2 has no finite position"):
                of(position, start.orientation)
        for length in (0, 3, np.nan):
            orientation = start.orientation.copy()
            orientation[0, 1] *= length
            with self.assertRaisesRegex(ropewalk.InputError, "state: element 1 has a quaternion of length"):
                of(start.position, orientation)
        position = start.position.copy()
        position[0, 2] = position[0, 1]
        with self.assertRaisesRegex(ropewalk.InputError, "state: .*finite number; two elements lie in one place"):
            of(position, start.orientation)
        with self.assertRaisesRegex(ropewalk.InputError, "parameters: names no parameter set"):
            ropewalk.energy(start, [])
        for begin in ([], [70], [0, 80, 70], [0, 35, 35, 70], [1, 70], [0, -5, 70]):
            with self.assertRaisesRegex(ValueError, "tubes"):
                ropewalk.energy(ropewalk.State(start.flat, begin, start.element_length_nm), "cnt-10-10-tersoff")

    def test_numbers_of_steps_have_an_end(self):
        simulation = ropewalk.Simulation(ROPE)
        for call in (simulation.step, lambda n: simulation.relax(max_steps=n)):
            with self.assertRaisesRegex(ValueError, ": give 0 to"):
                call(10**30)

    def test_forces_are_the_slope_of_the_energy(self):
        scene = ropewalk.Scene(ROPE)
        position, step = scene.start.position.copy(), 1e-5
        position[0, 3] += [0.02, -0.01, 0.015]
        ropewalk.write_state("moved.csv", position, scene.start.orientation)
        found = ropewalk.energy("moved.csv", "cnt-10-10-tersoff")
        ends = []
        for sign in (-1, 1):
            moved = position.copy()
            moved[0, 3, 0] += sign * step
            ropewalk.write_state("moved.csv", moved, scene.start.orientation)
            ends.append(ropewalk.energy("moved.csv", "cnt-10-10-tersoff").potential)
        self.assertAlmostEqual(found.force[3, 0], (ends[0] - ends[1]) / (2 * step), delta=1e-4 * abs(found.force[3, 0]))


class CheckpointTest(FolderTest):
    def test_it_goes_on_with_the_same_bits(self):
        first = ropewalk.Simulation(ROPE)
        first.step(13)
        first.save("here")
        first.step(20)
        second = ropewalk.Simulation(ROPE)
        second.restore("here")
        self.assertEqual(second.step_number, 13)
        second.step(20)
        np.testing.assert_array_equal(first.state.position, second.state.position)
        self.assertEqual(first.energies, second.energies)
        self.assertEqual(first.measure("balance_eV"), second.measure("balance_eV"))

    def test_what_is_no_file_is_not_waited_for(self):
        os.mkfifo("pipe")
        simulation = ropewalk.Simulation(ROPE)
        with self.assertRaisesRegex(ropewalk.InputError, "pipe: is not a regular file"):
            simulation.restore("pipe")
        with self.assertRaises(TypeError):  # a number would be an open file
            simulation.restore(0)

    def test_damaged_and_foreign_checkpoints_are_refused(self):
        simulation = ropewalk.Simulation(ROPE)
        simulation.step(3)
        good = simulation.checkpoint()
        before = simulation.state.position.copy()
        other = ropewalk.Simulation({**ROPE, "rope": {"tubes": 7, "length_nm": 28}})
        stiffer = ropewalk.Simulation({**ROPE, "damping": {"bond_damping_per_ps": 3}})
        self.assertEqual(stiffer.state.position.shape, before.shape)
        for bad in (b"", good[:100], good[:-1], good[:500] + b"x" + good[501:], other.checkpoint(), stiffer.checkpoint()):
            with self.assertRaisesRegex(ropewalk.InputError, "^checkpoint: "):
                simulation.restore(bad)
        np.testing.assert_array_equal(simulation.state.position, before)

    def test_a_run_goes_on_in_memory(self):
        run = ropewalk.run(ROPE, "run", steps=20)
        simulation = run.simulation()
        self.assertEqual(simulation.step_number, 20)
        simulation.step(25)
        whole = ropewalk.run(ROPE, "whole")
        self.assertEqual(simulation.measure("balance_eV"), whole.log["balance_eV"][-1])


INTERRUPTED = """
import threading
import ropewalk

simulation = ropewalk.Simulation(%r)


def say_when_at_work():
    while True:
        try:
            simulation.time_ps
        except ropewalk.BusyError:
            print("at work", flush=True)
            return


threading.Thread(target=say_when_at_work).start()
try:
    simulation.%s
except KeyboardInterrupt:
    at = simulation.step_number
    simulation.step(2)
    assert simulation.step_number == at + 2
    print("interrupted")
"""


class InterruptTest(FolderTest):
    def interrupted(self, call: str, scene: dict) -> None:
        signals_of_a_terminal(self)
        process = subprocess.Popen([sys.executable, "-c", INTERRUPTED % (scene, call)], stdout=subprocess.PIPE, text=True)
        self.addCleanup(process.kill)
        self.assertEqual(process.stdout.readline(), "at work\n")
        process.send_signal(signal.SIGINT)
        said, _ = process.communicate(timeout=100)
        self.assertEqual((said, process.returncode), ("interrupted\n", 0))

    def test_ctrl_c_ends_steps(self):
        self.interrupted("step(10**9)", {**ROPE, "twist": {"moment_nN_nm": 1, "rate_nN_nm_per_ps": 1},
                                         "run": {"duration_ps": 1e6}})

    def test_ctrl_c_ends_a_relaxation(self):
        scene = {**{k: v for k, v in ROPE.items() if k != "twist"}, "run": {"mode": "relax"}}
        self.interrupted("relax(1e-300, 1e-300, max_steps=10**9)", scene)

    def test_other_threads_run_and_the_simulation_is_one_threads(self):
        simulation = ropewalk.Simulation({**ROPE, "run": {"duration_ps": 1e6}})
        simulation.step(50)
        thread = threading.Thread(target=simulation.step, args=(100000,))
        thread.start()
        refused = 0
        while thread.is_alive():
            try:
                self.assertIn("Simulation of", repr(simulation))
                simulation.time_ps
            except ropewalk.BusyError as e:
                self.assertIn("another thread", str(e))
                refused += 1
        thread.join()
        self.assertGreater(refused, 0)
        self.assertEqual(simulation.step_number, 100050)


if __name__ == "__main__":
    unittest.main()
