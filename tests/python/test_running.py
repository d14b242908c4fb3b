"""Runs in this process: the files of the program, interruption, errors, threads."""
from __future__ import annotations

import json
import logging
import multiprocessing
import os
import pathlib
import signal
import subprocess
import threading
import time
import unittest
from unittest import mock

from support import ROPE, FolderTest, signals_of_a_terminal

import ropewalk
from ropewalk.programs import find_program

LONG = {**ROPE, "run": {"duration_ps": 1e6}}


def contents(folder: str) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in pathlib.Path(folder).iterdir()}


class RunningTest(FolderTest):
    def written_by(self, name: str, *arguments: str) -> dict[str, bytes]:
        subprocess.run([find_program(), *arguments], check=True, capture_output=True)
        return contents(name)

    # But for the times of the clock and the name of the program, in manifest, checkpoint and report.
    def assert_same_files(self, mine: dict[str, bytes], theirs: dict[str, bytes]) -> None:
        self.assertEqual(set(mine), set(theirs))
        for name in set(mine) - {"manifest.json", "checkpoint.bin", "checkpoint-before.bin", "report.html"}:
            self.assertEqual(mine[name], theirs[name], name)
        manifests = [json.loads(files["manifest.json"]) for files in (mine, theirs)]
        for manifest in manifests:
            del manifest["started"], manifest["wall_seconds"], manifest["program"]
        self.assertEqual(*manifests)

    def test_the_directory_is_that_of_the_program(self):
        pathlib.Path("rope.toml").write_text(ropewalk.Scene(ROPE).text)
        theirs = self.written_by("program", "run", "rope.toml", "--out", "program", "--threads", "1")
        ropewalk.run("rope.toml", "mine", threads=1)
        self.assert_same_files(contents("mine"), theirs)
        self.assertEqual(ropewalk.open("mine").simulation().checkpoint(),
                         ropewalk.open("program").simulation().checkpoint())

    def test_a_relaxation_is_that_of_the_program(self):
        scene = {**ROPE, "run": {"mode": "relax", "max_steps": 20}}
        del scene["twist"]
        pathlib.Path("rope.toml").write_text(ropewalk.Scene(scene).text)
        subprocess.run([find_program(), "run", "rope.toml", "--out", "program", "--threads", "1"], capture_output=True)
        with self.assertLogs("ropewalk", "WARNING") as logged:
            run = ropewalk.run("rope.toml", "mine", threads=1)
        self.assertEqual(run.status, "not relaxed")
        self.assertTrue(any("not relaxed after 20 steps" in line for line in logged.output), logged.output)
        self.assert_same_files(contents("mine"), contents("program"))

    def test_program_and_package_go_on_with_each_other(self):
        whole = ropewalk.run(ROPE, "whole", threads=1)
        ropewalk.run(ROPE, "mine", steps=20, threads=2)
        self.written_by("mine", "resume", "mine", "--threads", "1")
        self.assertEqual(pathlib.Path("mine/log.csv").read_bytes(), pathlib.Path("whole/log.csv").read_bytes())
        pathlib.Path("rope.toml").write_text(whole.scene.text)
        self.written_by("theirs", "run", "rope.toml", "--out", "theirs", "--steps", "20")
        ropewalk.resume("theirs", threads=2)
        self.assertEqual(pathlib.Path("theirs/log.csv").read_bytes(), pathlib.Path("whole/log.csv").read_bytes())

    def test_no_program_is_started(self):
        refused = AssertionError("a program was started")
        with mock.patch("subprocess.Popen", side_effect=refused), mock.patch("os.fork", side_effect=refused), \
                mock.patch.dict(os.environ, {"PATH": ""}):
            run = ropewalk.run(ROPE, "run", steps=20)
            self.assertEqual(ropewalk.resume("run", until_ps=1.5).status, "finished")
        self.assertGreater(run.log["time_ps"][-1], 1.4)

    def interrupt_when(self, path: str) -> None:
        signals_of_a_terminal(self)

        def wait_and_interrupt() -> None:
            while not os.path.exists(path):
                time.sleep(0.01)
            os.kill(os.getpid(), signal.SIGINT)

        threading.Thread(target=wait_and_interrupt).start()

    def test_ctrl_c_leaves_a_run_to_resume(self):
        self.interrupt_when("run/checkpoint.bin")
        with self.assertRaises(KeyboardInterrupt):
            ropewalk.run(LONG, "run")
        run = ropewalk.open("run")
        self.assertEqual(run.status, "interrupted")
        self.assertRegex(run.manifest["reason"], r"^stopped by signal 2 at \d")
        steps = run.manifest["steps"]
        self.interrupt_when("run/lock")
        with self.assertRaises(KeyboardInterrupt):
            ropewalk.resume("run")
        self.assertGreaterEqual(ropewalk.open("run").manifest["steps"], steps)
        steps = ropewalk.open("run").manifest["steps"] + 5
        again = ropewalk.resume("run", steps=steps)
        self.assertEqual(again.manifest["steps"], steps)
        ropewalk.run(LONG, "whole", steps=steps)
        self.assertEqual(pathlib.Path("whole/final.csv").read_bytes(), pathlib.Path("run/final.csv").read_bytes())

    def test_other_threads_go_on_meanwhile(self):
        counted, ends = [0], threading.Event()

        def count() -> None:
            while not ends.is_set():
                counted[0] += 1
                time.sleep(0.001)

        thread = threading.Thread(target=count)
        thread.start()
        began, before = time.monotonic(), counted[0]
        ropewalk.run(LONG, "run", wall_time_s=1, threads=1)
        passed, seen = time.monotonic() - began, counted[0] - before
        ends.set()
        thread.join()
        self.assertGreater(seen, 5 * passed)
        self.assertEqual(ropewalk.open("run").status, "interrupted")
        self.assertIn("by --wall-time", ropewalk.open("run").manifest["reason"])

    def test_two_runs_at_once(self):
        threads = [threading.Thread(target=ropewalk.run, args=(ROPE, name), kwargs={"threads": 1}) for name in "ab"]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assert_same_files(contents("a"), contents("b"))

    def test_progress(self):
        seen = []
        ropewalk.run({**ROPE, "run": {"duration_ps": 1e6}}, "run", wall_time_s=2,
                     progress=lambda *what: seen.append(what))
        self.assertGreaterEqual(len(seen), 1)
        for step, last, words in seen:
            self.assertLess(0, step)
            self.assertLess(step, last)
            self.assertIn("beta", words)

    def test_what_progress_raises_is_raised(self):
        def fail(*_: object) -> None:
            raise RuntimeError("enough")

        with self.assertRaisesRegex(RuntimeError, "enough"):
            ropewalk.run(LONG, "run", progress=fail)
        self.assertRegex(ropewalk.open("run").manifest["reason"], "^stopped by RuntimeError at")
        steps = ropewalk.open("run").manifest["steps"] + 1
        self.assertEqual(ropewalk.resume("run", steps=steps).manifest["steps"], steps)

    def test_a_failure_of_the_calculation(self):
        torn = {**ROPE, "parameters": "cnt-10-10-paper", "twist": {
            "application": "tangential", "moment_nN_nm": 20000, "rate_nN_nm_per_ps": 50000, "hold_ps": 2}}
        del torn["run"]
        with self.assertLogs("ropewalk") as logged, self.assertRaises(ropewalk.NumericalError) as caught:
            ropewalk.run(torn, "run")
        self.assertGreater(caught.exception.step, 0)
        run = ropewalk.open("run")
        place, _, why = run.manifest["reason"].partition(": ")
        self.assertEqual((run.status, why), ("failed", str(caught.exception).partition(": ")[2]))
        self.assertRegex(place, r"step \d+, tube \d+, element \d+")
        self.assertIn("state written to run/failed-state.csv", logged.output[-1])
        self.assertTrue(os.path.exists("run/failed-state.csv"))

    def test_wrong_options(self):
        for wrong, words in (({"steps": -1}, "steps: is -1"), ({"until_ps": -2.0}, "until_ps: is -2"),
                             ({"threads": 0}, "threads: is 0"), ({"steps": 1, "until_ps": 1}, "steps: does not go"),
                             ({"on_limit": "nothing"}, "there is no 'nothing'"), ({"wall_time_s": 0}, "wall_time_s: is 0"),
                             ({"instructions": "Z80"}, 'instructions: there is no "Z80"')):
            with self.subTest(words), self.assertRaisesRegex(ropewalk.InputError, words):
                ropewalk.run(ROPE, "run", **wrong)
        self.assertFalse(os.path.exists("run"))

    def test_a_device(self):
        ropewalk.run(ROPE, "device", device="c++", steps=4)
        self.assertIn("kernels of a device", ropewalk.open("device").manifest["device"])
        ropewalk.resume("device", steps=6)
        with self.assertRaisesRegex(ropewalk.InputError, "no device is named"):
            ropewalk.run(ROPE, "none", device="abacus", steps=2)

    def test_threads_of_a_process_have_instructions_of_their_own(self):
        scene = {**ROPE, "rope": {"tubes": 19, "length_nm": 20}, "run": {"duration_ps": 0.3, "log_every_ps": 0.1}}
        sets = ("baseline", "AVX2", "baseline")
        for k, name in enumerate(sets):
            ropewalk.run(scene, f"alone{k}", instructions=name)
        threads = [threading.Thread(target=ropewalk.run, args=(scene, f"beside{k}"), kwargs={"instructions": name})
                   for k, name in enumerate(sets)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for k, name in enumerate(sets):
            self.assertEqual(ropewalk.open(f"beside{k}").manifest["instructions"], name)
            alone, beside = (pathlib.Path(f"{where}{k}/final.csv").read_text() for where in ("alone", "beside"))
            self.assertEqual(alone, beside, name)
        self.assertNotEqual(*(pathlib.Path(f"beside{k}/final.csv").read_text() for k in (0, 1)))

    def test_threads_and_instructions_are_as_before(self):
        before = ropewalk.threads(), ropewalk._core.instructions()
        ropewalk.run(ROPE, "run", threads=before[0] + 1, steps=2)
        self.assertEqual(ropewalk.open("run").manifest["threads"], before[0] + 1)
        ropewalk.run(ROPE, "other", instructions="baseline", steps=2)
        self.assertEqual(ropewalk.open("other").manifest["instructions"], "baseline")
        ropewalk.resume("other", steps=4)
        self.assertEqual(ropewalk.open("other").manifest["instructions"], "baseline")
        self.assertEqual((ropewalk.threads(), ropewalk._core.instructions()), before)

    def test_a_forked_process_runs_on_one_thread(self):
        ropewalk.run(ROPE, "here", threads=2)
        process = multiprocessing.get_context("fork").Process(target=ropewalk.run, args=(ROPE, "there"),
                                                              kwargs={"threads": 2})
        process.start()
        process.join(300)
        self.assertEqual(process.exitcode, 0)
        self.assertEqual(ropewalk.open("there").manifest["threads"], 1)

    def test_a_run_that_is_at_work_is_locked(self):
        os.mkdir("run")
        thread = threading.Thread(target=ropewalk.run, args=(LONG, "run"), kwargs={"wall_time_s": 1})
        thread.start()
        while not os.path.exists("run/checkpoint.bin"):
            time.sleep(0.01)
        with self.assertRaisesRegex(ropewalk.InputError, "is in use by process"):
            ropewalk.resume("run")
        thread.join()

    def test_refined_runs_go_on_beside(self):
        logging.getLogger("ropewalk").setLevel(logging.ERROR)
        self.addCleanup(logging.getLogger("ropewalk").setLevel, logging.NOTSET)
        run = ropewalk.run({**ROPE, "limits": {"bend_deg": 0.01}}, "run", on_limit="refine")
        self.assertEqual(run.status, "refined")
        self.assertTrue(os.path.isdir("run.fine"))


if __name__ == "__main__":
    unittest.main()
