#!/usr/bin/env python3
"""Holds the sources to one place that removes directories with their content and makes temporary ones: mdem/io/removal.cpp.

    tests/structure/removal.py SOURCE_DIR

Elsewhere a call of remove_all may delete files of the user, and a name in TMPDIR that can be guessed may be somebody else's.
Files that are written in place are opened by opened_to_write() of mdem/io/files.cpp, which follows no links.
"""
import re
import sys
from pathlib import Path

FORBIDDEN = {
    r"\bremove_all\s*\(": ("mdem/io/removal.cpp", "remove what is known by name: remove_inside(), remove_run()"),
    r"\bmkdtemp\s*\(|\bmkstemp\s*\(|\btmpnam\b|\btemp_directory_path\s*\(|\"TMPDIR\"":
        ("mdem/io/removal.cpp", "take a TemporaryFolder"),
    r"\bO_CREAT\b(?![^;]*(?:O_EXCL|O_NOFOLLOW))|\bfreopen\s*\((?!\"/dev/null\")|\bofstream\b":
        ("calibrate/atomistic/child_process.cpp", "take opened_to_write() or write_file_atomically()"),
}
# A file in a folder that was made for it, or one that the user names; written by no path that others know.
ALSO = {"validate/parametrize/parametrize.cpp", "mdem/lammps/fix_states.cpp"}


def main():
    source = Path(sys.argv[1])
    wrong, calls = [], 0
    for folder in ("mdem", "calibrate", "validate"):
        for path in sorted((source / folder).rglob("*.?pp")):
            name = path.relative_to(source).as_posix()
            text = re.sub(r"//[^\n]*", "", path.read_text())
            for pattern, (place, remedy) in FORBIDDEN.items():
                for found in re.finditer(pattern, text):
                    calls += "remove_all" in found[0]
                    if name != place and name not in ALSO:
                        line = text.count("\n", 0, found.start()) + 1
                        wrong.append(f"{name}:{line}: {found[0].strip()} belongs into {place}: {remedy}")
    if calls != 1:
        wrong.append(f"remove_all is called in {calls} places, not in one")
    print(*wrong, sep="\n", file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
