#!/usr/bin/env bash
# Strength of a yarn against twist, length of its tubes and number of links: strength.csv and strength.svg. With the program
# given, or the one of the release build; 90 minutes of one core.
set -euo pipefail
cd "$(dirname "$0")"
ropewalk=$(realpath "${1:-../../../build/release/mdem/ropewalk}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$ropewalk" sweep strength.toml --out "$work/strength" --quiet
"$ropewalk" compare "$work/strength" --tensile --csv strength.csv --svg strength.svg --force
