#!/usr/bin/env python3
"""Whether each shipped SVG shows outside of a browser what it shows inside: few programs know variables of CSS, and rsvg-convert
draws it.

    pictures.py REPOSITORY"""
import subprocess
import sys
import tempfile
from pathlib import Path

repository = Path(sys.argv[1])
pictures = [p for folder in ("data", "docs") for p in sorted((repository / folder).rglob("*.svg")) if "site" not in p.parts]
bad = [f"{p}: has variables of CSS" for p in pictures if "var(--" in p.read_text(encoding="utf-8")]
with tempfile.TemporaryDirectory() as folder:
    for p in pictures:
        drawn = Path(folder, "drawn.png")
        done = subprocess.run(["rsvg-convert", "-w", "400", "-o", drawn, p], capture_output=True, text=True)
        # A picture with its lines takes more room than an empty one of this width.
        if done.returncode != 0 or drawn.stat().st_size < 3000:
            bad.append(f"{p}: rsvg-convert {done.stderr.strip() or 'draws hardly anything'}")
print("\n".join(bad) or f"{len(pictures)} pictures")
sys.exit(1 if bad or not pictures else 0)
