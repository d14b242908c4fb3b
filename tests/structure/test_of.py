#!/usr/bin/env python3
"""The test of a file is found from its path. That of mdem/A/B.cpp, or of its header alone, is tests/unit/A/B_test.cpp; else that
of its folder, tests/unit/A_test.cpp, and so on upwards. Where neither is, ELSEWHERE names it.

    tests/structure/test_of.py SOURCE_DIR FILE...    the test of each file
    tests/structure/test_of.py SOURCE_DIR            all of mdem/sim and mdem/model; fails on a file without a test, on a unit
                                                     test that belongs to no file or folder, and on an entry without use
"""
import sys
from pathlib import Path

ELSEWHERE = {
    "model/anharmonic": "unit/model/bond_test.cpp",
    "model/damping": "unit/forces_test.cpp",
    "model/error": "unit/io_test.cpp",
    "model/forms": "unit/model/bond_test.cpp",
    "model/parameters": "unit/io/parameters_toml_test.cpp",
    "model/segments": "unit/sim/contact/line/radial_table_test.cpp",
    "model/units": "unit/model/tube_test.cpp",
    # One body holds all that sums forces to the reference over all pairs; the motion is held to theory.
    "sim": "unit/forces_test.cpp",
    "sim/dynamics": "physics/stepping_test.cpp",
    "model/counter_random": "physics/thermostat_test.cpp",
    "sim/dynamics/fire": "physics/chain_test.cpp",
    "sim/dynamics/gauges": "physics/grip_test.cpp",
    "sim/dynamics/langevin": "physics/thermostat_test.cpp",
    "sim/dynamics/loads": "physics/grip_test.cpp",
    "sim/dynamics/relax": "physics/chain_test.cpp",
    "sim/dynamics/relax_goal": "physics/chain_test.cpp",
    "sim/dynamics/schedule": "physics/grip_test.cpp",
    "sim/dynamics/step_limit": "physics/warm_step_test.cpp",
    "sim/dynamics/thermostat": "physics/thermostat_test.cpp",
}


def name_of(path):
    """mdem/sim/a_loops-inl.hpp and mdem/sim/a.cpp belong together: sim/a."""
    stem = path.with_suffix("").as_posix()
    return stem.removesuffix("-inl").removesuffix("_loops")


def test_of(tests, name):
    while name:
        mirrored = f"unit/{name}_test.cpp"
        if (tests / mirrored).exists():
            return mirrored
        if name in ELSEWHERE:
            return ELSEWHERE[name]
        name = name.rpartition("/")[0]
    return None


def main():
    source = Path(sys.argv[1]).resolve()
    mdem, tests = source / "mdem", source / "tests"
    if sys.argv[2:]:
        for file in sys.argv[2:]:
            name = name_of(Path(file).resolve().relative_to(mdem))
            print(f"{file}: tests/{test_of(tests, name) or '(none)'}")
        return 0
    files = sorted(p.relative_to(mdem) for room in ("sim", "model") for p in (mdem / room).rglob("*.?pp"))
    names = {name_of(p) for p in files}
    errors = []
    for name in sorted(names):
        test = test_of(tests, name)
        print(f"mdem/{name}: tests/{test}")
        if not test or not (tests / test).exists():
            errors.append(f"mdem/{name} has no test; write tests/unit/{name}_test.cpp")
    for name in ELSEWHERE:
        if not (mdem / name).is_dir() and name not in names:
            errors.append(f"ELSEWHERE names {name}, which is not there")
        if (tests / f"unit/{name}_test.cpp").exists():
            errors.append(f"ELSEWHERE names {name}, which has tests/unit/{name}_test.cpp")
    for test in sorted((tests / "unit").rglob("*/*_test.cpp")):
        name = test.relative_to(tests / "unit").as_posix().removesuffix("_test.cpp")
        if not any((mdem / (name + end)).exists() for end in ("", ".cpp", ".hpp")):
            errors.append(f"tests/unit/{name}_test.cpp belongs to no file or folder mdem/{name}")
    print(*errors, sep="\n", file=sys.stderr)
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
