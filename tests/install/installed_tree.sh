#!/usr/bin/env bash
# The installed tree: it works after it was moved and where nothing may be written, finds its own data, and other
# programs build against it. Arguments: the build, and "libraries" where they are to be tried as well.
set -euo pipefail
build=$(realpath "$1") here=$(realpath "$(dirname "$0")")
work=$(mktemp -d)
trap 'chmod -R u+w "$work"; rm -rf "$work"' EXIT
fail() { echo "installed_tree: $*" >&2; exit 1; }

DESTDIR=$work/stage cmake --install "$build" --prefix /first >/dev/null
mv "$work/stage/first" "$work/moved"
chmod -R a-w "$work/moved"
cd "$work"
unset ROPEWALK_DATA
ropewalk=$work/moved/bin/ropewalk

"$ropewalk" new rope >/dev/null
cat > seven.toml <<'SCENE'
format = "ropewalk-scene-1"
parameters = "cnt-10-10-tersoff"
[rope]
tubes = 7
length_nm = 14
[twist]
moment_nN_nm = 5
rate_nN_nm_per_ps = 5
SCENE
"$ropewalk" run seven.toml --out seven --quiet >/dev/null
[ -s seven/report.html ] || fail "the run left no report"
# The data are those of the tree, not those of the sources: a set that only the tree has is found.
chmod u+w moved/share/ropewalk/parameters
sed 's/^name *=.*/name = "only-here"/' moved/share/ropewalk/parameters/cnt-10-10-tersoff.toml > only-here.toml
mv only-here.toml moved/share/ropewalk/parameters/
sed 's/cnt-10-10-tersoff/only-here/' seven.toml > other.toml
"$ropewalk" check other.toml >/dev/null || fail "the data beside the program are not found"
"$ropewalk" calibrate show cnt-10-10-tersoff --table > table
grep -q EI table || fail "ropewalk calibrate is not found"
"$ropewalk" validate list > cases
grep -q euler cases || fail "ropewalk validate is not found"

grep -q 'time_step_fs' moved/share/man/man1/ropewalk.1 || fail "the man page lacks the keys of a scene"
completed() {
  bash -c 'source moved/share/bash-completion/completions/ropewalk
  COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)); _ropewalk; echo "${COMPREPLY[@]}"' - "$@"
}
completes() { [ "$(completed ropewalk "${@:2}")" = "$1" ] || fail "bash completes ${*:2} to: $(completed ropewalk "${@:2}")"; }
completes threshold thr
completes "spindle" new x --kind sp
completes "stop" sweep --on-limit st
completes "refine" run x.toml --on-limit re
completes "cnt-6-4-tersoff cnt-6-6-tersoff" energy --parameters cnt-6
completes "cnt-6-4-tersoff cnt-6-6-tersoff" calibrate show cnt-6
completes "friction" calibrate fric
completes "seven seven.toml" check sev
for program in ropewalk ropewalk-calibrate ropewalk-validate; do
  for file in "share/man/man1/$program.1" "share/zsh/vendor-completions/_$program" \
    "share/fish/vendor_completions.d/$program.fish"; do
    [ -s "moved/$file" ] || fail "no $file"
  done
done

# The Python package, where it was built, works with the programs and data of its own tree.
if [ -d moved/lib/python3/dist-packages/ropewalk ]; then
  PYTHONPATH=$work/moved/lib/python3/dist-packages /usr/bin/python3 -B - <<'SCRIPT' || fail "the Python package does not work"
import os, ropewalk
from ropewalk.programs import find_program
assert find_program() == os.path.abspath("moved/bin/ropewalk"), find_program()
run = ropewalk.run(ropewalk.Scene("other.toml"), "by-python")
assert len(run.frames) > 1 and ropewalk.ParameterSet("only-here").grade == "good"
SCRIPT
fi

