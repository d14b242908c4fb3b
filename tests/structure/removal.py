#!/usr/bin/env python3
"""Holds the sources to one place that removes directories with their content and makes temporary ones, mdem/io/removal.cpp,
and to one that makes files under names made from others' and renames them, mdem/io/files.cpp.

    tests/structure/removal.py SOURCE_DIR

Elsewhere a call of remove_all may delete files of the user, a name in TMPDIR that can be guessed may be somebody else's,
and "fig.png" + ".svg" may be the user's. Files that are written in place are opened by opened_to_write() of
mdem/io/files.cpp, which follows no links.
"""
import re
import sys
from pathlib import Path

FORBIDDEN = {
    r"\bremove_all\s*\(": ("mdem/io/removal.cpp", "remove what is known by name: remove_inside(), remove_run()"),
    r"\bmkdtemp\s*\(|\bmkstemp\s*\(|\btmpnam\b|\btemp_directory_path\s*\(|\"TMPDIR\"":
        ("mdem/io/removal.cpp", "take a TemporaryFolder"),
    r"\bO_CREAT\b(?![^;]*(?:O_EXCL|O_NOFOLLOW))|\bfreopen\s*\((?!\"/dev/null\")|\bofstream\b":
        ("mdem/atoms/child_process.cpp", "take opened_to_write() or write_file_atomically()"),
    r"\brename\s*\(": ("mdem/io/files.cpp", "take a Draft, or rename_whole()"),
}
# A file in a folder that was made for it, or one that the user names; written by no path that others know.
ALSO = {"validate/parametrize/parametrize.cpp", "mdem/lammps/fix_states.cpp"}

# A path with an ending behind it; a variable that has such a path; a call that writes or removes it.
ENDING = r'(?:\+\s*"[.~-][\w.~-]*"|fmt::format\(\s*"[^"]*\}[.~-][\w.~-]+")'
VARIABLE = re.compile(r"\b(\w+)\s*=\s*[^;{}]*?" + ENDING)
CALL = re.compile(r"\b(?:write_file_atomically|opened_to_write|GrowingFile|frame_writer|remove|remove_run|unlink|freopen|fopen|"
                  r"copy|copy_file|run_program|run_child)\s*\(([^;]*);")
FOLDER = "in a folder that was made for these files"
RESULT = "a result, which the manual names and which replaces no file of another kind"
MAY_APPEND = {
    "mdem/campaign/pilot_runs.cpp": FOLDER,
    "mdem/commands/convert.cpp": FOLDER,
    "mdem/atoms/lammps.cpp": FOLDER,
    "calibrate/friction/sliding.cpp": FOLDER,
    "validate/cases/common/lammps_session.cpp": FOLDER,
    "mdem/commands/new.cpp": RESULT,
    "calibrate/verbs/friction.cpp": RESULT,
    "calibrate/verbs/show.cpp": RESULT,
    "validate/chart/run.cpp": RESULT,
    "validate/core/reference.cpp": RESULT,
    "validate/parametrize/parametrize.cpp": RESULT,
}


def drafts(text):
    """Where a file under a name made from another's is written or removed."""
    variables = {found[1] for found in VARIABLE.finditer(text)}
    for call in CALL.finditer(text):
        if re.search(ENDING, call[1]) or any(re.search(rf"\b{name}\b", call[1]) for name in variables):
            yield text.count("\n", 0, call.start()) + 1


def main():
    source = Path(sys.argv[1])
    wrong, calls, appended = [], 0, set()
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
            for line in drafts(text):
                appended.add(name)
                if name not in MAY_APPEND:
                    wrong.append(f"{name}:{line}: a file under a name made from another's may be the user's: take a Draft")
    for path in sorted((source / "mdem/python").rglob("*.py")):
        if path.name != "files.py" and re.search(r"\bmkstemp\b|\bos\.(?:replace|rename)\b", path.read_text()):
            wrong.append(f"{path.relative_to(source)}: a draft belongs into mdem/python/ropewalk/files.py: take write_whole()")
    if calls != 1:
        wrong.append(f"remove_all is called in {calls} places, not in one")
    wrong += [f"{name} writes no such file: take it out of MAY_APPEND" for name in MAY_APPEND if name not in appended]
    print(*wrong, sep="\n", file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
