#!/bin/sh
# Finds the thresholds anew: remake.sh [PROGRAM]. Runs stay in runs/, and a second call goes on.
set -eu
cd "$(dirname "$0")"
program=${1:-ropewalk}
"$program" threshold 19-tubes.toml --out runs/19-tubes
"$program" threshold sizes.toml --out runs/sizes
cp runs/sizes/thresholds.csv sizes-thresholds.csv
cp runs/19-tubes/thresholds.csv runs/19-tubes/trials.csv runs/19-tubes/thresholds.html .
