"""Programs as functions: run, resume, sweep, gather, validate, and how their ends are told."""
from __future__ import annotations

import ast
import json
import math
import os
import pathlib
import signal
import subprocess
import sys
import time
import unittest

import numpy as np
from support import ROPE, FolderTest, signals_of_a_terminal

import ropewalk


def described_options(*program: str) -> dict[str, dict[str, str]]:
    """Of each verb of a program: its options, with their defaults. "": options without a verb."""
    found = json.loads(subprocess.run([ropewalk.programs.find_program(), *program, "describe", "json"], check=True,
                                      capture_output=True, text=True).stdout)
    return {verb.get("name", ""): {name: option["default"] for option in verb["options"] for name in option["names"]}
            for verb in [*found["verbs"], {"options": found["options"]}]}


class OptionsTest(unittest.TestCase):
    """The signatures are written by hand, for type checkers and editors: they may not differ from the programs' tables of options."""

    def test_options_and_defaults_are_those_of_the_programs(self):
        own, validate = described_options(), described_options("validate")
        tables = {"calibrate": described_options("calibrate")[""], "validate run": validate["run"],
                  "parametrize": validate["parametrize"]}
        options, defaults = 0, 0
        for function in ast.parse(pathlib.Path(ropewalk.__path__[0], "programs.py").read_text()).body:
            if not isinstance(function, ast.FunctionDef) or function.name.startswith("_"):
                continue
            arguments = function.args
            default_of = {a.arg: d.value for a, d in zip(arguments.kwonlyargs, arguments.kw_defaults)
                          if isinstance(d, ast.Constant)}
            words = [node.value for node in ast.walk(function)
                     if isinstance(node, ast.Constant) and isinstance(node.value, str)]
            verb = "validate run" if function.name == "validate" else function.name
            known = tables[verb] if verb in tables else own.get(verb, {})
            with self.subTest(function.name):
                for word in words:
                    if word.startswith("--"):
                        self.assertIn(word.split("=")[0], known)
                for call in ast.walk(function):
                    if not (isinstance(call, ast.Call) and getattr(call.func, "id", "") == "_options"):
                        continue
                    for keyword in call.keywords:
                        if keyword.arg is None:
                            continue
                        option = "--" + keyword.arg.replace("_", "-")
                        self.assertIn(option, known)
                        options += 1
                        default = default_of.get(getattr(keyword.value, "id", ""))
                        if default is not None and default is not False:
                            self.assertEqual(str(default), known[option], option)
                            defaults += 1
        self.assertGreater(options, 50)
        self.assertGreater(defaults, 8)


