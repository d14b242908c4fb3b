#!/bin/sh
# Finds the thresholds anew: remake.sh [PROGRAM]. Runs stay in runs/, and a second call goes on.
set -eu
cd "$(dirname "$0")"
program=${1:-ropewalk}
for search in 19-tubes sizes-7 sizes-19 sizes-37 sizes-61 sizes-91 viscosity wait-7 wait-19; do
  "$program" threshold "$search.toml" --out "runs/$search"
done
./join.py runs sizes-thresholds.csv sizes-trials.csv
cp runs/19-tubes/thresholds.csv runs/19-tubes/trials.csv runs/19-tubes/thresholds.html .
