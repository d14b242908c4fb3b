#!/usr/bin/env python3
"""The subject of a commit is one imperative of at most 60 characters, without a full stop.

    tests/structure/subjects.py SOURCE_DIR     the commits since origin/main; skipped (77) without a log or without that branch
    tests/structure/subjects.py --hook FILE    the message in FILE, as git's hook commit-msg has it
"""
import re
import subprocess
import sys
from pathlib import Path

MOST = 60
NO_IMPERATIVE = re.compile(r"(?!(?:Bring|Embed|Exceed|Feed|Need|Proceed|Shed|Speed|String)\b)\w+(?:ing|ed)\b|(?:The|A|An|No|Now|One)\b")


def wrong(subject):
    """What is wrong with it; None: nothing, or git has written it."""
    if subject.startswith(("Merge ", "Revert ", "fixup!", "squash!")):
        return None
    if len(subject) > MOST:
        return f"has {len(subject)} characters; write at most {MOST}, and the rest into the body"
    if subject.endswith("."):
        return "ends with a full stop; leave it out"
    if not re.match(r"[A-Z][a-z]+ ", subject) or NO_IMPERATIVE.match(subject):
        return 'does not begin with an imperative; write "Add", "Mend", "Cut" and the like first'
    return None


def main():
    if sys.argv[1] == "--hook":
        lines = [line for line in Path(sys.argv[2]).read_text().splitlines() if not line.startswith("#")]
        subjects = lines[:1]
    else:
        log = subprocess.run(["git", "-C", sys.argv[1], "log", "--format=%s", "origin/main..HEAD"],
                             capture_output=True, text=True, check=False)
        if log.returncode != 0:
            print("no log since origin/main here")
            return 77
        subjects = log.stdout.splitlines()
    faults = [f"{subject}: {what}" for subject in subjects if (what := wrong(subject))]
    print(*faults, sep="\n", file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
