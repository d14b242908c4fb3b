#!/usr/bin/env bash
# What a rope of endless tubes bears that was twisted before the pull: strength.csv. With the program given, or the one of
# the release build.
set -euo pipefail
cd "$(dirname "$0")"
ropewalk=$(realpath "${1:-../../../build/release/mdem/ropewalk}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$ropewalk" sweep strength.toml --out "$work/strength" --quiet
python3 strength.py "$work/strength" >strength.csv
