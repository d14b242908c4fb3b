#!/usr/bin/env bash
# The Debian packages: made, unpacked and run; what they depend on is named. Argument: the build.
set -euo pipefail
build=$(realpath "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "package: $*" >&2; exit 1; }

cd "$build"
cpack -G DEB -B "$work" >/dev/null
cd "$work"
packages=(ropewalk_*.deb ropewalk-calibrate_*.deb libropewalk-dev_*.deb)
for package in "${packages[@]}"; do dpkg-deb -x "$package" tree; done
dpkg-deb -f "${packages[0]}" Depends > depends
grep -q libfmt depends || fail "the package of the simulator does not name its libraries"
grep -qE 'nlopt|gsl|lammps' depends && fail "the simulator asks for what only calibration needs"
unset ROPEWALK_DATA
tree/usr/bin/ropewalk new rope >/dev/null
tree/usr/bin/ropewalk check rope.toml >/dev/null || fail "the unpacked program does not read a scene"
tree/usr/bin/ropewalk calibrate show cnt-10-10-tersoff --table > table || fail "the unpacked calibration does not start"
