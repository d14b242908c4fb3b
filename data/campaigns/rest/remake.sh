#!/usr/bin/env bash
# Where ropes come to rest, from both sides: states.csv. With the program given, or the one of the release build.
set -euo pipefail
cd "$(dirname "$0")"
ropewalk=$(realpath "${1:-../../../build/release/mdem/ropewalk}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
echo "set,tubes,moment_nN_nm,hold_ps,viscosity_eV_ps_per_nm3,from,start_deg_per_nm,time_ps,geometric_twist_deg,drift_deg_per_ps,beta_deg,least_beta_deg,most_beta_deg,Q,void_area_nm2,branch,limit_deg,limit_drift_deg,limit_statistics_deg,approach_ps" >"$work/states.csv"
while read -r set tubes moment hold viscosity; do
  name=$set-$tubes-$moment-$viscosity
  sed -e "s/cnt-10-10-paper/$set/" -e "s/^tubes = .*/tubes = $tubes/" -e "s/^moment_nN_nm = .*/moment_nN_nm = $moment/" \
    -e "s/^hold_ps = .*/hold_ps = $hold/" rope.toml >"$work/$name.toml"
  "$ropewalk" rest "$work/$name.toml" --out "$work/$name" --viscosity "$viscosity" --quiet
  tail -n +2 "$work/$name/rest.csv" | sed "s/^/$set,$tubes,$moment,$hold,$viscosity,/" >>"$work/states.csv"
done <<'END'
cnt-10-10-paper 7 10 3000 2.7
cnt-10-10-paper 7 20 1000 2.7
cnt-10-10-paper 7 35 1000 2.7
cnt-10-10-paper 19 10 3000 2.7
cnt-10-10-paper 19 20 1500 2.7
cnt-10-10-paper 19 35 1000 2.7
cnt-10-10-paper 19 35 2000 0.27
cnt-10-10-paper 19 35 2000 27
cnt-10-10-paper 37 20 1500 2.7
cnt-10-10-paper 37 35 1000 2.7
cnt-10-10-paper 91 35 800 2.7
cnt-10-10-paper 91 50 800 2.7
cnt-10-10-tersoff 37 15 1500 2.7
cnt-10-10-tersoff 91 15 1500 2.7
cnt-10-10-tersoff 91 9 2500 2.7
END
mv "$work/states.csv" states.csv