class ProgramsTest(FolderTest):
    def test_run_and_resume(self):
        first = ropewalk.run(ROPE, "run", steps=20, threads=1)
        self.assertEqual((first.log["step"][-1], first.scene.name), (20, "scene"))
        self.assertIs(type(ropewalk.resume("run")), ropewalk.Run)
        self.assertEqual(pathlib.Path("run/log.csv").read_text(),
                         pathlib.Path(ropewalk.run(ROPE, "whole").path, "log.csv").read_text())

    def test_a_directory_is_not_overwritten(self):
        ropewalk.run(ROPE, "run", steps=1)
        with self.assertRaisesRegex(ropewalk.InputError, "^run: --out: is not empty"):
            ropewalk.run(ROPE, "run", steps=1)
        self.assertEqual(ropewalk.run(ROPE, "run", steps=2, force=True).log["step"][-1], 2)

    def test_errors_name_no_temporary_file(self):
        # Found while the scene is read, prepared, and started.
        slipping = np.zeros((1, 5, 4))
        slipping[..., 0], slipping[..., 3] = np.cos(np.arange(5)), np.sin(np.arange(5))
        ropewalk.write_state("slipping.csv", [[[0, 0, 1.378 * k] for k in range(5)]], slipping)
        scene = {"parameters": "cnt-10-10-tersoff", "run": {"duration_ps": 1}}
        for wrong, words in (({"rope": {"tubes": 8, "length_nm": 14}}, "scene: rope.tubes: is 8"),
                             ({**ROPE, "run": {"duration_ps": 2, "time_step_fs": 900}}, "scene: run.time_step_fs: 900"),
                             ({"state": {"file": "slipping.csv"}}, "scene: state: the bond after element 0")):
            with self.assertRaises(ropewalk.InputError) as caught:
                ropewalk.run({**scene, **wrong}, "run")
            self.assertIn(words, str(caught.exception))
            self.assertNotIn("/tmp", str(caught.exception))
        self.assertFalse(os.path.exists("run"))

    def test_notes_are_logged(self):
        with self.assertLogs("ropewalk", "WARNING") as logged:
            ropewalk.run({**ROPE, "limits": {"bend_deg": 0.01}}, "run")
        self.assertTrue(any("limits.bend_deg" in line for line in logged.output), logged.output)

    def test_a_run_that_ends_at_a_limit_is_returned(self):
        with self.assertLogs("ropewalk"):
            run = ropewalk.run({**ROPE, "limits": {"bend_deg": 0.01}}, "run", on_limit="stop")
        self.assertEqual(run.status, "stopped")
        self.assertTrue(any(limit["passed"] for limit in run.limits))

    def test_sweep_and_gather(self):
        campaign = ropewalk.sweep(ROPE, {"rope.tubes": [1, 7], "twist.moment_nN_nm": {"from": 4, "to": 5, "points": 2}},
                                  "campaign")
        self.assertEqual(list(campaign.table["rope.tubes"]), [1, 1, 7, 7])
        self.assertEqual(list(campaign.table["twist.moment_nN_nm"]), [4, 5, 4, 5])
        self.assertEqual(len(campaign.runs), 4)
        for name, run in campaign.runs.items():
            row = list(campaign.table["point"]).index(name)
            self.assertEqual(run.log["twist_eV"][-1], campaign.table["twist_eV"][row])
        series = ropewalk.gather(campaign, series=True, columns=["beta_deg"])
        self.assertEqual(len(series["beta_deg"]), sum(run.log.rows for run in campaign.runs.values()))
        before = os.stat("campaign/points/" + next(iter(campaign.runs)) + "/log.csv").st_mtime_ns
        ropewalk.sweep(ROPE, {"rope.tubes": [1, 7], "twist.moment_nN_nm": {"from": 4, "to": 5, "points": 2}}, "campaign")
        self.assertEqual(before, os.stat("campaign/points/" + next(iter(campaign.runs)) + "/log.csv").st_mtime_ns)
        with self.assertRaisesRegex(ropewalk.InputError, "tubs"):
            ropewalk.sweep(ROPE, {"rope.tubs": [1, 7]}, "other")

    def test_threshold_and_compare(self):
        tube = {"parameters": "cnt-10-10-paper", "rope": {"tubes": 1, "length_nm": 13.56}, "damping": {"bond_damping_per_ps": 4},
                "grip": [{"end": "lower"}, {"end": "upper", "about_z": {"rotation_deg": [[0, 0], [60, 20]]}}],
                "run": {"duration_ps": 70, "log_every_ps": 1}}
        found = ropewalk.threshold(tube, "rope.length_nm", (7.1, 37), "torque_upper_nN_nm", 5.5, "search", accuracy=0.05)
        critical, = found["by_bisection"]
        self.assertAlmostEqual(critical, 319.5 * math.radians(20) / 5.5, delta=1.6)  # lengths go by elements
        one, other = ropewalk.run(ROPE, "one"), ropewalk.run(ropewalk.Scene(ROPE).changed({"twist.moment_nN_nm": 4}), "other")
        curves = ropewalk.compare([one, other.path], y=["twist_eV", "beta_deg"], page="both.html")
        self.assertIn("<svg", pathlib.Path("both.html").read_text())
        self.assertTrue(any("beta_deg" in name for name in curves), list(curves))

    def test_pictures_pages_and_formats(self):
        run = ropewalk.run(ROPE, "run")
        self.assertIn("<svg", pathlib.Path(ropewalk.picture(run, "a.svg", at_ps=[0, 1.5], curves=["beta_deg"])).read_text())
        self.assertTrue(os.path.exists(ropewalk.convert(run, "a.lammpstrj", from_ps=1)))
        self.assertEqual(ropewalk.view(run, frames=3), "run/view.html")
        with self.assertRaisesRegex(ropewalk.InputError, "exists"):
            ropewalk.convert(run, "a.lammpstrj")

    def test_errors_of_a_run(self):
        run = ropewalk.run({**ROPE, "rope": {"tubes": 1, "length_nm": 7}, "run": {"duration_ps": 0.5}}, "run")
        found = ropewalk.errors(run)
        self.assertTrue(os.path.exists("run/errors.csv"))
        self.assertTrue(found)
        whole = ropewalk.errors(run, numerics=True)["at_the_end"]["kinetic_eV"]
        self.assertGreaterEqual(whole["error"], whole["numerics"])

    def test_modes(self):
        # A free tube under couples: a straight one is at rest, and its fastest motion is a helix from 8.987 EI/L = 79.2 nN nm on.
        tube = {"rope": {"tubes": 1, "length_nm": 40.68}, "parameters": "cnt-10-10-paper",
                "twist": {"moment_nN_nm": 1, "rate_nN_nm_per_ps": 0, "hold_ps": 1}}
        found = ropewalk.modes(tube, count=3, shift_per_ns=30, anyway=True)
        # A neutral motion may be found twice, as a pair of next to no frequency.
        self.assertIn(len(found["rate_per_ns"]), (2, 3))
        self.assertTrue((found["neutral"] == 1).all(), found)
        run = ropewalk.run({**tube, "run": {"duration_ps": 0.1}}, "run")
        self.assertIn(len(ropewalk.modes(run, count=2, anyway=True)["rate_per_ns"]), (1, 2))

    def test_rest(self):
        rope = {"rope": {"tubes": 7, "length_nm": 20.34}, "parameters": "cnt-10-10-paper",
                "twist": {"moment_nN_nm": 35, "rate_nN_nm_per_ps": 1, "hold_ps": 2}}
        found = ropewalk.rest(rope, "rest")
        self.assertEqual([side["from"] for side in found["sides"]], ["below", "above"])
        self.assertFalse(found["agree"])
        self.assertIsNone(found["beta_deg"])
        self.assertEqual(ropewalk.rest(rope, "rest"), found)

    def test_validate(self):
        case, = ropewalk.validate(["ring-energy"], parameters="cnt-5-5-tersoff", out="validation")
        self.assertTrue(case.holds)
        self.assertTrue(os.path.exists(case.report))
        check = case.checks[0]
        self.assertLessEqual(abs(check.value / check.reference - 1), check.tolerance)
        with self.assertRaisesRegex(ropewalk.InputError, 'did you mean "ring-energy"'):
            ropewalk.validate(["ring-enery"], out="validation")

    def test_parameter_sets(self):
        self.assertIn("cnt-10-10-tersoff", ropewalk.parameter_sets())
        tube = ropewalk.ParameterSet("cnt-10-10-tersoff")
        self.assertEqual((tube["bond.GJ"].unit, tube.grade), ("nN nm^2", "good"))
        self.assertAlmostEqual(tube["bond.GJ"].value, 330.11, places=2)
        self.assertGreater(tube["bond.GJ"].standard_error, 0)
        with self.assertRaisesRegex(ropewalk.InputError, "no parameter set"):
            ropewalk.ParameterSet("cnt-99-99")

    def test_a_changed_set(self):
        tube = ropewalk.ParameterSet("cnt-10-10-tersoff")
        other = tube.changed(EA=650, out="mine.toml")
        self.assertEqual((other.name, other["bond.EA"].value, other["bond.EA"].origin), ("mine", 650, "chosen"))
        changed = ("bond.EA",)
        self.assertEqual({k: v for k, v in other.items() if k not in changed},
                         {k: v for k, v in tube.items() if k not in changed})
        with open(tube.path) as file, open("older.toml", "w") as older:
            older.writelines(line for line in file if not line.startswith(("start ", "edge_force ")))
        self.assertNotIn("bond.pull.edge_force", ropewalk.ParameterSet("older.toml"))
        again = ropewalk.ParameterSet("older.toml").changed(EA=650, out="mine-too.toml")
        self.assertAlmostEqual(again["bond.pull.edge_force"].value, other["bond.pull.edge_force"].value, places=9)
        scene = ropewalk.Scene({**ROPE, "parameters": "mine.toml"})
        self.assertEqual(ropewalk.run(scene, "run").status, "finished")
        for changes, words in (({"EB": 1, "out": "b.toml"}, "no number"), ({"EA": 1, "out": "mine.toml"}, "exists"),
                               ({"EA": -1, "out": "b.toml"}, "bond.EA"), ({"EA": 1}, "name the file")):
            with self.assertRaisesRegex(ropewalk.InputError, words):
                tube.changed(**changes)
        self.assertFalse(os.path.exists("b.toml"))

    def test_parametrize_says_what_is_wrong(self):
        with self.assertRaises(ropewalk.Error):
            ropewalk.parametrize([(0, 0)], "never")

    def test_calibrate_says_what_is_wrong(self):
        with self.assertRaises(ropewalk.InputError):
            ropewalk.calibrate((0, 0), "never.toml")
        self.assertFalse(os.path.exists("never.toml"))

    def test_ctrl_c_leaves_a_run_to_resume(self):
        signals_of_a_terminal(self)
        code = f"import ropewalk; ropewalk.run({ {**ROPE, 'run': {'duration_ps': 1e6}} !r}, 'run')"
        process = subprocess.Popen([sys.executable, "-c", code], stderr=subprocess.PIPE, text=True,
                                   start_new_session=True)
        self.addCleanup(process.kill)
        while not os.path.exists("run/checkpoint.bin"):
            self.assertIsNone(process.poll())
            time.sleep(0.02)
        os.killpg(process.pid, signal.SIGINT)  # as a terminal does
        _, told = process.communicate(timeout=100)
        self.assertIn("KeyboardInterrupt", told)
        run = ropewalk.open("run")
        self.assertEqual(run.status, "interrupted")
        steps = run.manifest["steps"]
        self.assertEqual(ropewalk.resume("run", steps=steps + 5).manifest["steps"], steps + 5)


if __name__ == "__main__":
    unittest.main()
