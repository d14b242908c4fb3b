#!/usr/bin/env python3
"""Holds the sources to one door for each thing that meets the system: DOORS below.

    tests/structure/doors.py SOURCE_DIR [--print]

What goes past a door goes past what is checked there. A pipe in place of a file never ends, a key of 50 000 parts exhausts
the stack of a TOML parser, 100 000 threads that of OpenMP, and a child that nobody bounds fills the disk. A call of
remove_all may delete files of the user, a name in TMPDIR that can be guessed may be somebody else's, and "fig.png" +
".svg" may be the user's. Files that are written in place are opened by opened_to_write(), which follows no links.
"""
import re
import sys
from pathlib import Path

# What it is, calls that belong behind the door, the door, what to take in their place, and who else may call, and why.
DOORS = [
    ("reading files", r"\bifstream\s*[({]|\bifstream\s+\w+\s*[({]|\bfopen\s*\((?!\"/dev/null\")|\bO_RDONLY\b",
     {"mdem/io/files.cpp"}, "take read_file(), opened_stream() or opened_to_read()",
     {"mdem/io/child_process.cpp": "/dev/null", "mdem/io/program.cpp": "/dev/null",
      "mdem/io/files.hpp": "declares one", "mdem/lammps/fix_states.cpp": "slices, on each rank"}),
    ("TOML", r"\btoml::parse(?:_file)?\s*\(", {"mdem/io/toml_text.cpp"}, "take parsed_toml() or TomlTable::parse()", {}),
    ("drafts", r"\brename\s*\(", {"mdem/io/files.cpp"}, "take a Draft, or rename_whole()", {}),
    ("writing files", r"\bO_CREAT\b(?![^;]*(?:O_EXCL|O_NOFOLLOW))|\bfreopen\s*\((?!\"/dev/null\")|\bofstream\b",
     {"mdem/io/files.cpp"}, "take opened_to_write() or write_file_atomically()",
     {"mdem/io/child_process.cpp": "what a child says, in a folder that was made for it",
      "validate/parametrize/parametrize.cpp": "in a folder that was made for it",
      "mdem/lammps/fix_states.cpp": "a file that the user names"}),
    ("flushing files", r"\bf(?:data)?sync\s*\(", {"mdem/io/files.cpp"}, "take flush_to_disk()", {}),
    ("removing directories", r"\bremove_all\s*\(", {"mdem/io/removal.cpp"},
     "remove what is known by name: remove_inside(), remove_run()", {}),
    ("temporary directories",
     r"\bmkdtemp\s*\(|\bmkstemp\s*\(|\btmpnam\b|\btemp_directory_path\s*\(|\"TMPDIR\"", {"mdem/io/removal.cpp"},
     "take a TemporaryFolder", {}),
    ("the number of threads", r"\bomp_(?:get_max|set_num)_threads\b", {"mdem/sim/threads/threads.hpp"},
     "take threads_in_use() or use_threads()", {"mdem/io/program.cpp": "refuses what the environment asks for"}),
    ("children", r"(?<![\w.])(?:v?fork|exec[lv]\w*|posix_spawnp?|popen|system)\s*\(",
     {"mdem/io/child_process.cpp", "mdem/io/processes.cpp"}, "take run_child(), run_program() or run_processes()",
     {"mdem/commands/verb.cpp": "starts itself anew", "mdem/commands/siblings.cpp": "becomes its sibling"}),
    ("reports", r"\breport_html\s*\(", {"mdem/run/pages/run_report.cpp"}, "take write_report() or report_of()",
     {"mdem/report/report.cpp": "defines it", "mdem/report/report.hpp": "declares it"}),
]

