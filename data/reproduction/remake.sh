#!/bin/sh
# Runs everything on this page anew: remake.sh [PROGRAM], about four hours on two cores. Runs stay in runs/, and a second call
# goes on where the first one stopped.
set -eu
cd "$(dirname "$0")"
program=${1:-ropewalk}
for figure in fig2 fig3 fig3-pfc fig3-calibrated fig4 rates video; do
  "$program" sweep $figure.toml --out runs/$figure
  "$program" gather runs/$figure -o $figure.csv --force \
    --columns time_ps,beta_deg,twist_eV,bend_eV,vdw_eV,dissipated_eV,Q,Q_delaunay,void_area_nm2,amplitude_nm,windings
  "$program" gather runs/$figure --series --columns time_ps,moment_nN_nm,twist_eV,Q | awk -f release.awk >$figure-release.csv
done
"$program" sweep helices.toml --out runs/helices
"$program" gather runs/helices -o helices.csv --force \
  --columns time_ps,beta_deg,twist_eV,bend_eV,amplitude_nm,windings,helix_radius_nm,pitch_nm
"$program" threshold atoms.toml --out runs/atoms
cp runs/atoms/thresholds.csv atoms-thresholds.csv
cp runs/atoms/trials.csv atoms-trials.csv
"$program" threshold fig5.toml --out runs/fig5
cp runs/fig5/thresholds.csv fig5-thresholds.csv
cp runs/fig5/trials.csv fig5-gentle-trials.csv
cp runs/fig5/thresholds.html fig5.html
for theory in fig5-theory fig5-viscosity; do
  "$program" threshold $theory.toml --out runs/$theory --theory
  cp runs/$theory/thresholds.csv $theory.csv
  cp runs/$theory/thresholds.html $theory.html
done
viscous=contact_viscosity_eV_ps_per_nm2
curves=twist_eV+bend_eV+vdw_eV,Q
"$program" picture runs/fig2/points/moment_nN_nm-64_$viscous-8 --at 32,64,100,214 --sections --curves $curves \
  -o fig2.svg --force
"$program" picture runs/fig3/points/moment_nN_nm-64_$viscous-8 --at 32,64,100,364 --sections --curves $curves \
  -o fig3.svg --force
"$program" picture runs/fig4/points/moment_nN_nm-64 --at 94,250,400,694 --curves twist_eV+bend_eV,amplitude_nm --highest 120 \
  -o fig4.svg --force
"$program" picture runs/helices/points/tubes-19_length_nm-271.2_moment_nN_nm-52_hold_ps-400 --at 300,400,500,660 --highest 110 \
  -o helices.svg --force
# The film of the paper's video: needs ffmpeg.
if command -v ffmpeg >/dev/null; then "$program" view runs/video/points/* --movie video.webm --force; fi
