#!/usr/bin/env bash
# Makes the calibrated sets of this folder anew, with the program given or the one of the release build. All
# envelopes are measured, which takes most of the time: about an hour on one core.
set -euo pipefail
cd "$(dirname "$0")"
ropewalk=${1:-../../build/release/mdem/ropewalk}
for tube in 5,5 6,4 9,0 8,2 6,6 8,8 12,6 10,10 17,0 12,12 16,4 15,15 20,20; do
  "$ropewalk" calibrate --chirality "$tube" --envelope --quiet --force
done
for potential in lcbop airebo rebo; do
  "$ropewalk" calibrate --chirality 10,10 --potential "$potential" --quiet --force
done
