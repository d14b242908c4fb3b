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
dpkg-deb -f libropewalk-dev_*.deb Depends Maintainer > depends
grep -q zlib1g-dev depends || fail "the libraries do not ask for zlib"
grep -qE '^Maintainer: .+ <.+@.+>$' depends || fail "the maintainer has no address: $(cat depends)"
if compgen -G 'python3-ropewalk_*.deb' >/dev/null; then
  dpkg-deb -x python3-ropewalk_*.deb tree
  dpkg-deb -f python3-ropewalk_*.deb Depends > depends
  grep -q 'ropewalk (= .*python3-numpy.*python3 (>= 3' depends || fail "the Python package asks for: $(cat depends)"
fi
unset ROPEWALK_DATA
tree/usr/bin/ropewalk new rope >/dev/null
tree/usr/bin/ropewalk check rope.toml >/dev/null || fail "the unpacked program does not read a scene"
tree/usr/bin/ropewalk calibrate show cnt-10-10-tersoff --table > table || fail "the unpacked calibration does not start"
[ ! -d tree/usr/lib/python3 ] || PYTHONPATH=tree/usr/lib/python3/dist-packages /usr/bin/python3 -B -c '
import ropewalk
assert ropewalk.Scene("rope.toml").tubes > 1' || fail "the unpacked Python package does not read a scene"
