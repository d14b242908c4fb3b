#!/usr/bin/env python3
"""Holds the loops that take most of a step to the instructions and the bytes that they have now.

    tests/structure/kernels.py ROPEWALK_VALIDATE

The load of the machine changes neither. Instructions are those of a step of seven tubes with AVX2, by callgrind, for three models of
`ropewalk-validate chart`. Valgrind has no AVX-512, whose loops are held by their bytes. A loop that has more fails, and so does one
that has less, until LOOPS has its new figures.

Exit code 77 where this cannot be measured: another compiler than that of the figures, no AVX2, no valgrind.
"""
import collections
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

COMPILER = "12.2."  # GCC of Debian 12
MORE, LESS = 1.02, 0.97
STEPS = {"default": 60, "finest": 30, "published": 60}  # of each model
# Loop: bytes with AVX2, bytes with AVX-512, and the instructions of a step of each model that has many.
LOOPS = {
    "segment_contact<false, 5, ropewalk::LineKernelInput<ropewalk::MixedTable, int>, float>": (4042, 3538, {"default": 91534}),
    "segment_contact<false, 0, ropewalk::LineKernelInput<ropewalk::RadialTable<double, 128, 7>, double>, double>":
        (3693, 3641, {"finest": 290025}),
    "PositionUnits": (1943, 1884, {"default": 4838}),
    "nodes::add_forces<float>": (14374, 15265, {"default": 7644}),
    "BlocksInFloats": (4084, 4329, {"default": 8679}),
    "BlocksOfState": (3083, 3443, {"finest": 53789}),
    "paper::all_elements<ropewalk::PublishedPowers, false, true, double>": (15361, 12541, {"published": 95214}),
    "(anonymous namespace)::anharmonic_forces": (10002, 9818, {"default": 8673}),
    "(anonymous namespace)::harmonic_forces": (7525, 6562, {"published": 6167}),
    "(anonymous namespace)::bond_damping": (3342, 3237, {"default": 3304}),
    "FindNear": (329, 268, {}),
}


def run(*command):
    return subprocess.run(command, check=True, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE).stdout


def loop_of(function, unit):
    """The key in LOOPS of a function of the program that is compiled for the unit v3 or v4, or None."""
    _, found, inside = function.partition(f"ropewalk::in_{unit}::")
    return next((name for name in LOOPS if found and re.match(re.escape(name) + r"[(<]", inside)), None)


def bytes_of(program):
    sizes = {}
    for line in run("nm", "--print-size", "--radix=d", "--demangle", program).splitlines():
        if defined := re.match(r"\d+ (\d+) \w (.*)", line):
            for unit in ("v3", "v4"):
                sizes[loop_of(defined.group(2), unit), unit] = int(defined.group(1))
    return sizes


def instructions_of(program, model, folder):
    """Of each loop in a step."""
    counts = Path(folder) / model
    run("valgrind", "--tool=callgrind", "--instr-atstart=no", f"--callgrind-out-file={counts}", program, "chart-steps",
        "rope7-md", model, str(STEPS[model]))
    names, sums, function, of_call = {}, collections.Counter(), None, False
    for line in counts.read_text().splitlines():
        if named := re.match(r"(c?)fn=\((\d+)\)(?: (.*))?", line):  # a name stands where its number is seen first
            called, number, name = named.groups()
            name = names.setdefault(number, name)
            function = function if called else name
        elif line.startswith("calls="):
            of_call = True  # the next line has the sum of the function called
        elif re.match(r"[-+*\d]", line):
            sums[loop_of(function, "v3")] += 0 if of_call else int(line.split()[1])
            of_call = False
    return {name: round(total / STEPS[model]) for name, total in sums.items()}


def main():
    program = Path(sys.argv[1]).resolve()
    compiler = re.search(r"GCC: \([^)]*\) (\S+)", run("readelf", "--string-dump=.comment", program))
    if not compiler or not compiler.group(1).startswith(COMPILER):
        print(f"The figures are those of GCC {COMPILER}x, and the program was compiled by another compiler.")
        return 77
    sizes = bytes_of(program)
    countable = shutil.which("valgrind") and " avx2 " in Path("/proc/cpuinfo").read_text()
    with tempfile.TemporaryDirectory() as folder:
        counts = {model: instructions_of(program, model, folder) for model in STEPS} if countable else {}
    wrong = []
    for name, (v3, v4, of_models) in LOOPS.items():
        measured = [("bytes with AVX2", v3, sizes.get((name, "v3"), 0)), ("bytes with AVX-512", v4, sizes.get((name, "v4"), 0))]
        measured += [(f"instructions in a step of model {model}, AVX2", count, counts[model].get(name, 0))
                     for model, count in of_models.items() if countable]
        for what, before, now in measured:
            print(f"{now:7} {what}; {before} in LOOPS: {name}")
            if not LESS * before <= now <= MORE * before:
                wrong.append(f"{name}: {now} {what}, and {before} in LOOPS")
    if wrong:
        print(*wrong, "Find the cause of what is more. Then write the new figures into LOOPS of tests/structure/kernels.py, and why into "
              "the commit.", sep="\n", file=sys.stderr)
        return 1
    if not countable:
        print("No instructions were counted: that takes valgrind and a processor with AVX2.")
        return 77
    return 0


if __name__ == "__main__":
    sys.exit(main())
