#!/usr/bin/env python3
"""Comments are read by themselves: one that begins with of, from, by, in or on and has no verb needs the identifier before it.

    tests/structure/comments.py SOURCE_DIR            fails where there is one

"double moved; // of both ends, nm" says less than "Displacement of both ends, nm". Nor does a unit stand for the noun: not
"double moved; // nm, of both ends".
A verb in a relative clause does not count: "of the scene that it names" has no verb of its own.
"""
import re
import sys
from pathlib import Path

COMMENT = re.compile(r"(?:^|[^:\"'/])//+<?\s?(.*)$")
UNIT = r"(?:(?:1|nm|ps|eV|rad|K|nN|s|fs|pN)(?:\^?[0-9])?(?:[ /][a-z A-Z/]*(?:nm|ps|rad|eV|ns|K)(?:\^?[0-9])?)?, )?"
GENITIVE = re.compile(UNIT + r"(?:[Oo]f|[Ff]rom|[Bb]y|[Ii]n|[Oo]n) [a-z]")
# Words that are verbs in the comments of this tree, and endings that are hardly anything else.
VERB = re.compile(r"\b(?:is|are|was|were|be|has|have|had|does|do|did|can|may|must|will|would|should|cannot|become|becomes|"
                  r"gives?|takes?|keeps?|kept|stands?|lies?|needs?|says?|goes|go|makes?|made|holds?|held|acts?|reads?|writes?|"
                  r"counts?|stays?|starts?|begins?|ends?|moves?|turns?|follows?|belongs?|costs?|differs?|decides?|knows?|"
                  r"leaves?|lets?|puts?|sets?|shows?|sums?|tells?|uses?|depends?|equals?|falls?|rises?|grows?|comes?|works?)\b")

# Ends at the next punctuation mark; a verb in it does not speak for the comment.
CLAUSE = re.compile(r"\b(?:that|which|who|whose|where|when|while|if|whether|as|than|until|since|because)\b[^,;:.]*")


def comments_of(text):
    """(line, comment): each block of comment lines is one, each trailing comment is one."""
    found, open_at = [], None
    for number, line in enumerate(text.splitlines(), 1):
        match = COMMENT.search(line)
        if not match:
            open_at = None
            continue
        alone = line.lstrip().startswith("//")
        trailing_goes_on = open_at is not None and alone and line.index("//") == open_at
        if trailing_goes_on and found:
            found[-1][1] += " " + match[1]
        else:
            found.append([number, match[1]])
        open_at = line.index("//")
    return found


def main():
    source = Path(sys.argv[1])
    wrong = []
    for folder in ("mdem", "calibrate", "validate"):
        for path in sorted((source / folder).rglob("*")):
            if path.suffix not in (".hpp", ".cpp", ".h"):
                continue
            for line, text in comments_of(path.read_text()):
                if GENITIVE.match(text) and not VERB.search(CLAUSE.sub("", text)):
                    wrong.append(f"{path.relative_to(source)}:{line}: \"{text}\" has no noun of its own: name what it describes")
    print(*wrong, sep="\n", file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
