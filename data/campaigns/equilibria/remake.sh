#!/usr/bin/env bash
# Up to which moment ropes have states of rest: states-static.csv, and curve-N.csv for N tubes of 68 nm. With the program
# given, or the one of the release build.
set -euo pipefail
cd "$(dirname "$0")"
ropewalk=$(realpath "${1:-../../../build/release/mdem/ropewalk}")
"$ropewalk" threshold states.toml --static --force
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for tubes in 37 91 169; do
  sed "s/^tubes = .*/tubes = $tubes/" rope.toml >"$work/$tubes.toml"
  "$ropewalk" run "$work/$tubes.toml" --out "$work/$tubes" --quiet
  cp "$work/$tubes/equilibria.csv" "curve-$tubes.csv"
done
