#!/bin/sh
# Runs both campaigns and draws their figures anew: remake.sh [PROGRAM], 1 minute on two cores. Runs stay in runs/,
# and a second call goes on where the first one stopped.
set -eu
cd "$(dirname "$0")"
program=${1:-ropewalk}
"$program" sweep sizes.toml --out runs/sizes --on-limit stop
"$program" sweep temperatures.toml --out runs/temperatures
columns=stored_MJ_per_kg,torque_upper_nN_nm,tension_upper_nN,stored_stretch_MJ_per_kg,stored_twist_MJ_per_kg
"$program" compare runs/sizes --x rotation_deg --y $columns --level "0.22:pristine yarns, mean" \
  --level "0.45:pristine yarns, largest" --svg sizes.svg --csv sizes.csv --force
"$program" compare runs/temperatures --x rotation_deg --y $columns --svg temperatures.svg --csv temperatures.csv --force
"$program" gather runs/sizes -o sizes-ends.csv --force
"$program" gather runs/temperatures --mean 8 -o temperatures-ends.csv --force
