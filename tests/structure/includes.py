#!/usr/bin/env python3
"""Holds #include lines to the table "Who may include whom" of docs/architecture.md.

    tests/structure/includes.py SOURCE_DIR           fails on an arrow that the table does not allow, and on a circle
    tests/structure/includes.py SOURCE_DIR --print   the arrows between rooms, and the layers of mdem/scene

A room is a row of the table: a folder and all below it that is no room of its own. It may include the rooms that its
row names, and what those may include. The modules of mdem/scene are its folders and its pairs x.hpp + x.cpp; no circle
of includes may lead through them.
"""
import re
import sys
from pathlib import Path

INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.M)
SOURCES = (".hpp", ".cpp", ".h")
FOLDERS = ("mdem", "calibrate", "validate")


def rooms_of(page):
    """Room -> rooms that its row of the table names."""
    rows = re.search(r"^\| room \|.*?\n\|[-| ]+\|\n((?:\|.*\n)+)", page, re.M)
    if not rows:
        raise SystemExit("docs/architecture.md has no table that begins with | room |")
    found = {}
    for row in rows[1].splitlines():
        cells = [cell.strip() for cell in row.strip("|").split("|")]
        found[cells[0].strip("`")] = re.findall(r"`([^`]+)`", cells[-1])
    return found


def allowed(rooms):
    """Room -> all that it may include, through others as well."""
    def below(room, seen):
        for name in rooms.get(room, []):
            if name not in seen:
                seen.add(name)
                below(name, seen)
        return seen

    return {room: below(room, set()) for room in rooms}


def room_of(path, rooms):
    while path.name:
        if path.as_posix() in rooms:
            return path.as_posix()
        path = path.parent
    return None


def scene_module(path):
    if path.parts[:2] != ("mdem", "scene"):
        return None
    return path.parts[2] + "/" if len(path.parts) > 3 else path.stem


def arrows(root, module):
    """(from, to) -> the includes, as "file: header". `module`: path below `root` -> name, or None."""
    found = {}
    for path in sorted(p for folder in FOLDERS for p in (root / folder).rglob("*") if p.suffix in SOURCES):
        inside = path.relative_to(root)
        here = module(inside)
        bases = [path.parent, root / inside.parts[0]] + [root / folder for folder in FOLDERS]
        for name in INCLUDE.findall(path.read_text()):
            at = next((base / name for base in bases if (base / name).is_file()), None)
            to = module(at.resolve().relative_to(root)) if at else None
            if here and to and to != here:
                found.setdefault((here, to), []).append(f"{path.relative_to(root)}: {name}")
    return found


def circles(pairs):
    """Modules that include one another, directly or through others; a list for each such group."""
    after = {}
    for here, to in pairs:
        after.setdefault(here, set()).add(to)

    def reach(start):
        seen, todo = set(), [start]
        while todo:
            for to in after.get(todo.pop(), set()) - seen:
                seen.add(to)
                todo.append(to)
        return seen

    reached = {module: reach(module) for module in after}
    return sorted({tuple(sorted(n for n in r if m in reached.get(n, ()))) for m, r in reached.items() if m in r})


def layers(pairs):
    """Module -> its height: 0 where it includes none of the others."""
    height = {module: 0 for pair in pairs for module in pair}
    for _ in height:
        for here, to in pairs:
            height[here] = max(height[here], height[to] + 1)
    return height


def main():
    root = Path(sys.argv[1]).resolve()
    rooms = rooms_of((root / "docs/architecture.md").read_text())
    between = arrows(root, lambda path: room_of(path, rooms))
    scene = arrows(root, scene_module)
    may = allowed(rooms)
    wrong = []
    for room, named in sorted(rooms.items()):
        if not (root / room).exists():
            wrong.append(f"the table has the room {room}, which is not there")
        for name in named:
            if name not in rooms:
                wrong.append(f"{room} may include {name}, which is no room of the table")
            elif (room, name) not in between:
                wrong.append(f"{room} may include {name}, and does not: take it out of the table")
    for (here, to), lines in sorted(between.items()):
        if to not in may[here]:
            wrong += [f"{here} may not include {to}. {line}" for line in lines]
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in SOURCES and not room_of(path.relative_to(root), rooms):
                wrong.append(f"{path.relative_to(root)} is in no room of the table")
    wrong += [f"these rooms include one another: {', '.join(circle)}" for circle in circles(between)]
    wrong += [f"these modules of mdem/scene include one another: {', '.join(circle)}" for circle in circles(scene)]
    if "--print" in sys.argv:
        for room in rooms:
            print(f"{room}: {', '.join(sorted(to for here, to in between if here == room)) or 'nothing'}")
        height = layers(scene) if not circles(scene) else {}
        print(f"\nmdem/scene: {len({m for pair in scene for m in pair})} modules, {len(scene)} arrows")
        for level in sorted(set(height.values())):
            print(f"  {level}: {', '.join(sorted(m for m in height if height[m] == level))}")
    for line in wrong:
        print(line, file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
