#!/usr/bin/env python3
"""The library rounds no number to a `long`: where that has 32 bits, coordinates of the kernels would not wrap and counts of steps would
end at 2^31.

    tests/structure/widths.py SOURCE_DIR
"""
import re
import sys
from pathlib import Path

# What fits an int may be rounded by lround.
TO_INT = re.compile(r"static_cast<int>\(\s*std::lround\(")
TO_LONG = re.compile(r"\b(?:lround|lrint)\(")


def main():
    source = Path(sys.argv[1])
    wrong, files = [], 0
    for path in sorted((source / "mdem").rglob("*.?pp")):
        files += 1
        text = TO_INT.sub(lambda found: re.sub(r"\S", " ", found[0]), re.sub(r"//[^\n]*", "", path.read_text()))
        for found in TO_LONG.finditer(text):
            line = text.count("\n", 0, found.start()) + 1
            wrong.append(f"{path.relative_to(source)}:{line}: rounds to a long; write llround, llrint or "
                         "static_cast<int>(std::lround(...))")
    if files == 0:
        sys.exit(f"{source}/mdem: has no source files")
    print("\n".join(wrong) or f"{files} files")
    sys.exit(bool(wrong))


main()
