#!/usr/bin/env bash
# Makes the calibrated sets of this folder anew, with the program given or the one of the release build. With
# `remake.sh PROGRAM --keep-envelopes` the measured envelopes of the sets that are there are kept: some ten minutes on
# one core, and another ten for the tubes of several walls. Without, they are measured, which takes about an hour.
set -euo pipefail
cd "$(dirname "$0")"
ropewalk=${1:-../../build/release/mdem/ropewalk}
for tube in 5,5 6,4 9,0 8,2 6,6 8,8 12,6 10,10 17,0 12,12 16,4 15,15 20,20; do
  envelope=--envelope
  if [ "${2:-}" = --keep-envelopes ]; then envelope="--envelope-of cnt-${tube/,/-}-tersoff"; fi
  # shellcheck disable=SC2086  # two words
  "$ropewalk" calibrate --chirality "$tube" $envelope --quiet --force
done
for walls in '(5,5)@(10,10)' '(10,10)@(15,15)' '(5,5)@(10,10)@(15,15)'; do
  "$ropewalk" calibrate --chirality "$walls" --quiet --force
done
"$ropewalk" calibrate --atoms BN --chirality 10,10 --envelope --quiet --force
"$ropewalk" calibrate --atoms BN --chirality 10,10 --potential tersoff --envelope --quiet --force
for potential in lcbop airebo rebo; do
  "$ropewalk" calibrate --chirality 10,10 --potential "$potential" --quiet --force
done
