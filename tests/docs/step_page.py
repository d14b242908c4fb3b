#!/usr/bin/env python3
"""Does what a page of the documentation says, and holds what comes out to what the page shows.

    step_page.py PAGE.md BUILD [--write] [--keep DIRECTORY] [--pictures-only] [--python PROGRAM]

All ```sh blocks run one after another, in one shell and one empty directory. A ```text block behind one shows lines of
its output: they come in this order, with others between them. In them `...` stands for anything, and a number for those
within 2 % of it, or within one of its last digit. A picture of the page must come out of the commands; --write puts it
beside the page, and --pictures-only runs nothing and looks for a command that names it. A stand-in for SLURM's sbatch runs the tasks of a job array one after another. python3 is PROGRAM, and finds the package of the build."""
import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

here = Path(__file__).resolve().parent
number = re.compile(r"[-−+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def blocks(text):
    """Language and content of each fenced block."""
    return re.findall(r"^```(\w+)\n(.*?)^```$", text, re.S | re.M)


def near(shown, found):
    a, b = float(shown.replace("−", "-")), float(found.replace("−", "-"))
    decimals = len(shown.split("e")[0].partition(".")[2])
    scale = float("1e" + shown.partition("e")[2]) if "e" in shown else 1
    return abs(a - b) <= max(0.02 * abs(a), 1.01 * 10 ** -decimals * scale)


def words(line):
    return re.findall(rf"\.\.\.|{number.pattern}|[^\W\d]+|\S", line)


def matches(shown, found):
    """Whether a line of output is the line that the page shows."""
    a, b = words(shown), words(found)
    reached = {0}  # how many words of the output may be used up by the words of the page so far
    for word in a:
        if word == "...":
            reached = set(range(min(reached), len(b) + 1)) if reached else set()
        elif number.fullmatch(word):
            reached = {k + 1 for k in reached if k < len(b) and number.fullmatch(b[k]) and near(word, b[k])}
        else:
            reached = {k + 1 for k in reached if k < len(b) and b[k] == word}
    return len(b) in reached


def missing_line(shown, output):
    """The first shown line that does not come in its turn; None if all do."""
    found = iter(output.splitlines())
    for line in shown.splitlines():
        if line.strip() in ("", "..."):
            continue
        if not any(matches(line, f) for f in found):
            return line
    return None


def shell_script(commands):
    text = "set -eo pipefail\n"
    for k, block in enumerate(commands):
        text += f"exec > \"$STEP_OUTPUT/{k}\" 2>&1\n{block}"
    return text


def step(page, build, directory, python):
    """Errors, each a text."""
    parts = blocks(page.read_text())
    commands = [content for language, content in parts if language == "sh"]
    if not commands:
        return ["has no commands"]
    with tempfile.TemporaryDirectory() as outputs:
        programs = [here / "stand-ins", build / "bin"]
        environment = {**os.environ, "STEP_OUTPUT": outputs, "OMPI_ALLOW_RUN_AS_ROOT": "1",
                       "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1",
                       "PATH": ":".join([*map(str, programs), os.environ["PATH"]])}
        environment.pop("ROPEWALK_DATA", None)
        if python:
            Path(outputs, "bin").mkdir()
            Path(outputs, "bin/python3").symlink_to(python)
            environment["PATH"] = f"{outputs}/bin:{environment['PATH']}"
            environment["PYTHONPATH"] = str(build / "mdem/python")
        done = subprocess.run(["bash", "-c", shell_script(commands)], cwd=directory, env=environment,
                              stdin=subprocess.DEVNULL)
        said = [Path(outputs, str(k)).read_text() if Path(outputs, str(k)).exists() else None
                for k in range(len(commands))]
    if done.returncode != 0:
        last = max(k for k, text in enumerate(said) if text is not None)
        return [f"exit code {done.returncode} of these commands:\n{commands[last]}{said[last]}"]
    errors, k = [], -1
    for language, content in parts:
        if language == "sh":
            k += 1
        elif language == "text" and k >= 0:
            line = missing_line(content, said[k])
            if line is not None:
                errors.append(f"this line does not come out in its turn:\n  {line}\nbut:\n{said[k]}")
    return errors


def pictures_of(page):
    return re.findall(r"!\[[^\]]*\]\(([^)]*)\)", page.read_text())


def unnamed_pictures(page):
    commands = "".join(content for language, content in blocks(page.read_text()) if language == "sh")
    return [f"no command makes {picture}" for picture in pictures_of(page) if f"-o {Path(picture).name} " not in commands]


def tell(page, errors):
    for error in errors:
        print(f"{page}: {error}", file=sys.stderr)
    return 1 if errors else 0


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("page", type=Path)
    arguments.add_argument("build", type=Path)
    arguments.add_argument("--write", action="store_true")
    arguments.add_argument("--keep", type=Path)
    arguments.add_argument("--pictures-only", action="store_true")
    arguments.add_argument("--python", type=Path)
    given = arguments.parse_args()
    page = given.page.resolve()
    if given.pictures_only:
        return tell(page, unnamed_pictures(page))
    directory = given.keep or Path(tempfile.mkdtemp(prefix="ropewalk-page-"))
    directory.mkdir(exist_ok=True)
    try:
        errors = step(page, given.build.resolve(), directory, given.python)
        for picture in pictures_of(page):
            made = directory / Path(picture).name
            if not made.is_file():
                errors.append(f"no command makes {made.name}")
            elif given.write:
                shutil.copyfile(made, page.parent / picture)
    finally:
        if not given.keep:
            shutil.rmtree(directory, ignore_errors=True)
    return tell(page, errors)


if __name__ == "__main__":
    sys.exit(main())
