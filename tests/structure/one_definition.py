#!/usr/bin/env python3
"""A class, function or variable that two files of the project define under one name: undefined behaviour in a program that
holds both, of which neither compiler nor linker tells.

    one_definition.py BUILD

Reads the symbols of all object files below BUILD. The objects in which a name is defined have in common the file that
defines it: the source itself, or a header that ninja recorded for each. Where no file in common has the name, there are two
definitions. Programs of tests are never linked with one another, and are compared with the libraries one at a time."""
import collections
import re
import subprocess
import sys
from pathlib import Path

qualified = re.compile(r"ropewalk(?:::[A-Za-z_]\w*)+")


def files_of_objects(build):
    """Object file -> its source and the headers of the project that it includes."""
    root = Path(re.search(r"^CMAKE_HOME_DIRECTORY:INTERNAL=(.*)$", (build / "CMakeCache.txt").read_text(), re.M).group(1))
    found, current = {}, None
    text = subprocess.run(["ninja", "-C", build, "-t", "deps"], check=True, capture_output=True, text=True).stdout
    for line in text.splitlines():
        if line.startswith("    "):
            path = build / line.strip()  # an absolute path stays absolute
            if path.is_relative_to(root) and current is not None:
                current.add(path.resolve())
        elif line.strip():
            name, _, rest = line.rpartition(": #deps")
            current = found.setdefault(build / name, set()) if name.endswith(".o") and "(VALID)" in rest else None
    return found


def symbols_of(objects):
    """(object, demangled symbol) of everything that these define and other objects can see."""
    names = subprocess.run(["nm", "-A", "--defined-only", "--extern-only", *objects], check=True, capture_output=True,
                           text=True).stdout
    lines = [line.split() for line in names.splitlines() if "8ropewalk" in line]
    mangled = sorted({line[-1] for line in lines})
    plain = subprocess.run(["c++filt"], check=True, capture_output=True, text=True, input="\n".join(mangled)).stdout
    demangled = dict(zip(mangled, plain.splitlines()))
    for line in lines:
        yield Path(line[0].rsplit(":", 1)[0]), demangled[line[-1]]


def end_of_arguments(text, at):
    depth = 0
    for k in range(at, len(text)):
        depth += {"<": 1, ">": -1}.get(text[k], 0)
        if depth == 0:
            return k + 1
    return len(text)


def definitions_in(symbol, namespaces, by_macro):
    """(key, last name) of each class in the symbol, and of the function or variable that it is. Functions may be
    overloaded, so that their key has the arguments too."""
    for match in qualified.finditer(symbol):
        names, end = match.group().split("::"), match.end()
        is_namespace = lambda k: "::".join(names[:k]) in namespaces or names[k - 1] in by_macro
        for k in range(2, len(names)):
            if not is_namespace(k):
                yield "::".join(names[:k]), names[k - 1]
        if is_namespace(len(names)) or names[-1] == "operator":
            continue
        if symbol.startswith("<", end):
            end = end_of_arguments(symbol, end)
        function = symbol.startswith(("(", "[abi"), end)
        yield symbol if function else match.group(), names[-1]


def main(build):
    files = {o: f for o, f in files_of_objects(build).items() if o.exists()}
    words, namespaces, macros, defines = {}, {"ropewalk"}, set(), set()
    for path in set().union(*files.values()):
        text = path.read_text(errors="replace")
        words[path] = set(re.findall(r"\w+", text))
        for name in re.findall(r"^namespace ([\w:]+) \{", text, re.M):
            parts = name.split("::")
            namespaces |= {"::".join(parts[:k + 1]) for k in range(len(parts))}
        macros |= set(re.findall(r"^namespace ([A-Z_]+) \{", text, re.M))
        defines |= set(re.findall(r"^#define ([A-Z_]+) (\w+)$", text, re.M))
    by_macro = {value for macro, value in defines if macro in macros}  # a namespace for each instruction set
    defined = collections.defaultdict(set)
    parsed = {}
    for path, symbol in symbols_of(files):
        if symbol not in parsed:
            parsed[symbol] = set(definitions_in(symbol, namespaces, by_macro))
        for key in parsed[symbol]:
            defined[key].add(path)

    def test_of(path):
        match = re.search(r"/tests/.*?CMakeFiles/([^/]*)\.dir/", str(path))
        return match and match.group(1)

    faults = []
    for (key, name), objects in sorted(defined.items()):
        for test in {test_of(o) for o in objects}:
            together = sorted(o for o in objects if test_of(o) in (None, test))
            common = set.intersection(*(files[o] for o in together))
            if not any(name in words[f] for f in common):
                faults.append(f"{key}: defined more than once, in\n" + "".join(f"    {o}\n" for o in together[:6]))
                break
    print(f"{len(files)} objects, {len(defined)} names, {len(faults)} of them defined more than once")
    print("\n".join(faults))
    if faults:
        print("Give one of them another name, or the namespace of its program.")
    return 1 if faults or not files else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]).resolve()))
