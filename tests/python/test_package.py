"""The package as a whole: everything public is typed and documented, with units and shapes."""
from __future__ import annotations

import dataclasses
import inspect
import os
import re
import subprocess
import sys
import tempfile
import unittest

from support import ROPE

import ropewalk

UNIT = re.compile(r"\b(nm|ps|fs|eV|nN|rad|deg|s)\b|\bunits?\b")
SHAPE = re.compile(r"\([^)]*\b(elements|tubes|rows|points|3)\b[^)]*\)")
QUANTITY = re.compile(r"float|Floats|NDArray|State\b|Log\b|Frames?\b|Energies")


def public_callables():
    """(name, function, whether it is one of a class) of everything that a user may call."""
    for name in ropewalk.__all__:
        thing = getattr(ropewalk, name)
        if not inspect.isclass(thing):
            yield name, thing
            continue
        for member, value in vars(thing).items():
            if dataclasses.is_dataclass(thing) and member in ("__init__", "__repr__", "__eq__", "__setattr__", "__delattr__"):
                continue
            if issubclass(thing, tuple) or hasattr(thing, "__total__") or member in ("__hash__", "__module__"):
                continue
            if isinstance(value, property):
                yield f"{name}.{member}", value.fget
            elif member.startswith("_") and not member.startswith("__"):
                continue
            elif isinstance(value, (classmethod, staticmethod)):
                yield f"{name}.{member}", value.__func__
            elif inspect.isfunction(value):
                yield f"{name}.{member}", value


class PackageTest(unittest.TestCase):
    def test_every_public_name_is_there(self):
        self.assertGreater(len(ropewalk.__all__), 25)
        for name in ropewalk.__all__:
            self.assertTrue(hasattr(ropewalk, name), name)

    def test_nothing_internal_is_shown(self):
        self.assertEqual([n for n in dir(ropewalk) if not n.startswith("__")], sorted(ropewalk.__all__))

    def test_a_decimal_comma_changes_nothing(self):
        with tempfile.TemporaryDirectory() as folder:
            made = subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8", f"{folder}/de_DE.UTF-8"], capture_output=True)
            if made.returncode != 0:
                self.skipTest("the locale de_DE cannot be made: package locales")
            code = ("import locale, os, ropewalk\n"
                    "if os.environ.get('LC_ALL'): assert locale.setlocale(locale.LC_ALL, '') and locale.str(1.5) == '1,5'\n"
                    f"run = ropewalk.run({ROPE!r}, os.environ['OUT'])\n"
                    "ropewalk.write_state(os.environ['OUT'] + '/s.csv', run.frames[-1].position, run.frames[-1].orientation)\n"
                    "state = ropewalk.Scene({'parameters': 'cnt-10-10-tersoff', 'state': {'file': os.environ['OUT'] + '/final.csv'},"
                    " 'run': {'duration_ps': 1}}).start\n"
                    "print(*[ropewalk.ParameterSet(n).grade for n in ropewalk.parameter_sets()], run.log['twist_eV'][-1],"
                    " ropewalk.energy(run.scene).total, state.position.sum())\n"
                    "print(open(os.environ['OUT'] + '/log.csv').read())")
            said = [subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True,
                                   env={**os.environ, **env, "OUT": f"{folder}/{n}"}).stdout
                    for n, env in enumerate(({"LC_ALL": ""}, {"LC_ALL": "de_DE.UTF-8", "LOCPATH": folder}))]
        self.assertIn("good", said[0])
        self.assertEqual(*said)

    def test_everything_is_annotated(self):
        seen = 0
        for name, function in public_callables():
            signature = inspect.signature(function)
            with self.subTest(name):
                self.assertIsNot(signature.return_annotation, inspect.Signature.empty)
                for parameter in list(signature.parameters.values()):
                    if parameter.name not in ("self", "cls"):
                        self.assertIsNot(parameter.annotation, inspect.Parameter.empty, parameter.name)
            seen += 1
        self.assertGreater(seen, 100)

    def test_everything_is_documented_with_units_and_shapes(self):
        for name, function in public_callables():
            if issubclass(getattr(ropewalk, name.split(".")[0], int) if "." in name else int, ropewalk.Error):
                continue
            signature = inspect.signature(function)
            with self.subTest(name):
                text = function.__doc__ or ""
                self.assertTrue(text, "no docstring")
                returned = str(signature.return_annotation)
                if QUANTITY.search(returned) and not name.endswith("__init__"):
                    self.assertRegex(text, UNIT)
                if "Floats" in returned or "NDArray" in returned:
                    if "dict" not in returned or name == "gather":
                        self.assertRegex(text, SHAPE)
                for parameter in signature.parameters.values():
                    documented = [p for p in signature.parameters if p not in ("self", "cls")]
                    if parameter.name in documented and not name.split(".")[-1].startswith("__get"):
                        if name.split(".")[-1] in ("__contains__", "divided"):
                            continue
                        self.assertIn(parameter.name, text)
                        if "float" in str(parameter.annotation):
                            line = next(l for l in text.splitlines() if re.match(rf"\s+.*\b{parameter.name}\b.*:", l))
                            self.assertRegex(line, UNIT)

    def test_fields_of_records_are_documented_with_units(self):
        for name in ropewalk.__all__:
            thing = getattr(ropewalk, name)
            if not inspect.isclass(thing):
                continue
            fields = []
            if dataclasses.is_dataclass(thing):
                fields = [f for f in vars(thing).get("__annotations__", {})]
            elif issubclass(thing, (tuple, dict)):
                fields = list(thing.__annotations__)
            for field in fields:
                with self.subTest(f"{name}.{field}"):
                    self.assertRegex(thing.__doc__, rf"\b{field}\b")

    def test_help_shows_units_and_shapes(self):
        self.assertIn("(tubes, elements, 3), nm", inspect.getdoc(ropewalk.State.position))
        self.assertIn("eV/nm", inspect.getdoc(ropewalk.Simulation.force))

    def test_types_hold(self):
        folder = os.path.dirname(ropewalk.__file__)
        if subprocess.run([sys.executable, "-c", "import mypy"], capture_output=True).returncode != 0:
            self.skipTest("mypy is not installed")
        checked = subprocess.run(
            [sys.executable, "-m", "mypy", "--strict", "--cache-dir", os.devnull, folder], capture_output=True, text=True,
            env={k: v for k, v in os.environ.items() if k != "PYTHONPATH"},
        )
        self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)

    def test_import_leaves_the_environment_alone(self):
        code = "import os; before = dict(os.environ); import ropewalk; assert dict(os.environ) == before"
        subprocess.run([sys.executable, "-c", code], check=True)

    def test_import_loads_nothing_heavy(self):
        code = "import sys, ropewalk; print([m for m in ('matplotlib', 'scipy', 'unittest.mock') if m in sys.modules])"
        said = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True).stdout
        self.assertEqual(said.strip(), "[]")


if __name__ == "__main__":
    unittest.main()
