#!/usr/bin/env python3
"""No file of a static library registers itself by a variable: the linker takes such a file into a program only if something else
names it, so that what the program knows would hang on how files are grouped. The registers of the libraries name their entries.

    tests/structure/registers.py SOURCE_DIR

Files that are linked as objects may: validation cases (validate/CMakeLists.txt), and examples in tests. So may a file whose
variable the link line names: --undefined=NAME in mdem/CMakeLists.txt.
"""
import re
import sys
from pathlib import Path

# A variable outside of all functions whose value is there for what making it does.
REGISTERS = re.compile(r"^(?:static |inline )*(?:const |constexpr )?(?:auto|bool|int)\s+\w+\s*(?:=[^;=]*\(|\{[^;]*\()"
                       r"|^(?:static |const )*Registered\w*\s+\w+\s*[({]", re.M)
OBJECTS = ("validate/cases/theory/", "validate/cases/atoms/", "validate/cases/codes/", "validate/cases/stability/")


def main():
    source = Path(sys.argv[1])
    wrong, known = [], 0
    named = re.findall(r"--undefined=(\w+)", (source / "mdem/CMakeLists.txt").read_text())
    for folder in ("mdem", "calibrate", "validate", "tests/examples"):
        for path in sorted((source / folder).rglob("*.?pp")):
            name = path.relative_to(source).as_posix()
            text = re.sub(r"//[^\n]*", "", path.read_text())
            for found in REGISTERS.finditer(text):
                if found[0].startswith("constexpr") or any(re.search(rf"\b{n}\b", found[0]) for n in named):
                    continue
                known += 1
                if not name.startswith(OBJECTS) and folder != "tests/examples":
                    wrong.append(f"{name}:{text.count(chr(10), 0, found.start()) + 1}: {found[0].strip()} "
                                 "registers itself, and the linker may leave this file out: name it in the register")
    if known < 30:
        wrong.append(f"only {known} files that register themselves are known: this test no longer sees them")
    print(*wrong, sep="\n", file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
