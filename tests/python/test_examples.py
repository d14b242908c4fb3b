"""The scripts of data/python, as users start them."""
from __future__ import annotations

import os
import pathlib
import re
import subprocess
import sys
import unittest

import numpy as np
from support import FolderTest

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "data" / "python"


class ExamplesTest(FolderTest):
    def said(self, name: str) -> list[str]:
        done = subprocess.run([sys.executable, SCRIPTS / f"{name}.py", name], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout.splitlines()

    def test_new_tube(self):
        lines = self.said("new_tube")
        self.assertEqual(lines[0], "cnt-5-5-tersoff: good")
        self.assertEqual(sum(line.endswith(": holds") for line in lines), 2)
        bound = [float(line.split()[2]) for line in lines if "hold a tube" in line]
        self.assertLess(bound[1], bound[0])
        self.assertLess(bound[0], -0.7)  # eV/nm: more than one neighbour's

    def test_twisted_rope(self):
        lines = self.said("twisted_rope")
        torque = {int(line.split()[0]): float(line.split()[2]) for line in lines if " deg " in line}
        self.assertEqual(list(torque), [15, 30, 45, 60, 75])
        self.assertEqual(sorted(torque.values()), list(torque.values()))
        rope, tubes = [float(line.split()[k]) for line in lines if "per radian" in line for k in (0, -1)]
        self.assertGreater(rope, tubes)
        self.assertLess(rope, 1.5 * tubes)
        self.assertIn("rotation_deg", np.load("twisted_rope/log.npz"))

    def test_size_sweep(self):
        lines = self.said("size_sweep")
        self.assertEqual(sum("finished" in line for line in lines), 6)
        self.assertEqual(self.said("size_sweep"), lines)

    def test_the_page_says_what_works(self):
        page = (SCRIPTS.parents[1] / "docs" / "how-to" / "python.md").read_text()
        blocks = re.findall(r"```python\n(.*?)```", page, re.S)
        self.assertGreater(len(blocks), 4)
        pathlib.Path("page.py").write_text("\n".join(blocks))
        done = subprocess.run([sys.executable, "page.py"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        promised = re.search(r"print\(e\) +# (.*)", page).group(1)
        self.assertEqual(done.stdout.splitlines()[-1], promised)

    def test_all_scripts_are_tested_and_short(self):
        names = sorted(path.stem for path in SCRIPTS.glob("*.py"))
        self.assertEqual([f"test_{name}" for name in names], sorted(n for n in dir(self) if n[5:] in names))
        for name in names:
            self.assertLess(len((SCRIPTS / f"{name}.py").read_text().splitlines()), 60)
            self.assertTrue(os.access(SCRIPTS / f"{name}.py", os.X_OK))


if __name__ == "__main__":
    unittest.main()
