#!/bin/sh
# Holds slices without ends against the middle of long ropes: remake.sh [PROGRAM], 1 minute. Runs stay in runs/.
set -eu
cd "$(dirname "$0")"
program=${1:-ropewalk}
columns=torque_upper_nN_nm,torque_lower_nN_nm,tension_upper_nN,beta_deg,Q,stored_MJ_per_kg,core_pressure_GPa
"$program" sweep slices.toml --out runs/slices -j 1
"$program" sweep ropes.toml --out runs/ropes -j 1
"$program" gather runs/slices --mean 36 --columns $columns -o slices.csv --force
"$program" gather runs/ropes --mean 120 --columns $columns -o ropes.csv --force
for run in runs/slices/points/* runs/ropes/points/*; do
  awk -F'[:,]' -v run="$run" '/"wall_seconds"/ { s = $2 } /"steps"/ { n = $2 } END { printf "%s: %.2f ms a step\n", run, 1e3 * s / n }' \
    "$run/manifest.json"
done
