#!/usr/bin/env python3
"""docs/tables.md, and what `ropewalk help TABLE` prints of it: every table of a scene has all parts, each part of the page and
each mark in docs/theory.md belongs to a table, each example is a scene that `check` takes and that has the table, and what is said
not to go together is refused where another table is named.

    tables.py REPOSITORY ROPEWALK"""
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

errors = []


def said_by(program, *arguments, folder=None):
    return subprocess.run([program, *arguments], cwd=folder, capture_output=True, text=True)


def toml_of(text):
    return re.search(r"^```toml\n(.*?)^```$", text, re.S | re.M)[1]


def tables_in(text):
    return set(re.findall(r"^\[+(\w+)\]+", text, re.M))


def blocks_of(scene):
    """The lines of a scene by table, in order; those above the first table have the name ""."""
    out = [["", ""]]
    for line in scene.splitlines(keepends=True):
        head = re.match(r"\[+(\w+)\]+", line)
        if head:
            out.append([head[1], ""])
        out[-1][1] += line
    return out


def together(scene, other, name):
    """The scene with the table `name` of another one in it. A kind stands beside the scene's own."""
    return scene + "".join(text for table, text in blocks_of(other) if table == name)


def check(program, folder, scene):
    (folder / "try.toml").write_text(scene)
    return said_by(program, "check", "try.toml", folder=folder)


def main():
    repository, program = Path(sys.argv[1]), Path(sys.argv[2]).resolve()
    described = json.loads(said_by(program, "describe", "json").stdout)
    parts = {t["table"].strip("[]") or "top": {p["heading"]: p["text"] for p in t["parts"]} for t in described["scene"]}
    for name, of_table in parts.items():
        errors.extend(f"docs/tables.md has no \"{heading or 'paragraph'}\" of {name}" for heading, text in of_table.items() if not text)
    errors.extend(f"docs/tables.md is about {name}, and a scene has no such table" for name in set(described["described_tables"]) - set(parts))
    marks = set(re.findall(r"^<!-- \[(\w+)\] -->$", (repository / "docs/theory.md").read_text(), re.M))
    errors.extend(f"docs/theory.md has a mark of {name}, and a scene has no such table" for name in marks - set(parts))
    if errors:
        return
    help_of_links = " ".join(said_by(program, "help", "links").stdout.split())  # in lines of another width
    for heading, text in parts["links"].items():
        if " ".join(text.split()) not in help_of_links or heading not in help_of_links:
            errors.append(f"ropewalk help links lacks \"{heading}\"")
    for name in ("damping", "links"):
        if "```math" not in parts[name]["Formula"]:
            errors.append(f"the formula of theory is not in {name}")
    examples = {name: toml_of(of_table["Example"]) for name, of_table in parts.items()}
    refused = 0
    with tempfile.TemporaryDirectory() as work:
        folder = Path(work)
        rows = "".join(f"{t},{1.8 * t},0,{1.378 * e},1,0,0,0\n" for t in (0, 1) for e in range(4))
        (folder / "final.csv").write_text("tube,x_nm,y_nm,z_nm,qw,qx,qy,qz\n" + rows)
        for name, example in examples.items():
            if name != "top" and name not in tables_in(example):
                errors.append(f"the example of {name} has no such table")
            done = check(program, folder, example)
            if done.returncode != 0:
                errors.append(f"the example of {name}: {done.stderr.strip()}")
            # "- `[[grip]]`, `[twist]`: why": whole tables that the first words of a line name.
            for line in parts[name]["Does not go with"].splitlines():
                first = re.match(r"- ((?:`\[+\w+\]+`(?:, | and )?)+)", line)
                for other in re.findall(r"\w+", first[1].replace(" and ", " ")) if first else []:
                    both = together(example, examples[other], other)
                    done = check(program, folder, both)
                    if done.returncode == 0:
                        errors.append(f"[{other}] is said not to go with [{name}], and is taken")
                    refused += 1
    if refused < 20:
        errors.append(f"only {refused} pairs of tables were tried")
    print(f"{len(examples)} examples, {refused} pairs that are refused")


main()
for error in errors:
    print(error, file=sys.stderr)
sys.exit(1 if errors else 0)