# A path with an ending behind it; a variable that has such a path; a call that writes or removes it.
ENDING = r'(?:\+\s*"[.~-][\w.~-]*"|fmt::format\(\s*"[^"]*\}[.~-][\w.~-]+")'
VARIABLE = re.compile(r"\b(\w+)\s*=\s*[^;{}]*?" + ENDING)
CALL = re.compile(r"\b(?:write_file_atomically|opened_to_write|GrowingFile|frame_writer|remove|remove_run|unlink|freopen|fopen|"
                  r"copy|copy_file|run_program|run_child)\s*\(([^;]*);")
FOLDER = "in a folder that was made for these files"
RESULT = "a result, which the manual names and which replaces no file of another kind"
MAY_APPEND = {
    "mdem/commands/convert.cpp": FOLDER,
    "mdem/atoms/lammps.cpp": FOLDER,
    "calibrate/friction/sliding.cpp": FOLDER,
    "validate/cases/common/lammps_session.cpp": FOLDER,
    "mdem/commands/new.cpp": RESULT,
    "mdem/commands/threshold.cpp": RESULT,
    "calibrate/verbs/friction.cpp": RESULT,
    "calibrate/verbs/show.cpp": RESULT,
    "validate/chart/run.cpp": RESULT,
    "validate/core/reference.cpp": RESULT,
    "validate/parametrize/parametrize.cpp": RESULT,
}


# A stream that is a member of a class.
MEMBER = re.compile(r"\bifstream\s+(\w+_)\s*;")


def streams(text):
    """Where a member is opened past opened_stream(): a pipe would hold it up before anything looks at it."""
    for name in MEMBER.findall(text):
        for found in re.finditer(rf"\b{name}\((?!opened_stream\()", text):
            yield text.count("\n", 0, found.start()) + 1


def drafts(text):
    """Where a file under a name made from another's is written or removed."""
    variables = {found[1] for found in VARIABLE.finditer(text)}
    for call in CALL.finditer(text):
        if re.search(ENDING, call[1]) or any(re.search(rf"\b{name}\b", call[1]) for name in variables):
            yield text.count("\n", 0, call.start()) + 1


def main():
    source = Path(sys.argv[1])
    if sys.argv[2:] == ["--print"]:
        for what, _, doors, remedy, others in DOORS:
            print(f"| {what} | {' '.join(f'`{door}`' for door in sorted(doors))} | {remedy.removeprefix('take ')} | "
                  + "; ".join(f"`{name}`: {why}" for name, why in others.items()) + " |")
        return 0
    wrong, met, appended = [], set(), set()
    for folder in ("mdem", "calibrate", "validate"):
        for path in sorted((source / folder).rglob("*.?pp")):
            name = path.relative_to(source).as_posix()
            text = re.sub(r"//[^\n]*", "", path.read_text())
            for what, pattern, doors, remedy, others in DOORS:
                for found in re.finditer(pattern, text):
                    met.add((what, name))
                    if name not in doors and name not in others:
                        line = text.count("\n", 0, found.start()) + 1
                        wrong.append(f"{name}:{line}: {found[0].strip()} belongs into {min(doors)}: {remedy}")
            for line in streams(text):
                wrong.append(f"{name}:{line}: a stream belongs into mdem/io/files.cpp: take opened_stream()")
            for line in drafts(text):
                appended.add(name)
                if name not in MAY_APPEND:
                    wrong.append(f"{name}:{line}: a file under a name made from another's may be the user's: take a Draft")
    for path in sorted((source / "mdem/python").rglob("*.py")):
        if path.name != "files.py" and re.search(r"\bmkstemp\b|\bos\.(?:replace|rename)\b", path.read_text()):
            wrong.append(f"{path.relative_to(source)}: a draft belongs into mdem/python/ropewalk/files.py: take write_whole()")
    for what, _, _, _, others in DOORS:
        wrong += [f"{name}: {what}: it does not; take it out of DOORS" for name in others if (what, name) not in met]
    wrong += [f"{name} writes no such file: take it out of MAY_APPEND" for name in MAY_APPEND if name not in appended]
    print(*wrong, sep="\n", file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
