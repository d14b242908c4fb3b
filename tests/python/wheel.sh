#!/usr/bin/env bash
# `pip install .` without a network: the wheel has the package, the programs and their data, and needs nothing of the
# build. Arguments: the build, Python.
set -euo pipefail
build=$(realpath "$1") python=$2 root=$(realpath "$(dirname "$0")/../..")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "wheel: $*" >&2; exit 1; }

cd "$root"
before=$(git status --porcelain --ignored=no 2>/dev/null || true)
ROPEWALK_BUILD=$build "$python" -m pip install --no-build-isolation --no-index --no-deps --quiet --no-cache-dir \
  --disable-pip-version-check --root-user-action=ignore --target "$work/site" .
[ "$before" = "$(git status --porcelain --ignored=no 2>/dev/null || true)" ] || fail "building left files in the sources"

cd "$work"
unset ROPEWALK_DATA
# Its own data, not those of the sources: a set that only the wheel has is found.
sets=site/ropewalk/share/ropewalk/parameters
sed 's/^name *=.*/name = "only-here"/' "$sets/cnt-10-10-tersoff.toml" > only-here.toml
mv only-here.toml "$sets/"
cat > try.py <<'SCRIPT'
import os
import ropewalk
from ropewalk.programs import find_program

here = os.path.dirname(os.path.abspath(ropewalk.__file__))
assert here.startswith(os.getcwd()), here
assert find_program() == os.path.join(here, "bin", "ropewalk"), find_program()
scene = ropewalk.Scene({"parameters": "only-here", "rope": {"tubes": 7, "length_nm": 14}, "run": {"duration_ps": 1}})
simulation = ropewalk.Simulation(scene)
simulation.step(5)
run = ropewalk.run(scene, "run")
assert run.log["vdw_eV"][-1] < 0
assert ropewalk.validate(["ring-energy"], out="validation")[0].holds
SCRIPT
PYTHONPATH=$work/site "$python" -B try.py
PYTHONPATH=$work/site site/bin/ropewalk --version > said
grep -q "$(sed -n 's/^project(ropewalk VERSION \([0-9.]*\).*/\1/p' "$root/CMakeLists.txt")" said || fail "the command says: $(cat said)"
