#!/usr/bin/env bash
# What it takes to draw a tube out of six others, and what friction does in twisted ropes, loops and the transfer of load. With the program given, or the one of the release build.
set -euo pipefail
cd "$(dirname "$0")"
ropewalk=$(realpath "${1:-../../../build/release/mdem/ropewalk}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$ropewalk" sweep pull-outs.toml --out "$work/pull-outs" --quiet
python3 forces.py "$work/pull-outs" >pull-outs.csv
for question in twisted-ropes loops transfers; do
  "$ropewalk" sweep $question.toml --out "$work/$question" --quiet
  python3 ropes.py ${question%-ropes} "$work/$question" >$question.csv
done
