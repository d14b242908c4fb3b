#!/usr/bin/env bash
# The frames of a rope, a film and a film of two kinds of tubes, read by LAMMPS, MDAnalysis, ASE and gsd. Argument: ropewalk.
set -euo pipefail
ropewalk=$(realpath "$1") here=$(realpath "$(dirname "$0")")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1

scene() { printf 'format = "ropewalk-scene-1"\n%s\n[run]\nduration_ps = 2\nframes_every_ps = 0.5\n' "$2" > "$1.toml"; }
scene rope 'parameters = "cnt-10-10-tersoff"
[rope]
tubes = 7
length_nm = 14
[twist]
moment_nN_nm = 5
rate_nN_nm_per_ps = 5'
scene film 'parameters = "cnt-10-10-tersoff"
[film]
tubes = 5
length_nm = 14
width_nm = 20
depth_nm = 20'
scene mixed 'parameters = ["cnt-5-5-tersoff", "cnt-10-10-tersoff"]
tube_types = [0, 1]
[film]
tubes = 2
length_nm = 14
width_nm = 20
depth_nm = 20'

for name in rope film mixed; do
  "$ropewalk" run $name.toml --out $name --quiet >/dev/null
  "$ropewalk" convert $name $name/frames.lammpstrj >/dev/null
  last=$(grep -A1 'ITEM: TIMESTEP' $name/frames.lammpstrj | tail -1)
  cat > in.read <<LAMMPS
units nano
atom_style atomic
boundary f f f
region box block -100 100 -100 100 -100 100
create_box 3 box
mass * 1
read_dump $name/frames.lammpstrj $last x y z box yes add yes replace no format native
print "read \$(atoms)"
LAMMPS
  lmp -in in.read -log none > lammps.txt || { tail -3 lammps.txt >&2; exit 1; }
  elements=$(grep -c '^[0-9]' $name/final.csv)
  grep -qx "read $elements" lammps.txt || { echo "LAMMPS reads another number of elements of $name" >&2; exit 1; }
  /usr/bin/python3 -W ignore "$here/read_frames.py" $name
done
