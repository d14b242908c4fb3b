#!/bin/sh
# Growth rates of ropes by their eigenvalues and by runs: growth.sh [PROGRAM]. Runs stay in runs/growth.
set -eu
cd "$(dirname "$0")"
program=$(realpath "$(command -v "${1:-ropewalk}")")
mkdir -p runs/growth
cd runs/growth

# scene KIND LENGTH MOMENT START PERTURBATION: a rope that is straight, or one that begins bent.
scene() {
  cat <<END
format = "ropewalk-scene-1"
parameters = "cnt-10-10-paper"
[rope]
tubes = 19
length_nm = $1
perturbation_nm = $4
$3
[contact]
precision = "double"
[twist]
moment_nN_nm = $2
rate_nN_nm_per_ps = 0.25
hold_ps = 500
[run]
log_every_ps = 2
END
}

# point LENGTH MOMENT TIMES...: eigenvalues of the straight rope at these times (ps), and the runs beside them.
point() {
  length=$1 moment=$2 name=$1-$2
  shift 2
  scene "$length" "$moment" "" 0 > "straight-$name.toml"
  scene "$length" "$moment" "[start]
wave_nm = 0.02" 0.0005 > "wave-$name.toml"
  go="run straight-$name.toml --out straight-$name --force"
  for time; do
    "$program" $go --until "$time" --threads 1 --quiet
    "$program" modes "straight-$name" --anyway --csv "straight-$name-$time.csv" --force
    # The same state at rest, and moved along the fastest growing motion.
    for far in 1e-9 0.02; do
      "$program" modes "straight-$name" --anyway --frame "moved-$name-$time-$far.csv" --amplitude $far --force > /dev/null
      cat > "moved-$name-$time-$far.toml" <<END
format = "ropewalk-scene-1"
parameters = "cnt-10-10-paper"
[state]
file = "moved-$name-$time-$far.csv"
[contact]
precision = "double"
[twist]
moment_nN_nm = $moment
rate_nN_nm_per_ps = 0
hold_ps = 10
END
      "$program" run "moved-$name-$time-$far.toml" --out "moved-$name-$time-$far" --threads 1 --quiet --force
    done
    go="resume straight-$name"
  done
  "$program" resume "straight-$name" --threads 1 --quiet
  "$program" run "wave-$name.toml" --out "wave-$name" --threads 1 --quiet --force
}
point 108.48 46 580 620 660
point 108.48 50 500 540
point 142.38 44 580 620 660
python3 ../../growth.py