[ "${2:-}" = libraries ] || exit 0
cmake -S "$here/consumer" -B consumer -DCMAKE_PREFIX_PATH="$work/moved" -DCMAKE_BUILD_TYPE=Release >/dev/null
cmake --build consumer >/dev/null
consumer/twist only-here > said || fail "the consumer does not find the data of the tree that it was built against"
grep -q "70 elements" said || fail "the consumer's rope is wrong"
grep -q "s of processor time" said || fail "the consumer cannot time a run"
[ ! -e from-memory.toml ] || fail "the consumer left a file"
# A load, a scene kind, a contact law and a force term of one's own, registered by programs outside of this tree, in scenes that name them.
cmake -S "$here/own_parts" -B own_parts -DCMAKE_PREFIX_PATH="$work/moved" -DCMAKE_BUILD_TYPE=Release >/dev/null
cmake --build own_parts --parallel 2 >/dev/null
cat > pair.toml <<'SCENE'
format = "ropewalk-scene-1"
parameters = "cnt-10-10-tersoff"
[pair]
length_nm = 14
apart_nm = 1.8
[[load]]
kind = "wind"
elements = "all"
growth_nN_per_nm = 1e-3
[run]
duration_ps = 1
SCENE
own_parts/my-ropewalk run pair.toml --out pair --quiet > said || fail "ropewalk with a kind and a load of one's own: $(cat said)"
[ -s pair/report.html ] && own_parts/my-ropewalk help pair | grep -q 'apart_nm' || fail "the kind of one's own has no help"
# With all four: two rows of beads rest apart a bit nearer than two beads do, and the trap is in log, balance and help.
cat > four.toml <<'SCENE'
format = "ropewalk-scene-1"
parameters = "cnt-10-10-tersoff"
[pair]
length_nm = 14
apart_nm = 1.8
[contact]
law = "beads"
[damping]
contact_viscosity_eV_ps_per_nm3 = 0
[trap]
stiffness_nN_per_nm = 0.01
[[load]]
kind = "wind"
elements = "all"
growth_nN_per_nm = 1e-3
[run]
duration_ps = 2
time_step_fs = 20
SCENE
own_parts/my-ropewalk help wind | grep -q 'growth_nN_per_nm' || fail "the load of one's own has no help"
own_parts/my-ropewalk run four.toml --out four --quiet > said || fail "ropewalk with four parts of one's own: $(cat said)"
own_parts/my-ropewalk check four.toml > said
grep -q 'forces with contact law beads, drive trap: they follow from the energy' said || fail "check: $(cat said)"
own_parts/my-ropewalk help trap | grep -q 'stiffness_nN_per_nm' || fail "the force term of one's own has no help"
python3 - <<'SCRIPT' || fail "the trap, or the law of beads, is not that of its formula"
import csv, math
log, last = list(csv.DictReader(open("four/log.csv"))), list(csv.DictReader(l for l in open("four/final.csv") if l[0] != "#"))
stiffness, radius = 0.01 / 0.1602176634, 0.688794  # eV/nm^2, nm
trapped = sum(0.5 * stiffness * (float(r["x_nm"])**2 + float(r["y_nm"])**2) for r in last)
places = [[(float(r["x_nm"]), float(r["y_nm"]), float(r["z_nm"])) for r in last if r["tube"] == t] for t in "01"]
def bead(r, rest=2 * radius + 0.335, depth=0.5, cutoff=4.5):
    def well(r):
        p = 0.5 * (rest / r)**6
        return 4 * depth * (p * p - p), 4 * depth * (6 * p - 12 * p * p) / r
    return well(r)[0] - well(cutoff)[0] - (r - cutoff) * well(cutoff)[1] if r < cutoff else 0
bound = sum(bead(math.dist(a, b)) for a in places[0] for b in places[1])
end = log[-1]
for name, found, wanted in (("trap", float(end["trap_eV"]), trapped), ("vdw", float(end["vdw_eV"]), bound)):
    assert wanted != 0 and abs(found / wanted - 1) < 1e-4, (name, found, wanted)
assert abs(float(end["balance_eV"])) < 1e-3 * float(end["kinetic_eV"]), end["balance_eV"]
SCRIPT
# The run says whose it is; programs without these parts refuse it by name, and there is no LAMMPS for it.
grep -q '"program": "my-ropewalk"' four/manifest.json || fail "the manifest does not name the program"
for verb in "report four" "observe four" "resume four --until 3"; do
  "$ropewalk" $verb 2> said && fail "the program without these parts takes the run"
  grep -q "was run by my-ropewalk, a program with parts of its own, and ropewalk lacks its scene kind pair" said ||
    fail "ropewalk $verb: $(cat said)"
done
own_parts/my-ropewalk resume four --until 2.1 --quiet || fail "the program of the run does not resume it"
own_parts/my-ropewalk export pair.toml --lammps never 2> said && fail "LAMMPS is given what it lacks"
grep -q "pair.toml:3: pair: is not for LAMMPS: lmp-ropewalk has no scene kind pair" said || fail "export: $(cat said)"
[ ! -e never ] || fail "export left a directory"
own_parts/my-ropewalk run pair.toml --out other --wall-time 60 --slurm job.sh >/dev/null
grep -q "$PWD/own_parts/my-ropewalk" job.sh || fail "the job starts another program: $(cat job.sh)"
sed 's/^apart_nm.*/apart = 1.8/' pair.toml > bad.toml
own_parts/my-ropewalk check bad.toml 2> said && fail "an unknown key of the kind is taken"
grep -q 'pair.apart_nm: is missing; did you mean it by "apart"' said || fail "the kind's own key is not named: $(cat said)"
own_parts/own_parts "$here/own_parts/wind.toml" || fail "the tube in the wind does not bend as a beam does"
sed '/^growth/d' "$here/own_parts/wind.toml" > calm.toml
own_parts/own_parts calm.toml 2> said && fail "a scene without growth_nN_per_nm runs"
grep -q "load.growth_nN_per_nm: is missing" said || fail "the load's own key is not named: $(cat said)"
