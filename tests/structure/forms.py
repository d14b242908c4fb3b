#!/usr/bin/env python3
"""Holds the forms of the model to one text, mdem/model/forms.h, which the processor's code and the kernels of a device read.

    tests/structure/forms.py SOURCE_DIR

Fails where kernels.h has a formula that stands in mdem/model or in the processor's loops, defines what forms.h defines, or
where one of the two readers does not take forms.h. A formula is a run of operators, brackets and numbers: the names of
its quantities do not count.
"""
import re
import sys
from pathlib import Path

LONGEST = 24  # tokens that two texts may have in common by chance
TOKEN = re.compile(r"\d[\w.]*|\w+|->|::|<<|>>|[<>=!+*/&|-]=|&&|\|\||\S")
PLAIN = re.compile(r"\bvec_(?:sum|difference|scaled|negative|divided)\b")


def statements(text):
    """Each statement with a product, as its tokens; quantities as q, with their members and indices."""
    text = re.sub(r"//[^\n]*|^\s*#.*$", "", text, flags=re.M)
    for statement in re.split(r"[;{}]", text):
        statement = re.sub(r"[A-Za-z_]\w*(?:(?:\.|->|::)[A-Za-z_]\w*|\[[^\]]*\])*", "q", PLAIN.sub("vec", statement))
        statement = statement.replace("q q", "q").split("=", 1)[-1]
        if "*" in statement:
            yield [t for t in TOKEN.findall(statement)]


def runs(path):
    found = {}
    for tokens in statements(path.read_text()):
        for at in range(len(tokens) - LONGEST + 1):
            run = tuple(tokens[at:at + LONGEST])
            if sum(t in "+-*/" for t in run) >= 6:
                found.setdefault(run, " ".join(tokens))
    return found


def defined(text):
    """Functions and types that a text in the words of dialect.h defines."""
    return set(re.findall(r"^FUNCTION [\w ]+?(\w+)\(", text, re.M)) | set(
        re.findall(r"^\}? ?(?:typedef )?(?:struct )?(?:\w+ )?(\w+);", text, re.M))


def main():
    root = Path(sys.argv[1])
    mdem = root / "mdem"
    forms, kernels = mdem / "model/forms.h", mdem / "sim/device/kernels.h"
    wrong = []
    own = runs(kernels)
    others = [p for folder in ("model", "sim/state", "sim/forces") for p in sorted((mdem / folder).rglob("*.h*"))]
    for path in others:
        both = runs(path)
        for statement in sorted({own[run] for run in own if run in both}):
            wrong.append(f"{kernels.relative_to(root)}: a formula of {path.relative_to(root)}: {statement}")

    both = defined(forms.read_text()) & defined(kernels.read_text())
    wrong += [f"{kernels.relative_to(root)} defines {name}, which forms.h has" for name in sorted(both)]

    # Forms that the kernels use, beside operations on vectors: the processor's code uses them too.
    used = defined(forms.read_text()) & set(re.findall(r"(\w+)\(", kernels.read_text()))
    processor = "".join(p.read_text() for p in mdem.rglob("*.?pp") if "device" not in p.parts)
    for name in sorted(n for n in used if not n.startswith("vec") and n not in ("turn", "within", "larger", "smaller")):
        if not re.search(rf"forms::{name}[(;]", processor):
            wrong.append(f"{forms.relative_to(root)}: {name} is a form of the kernels alone")
    for name, needed in (("mdem/model/forms.hpp", '#include "model/forms.h"'),
                         ("mdem/CMakeLists.txt", "|forms_text=${forms_dir}/forms.h|"),
                         ("mdem/sim/device/opencl.cpp", "<< forms_text <<")):
        if needed not in (root / name).read_text():
            wrong.append(f"{name} has no {needed}: it reads other forms than its counterpart")
    if len(own) < 20 or len(used) < 8:
        wrong.append(f"{len(own)} runs and {len(used)} forms were found in kernels.h: this script no longer reads it")
    print(*wrong, sep="\n", file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
