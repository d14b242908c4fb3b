#!/usr/bin/env bash
# Strength of ropes of finite tubes against twist, length of the tubes and number of links: strength.csv. With the program
# given, or the one of the release build; twenty minutes of one core.
set -euo pipefail
cd "$(dirname "$0")"
ropewalk=$(realpath "${1:-../../../build/release/mdem/ropewalk}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp rope.toml strength.toml "$work"
cd "$work"
"$ropewalk" sweep strength.toml --quiet
"$ropewalk" gather strength --series -o series.csv
# The row of the largest stress of each point, and how many links there were and broke.
{
  echo tube_length_nm,links_per_nm,twist_deg_per_nm,seed,strength_GPa,strength_N_per_tex,strain,beta_deg,links,broken
  awk -F, -v OFS=, '
    NR == 1 { for (k = 1; k <= NF; ++k) at[$k] = k; next }
    { point = $at["rope.tube_length_nm"] OFS $at["links.0.per_nm"] OFS $at["start.twist_deg_per_nm"] OFS $at["start.seed"]
      if (!(point in most) || $at["stress_GPa"] > most[point]) {
        most[point] = $at["stress_GPa"]
        row[point] = sprintf("%.4g,%.4g,%.4g", $at["specific_stress_N_per_tex"], $at["ends_strain"], $at["beta_deg"])
      }
      links[point] = $at["links_formed"] OFS $at["links_broken"] }
    END { for (point in most) print point, sprintf("%.4g", most[point]), row[point], links[point] }
  ' series.csv | sort -t, -k1,1n -k2,2n -k3,3n -k4,4n
} >strength.csv
mv strength.csv "$OLDPWD/strength.csv"
