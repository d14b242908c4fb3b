"""Functions that the tests of the package share. PYTHONPATH names the package; they work in a folder of their own."""
from __future__ import annotations

import os
import signal
import tempfile
import unittest

import ropewalk

# Seven tubes of ten elements, twisted for 45 steps.
ROPE = {
    "parameters": "cnt-10-10-tersoff",
    "rope": {"tubes": 7, "length_nm": 14},
    "twist": {"moment_nN_nm": 5, "rate_nN_nm_per_ps": 5},
    "run": {"duration_ps": 2, "frames_every_ps": 0.5},
}

# Two straight tubes side by side, of 10 and 12 elements.
UNEQUAL = ["tube,x_nm,y_nm,z_nm,qw,qx,qy,qz"] + [
    f"{tube},{1.67 * tube},0,{1.357 * k},1,0,0,0" for tube, n in ((0, 10), (1, 12)) for k in range(n)
]


def signals_of_a_terminal(test: unittest.TestCase) -> None:
    """Until the end of the test, signals as a program finds them in a terminal, here and in programs started meanwhile.

    Under nohup HUP is ignored, and in the background of a script INT; programs inherit that.
    """
    usual = {signal.SIGINT: signal.default_int_handler, signal.SIGTERM: signal.SIG_DFL, signal.SIGHUP: signal.SIG_DFL}
    for number, handler in usual.items():
        test.addCleanup(signal.signal, number, signal.signal(number, handler))
    test.addCleanup(signal.pthread_sigmask, signal.SIG_SETMASK, signal.pthread_sigmask(signal.SIG_UNBLOCK, usual))


class FolderTest(unittest.TestCase):
    """A test in a folder of its own, which is the current one."""

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)

    def unequal_scene(self) -> ropewalk.Scene:
        with open("unequal.csv", "w", encoding="utf-8") as file:
            file.write("\n".join(UNEQUAL) + "\n")
        return ropewalk.Scene({
            "parameters": "cnt-10-10-tersoff", "state": {"file": "unequal.csv"}, "run": {"duration_ps": 1},
        })
