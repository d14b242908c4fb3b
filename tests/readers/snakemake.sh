#!/usr/bin/env bash
# What `ropewalk sweep --snakemake` and `threshold --snakemake` write, run by Snakemake: each point is done once, the page of all is made, and a
# second call has nothing to do. Argument: ropewalk.
set -euo pipefail
command -v snakemake >/dev/null || { echo "snakemake: skipped, apt-get install snakemake" >&2; exit 77; }
ropewalk=$(realpath "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "snakemake: $*" >&2; tail -n 20 "$work/said" >&2; exit 1; }
cd "$work"
export HOME=$work

cat > rope.toml <<'SCENE'
format = "ropewalk-scene-1"
parameters = "cnt-10-10-tersoff"
[rope]
tubes = 1
length_nm = 14
[twist]
moment_nN_nm = 5
rate_nN_nm_per_ps = 5
[run]
duration_ps = 0.5
SCENE
head='format = "ropewalk-sweep-1"\nscene = "rope.toml"\n'
printf "$head"'[vary]\nrope.tubes = [1, 7]\n' > sizes.toml
printf "$head"'[threshold]\nkey = "twist.moment_nN_nm"\nfrom = 1\nto = 9\ncolumn = "moment_nN_nm"\nabove = 2
accuracy = 0.2\n[vary]\nrope.length_nm = [14, 21]\n' > turn.toml

# workflow VERB FILE: runs it with two cores, twice.
workflow() {
  "$ropewalk" "$1" "$2" --snakemake "$1.smk" > /dev/null
  snakemake -s "$1.smk" --cores 2 > said 2>&1 || fail "the workflow of $2 fails"
  snakemake -s "$1.smk" --cores 2 > said 2>&1 || fail "the second call for $2 fails"
  grep -q 'Nothing to be done' said || fail "the second call for $2 does something again"
}
workflow sweep sizes.toml
[ "$(ls sizes/points/*/report.html | wc -l)" = 2 ] || fail "not both points are run"
"$ropewalk" gather sizes --columns time_ps > table.csv
[ "$(grep -c ',finished,' table.csv)" = 2 ] || fail "not both points are done: $(cat table.csv)"

workflow threshold turn.toml
[ "$(ls turn/points/*/threshold.csv | wc -l)" = 2 ] || fail "not both points are searched"
[ -s turn/thresholds.html ] || fail "the page is missing"
[ "$(grep -c '^[0-9]' turn/thresholds.csv)" = 2 ] || fail "the table has not both points: $(cat turn/thresholds.csv)"
