#!/usr/bin/env bash
# The jobs of `ropewalk run --slurm`, `sweep --slurm`, `threshold --slurm` and `export --lammps` on a cluster of one
# node, which this test starts as whoever runs it. ropewalk is not on the PATH. Arguments: ropewalk, lmp-ropewalk.
set -euo pipefail
command -v slurmctld slurmd sbatch >/dev/null || { echo "slurm: skipped, apt-get install slurm-wlm" >&2; exit 77; }
ropewalk=$(realpath "$1")
lmp=${2:+$(realpath "$2")}
work=$(mktemp -d)
started=()
finish() {
  for pid in "${started[@]}"; do kill "$pid" && wait "$pid" || true; done
  rm -rf "$work"
}
trap finish EXIT
fail() { echo "slurm: $*" >&2; tail -n 5 "$work"/slurm*.log "$work"/study/messages/slurm-*.txt >&2 || true; exit 1; }
patiently() { for _ in $(seq 1200); do "$@" && return; sleep 0.25; done; return 1; }
cd "$work"

mkdir state spool scenes elsewhere
port=$(/usr/bin/python3 -c 'import socket; s = [socket.socket() for _ in "12"]; [x.bind(("", 0)) for x in s]; print(*(x.getsockname()[1] for x in s))')
export SLURM_CONF=$work/slurm.conf
cat > slurm.conf <<CONF
ClusterName=one
SlurmctldHost=$(hostname -s)(127.0.0.1)
SlurmctldPort=${port% *}
SlurmdPort=${port#* }
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/none
CredType=cred/none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
MailProg=/bin/true
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
NodeName=$(hostname -s) NodeAddr=127.0.0.1 CPUs=$(nproc)
PartitionName=all Nodes=ALL Default=YES
CONF
for daemon in slurmctld slurmd; do
  $daemon -D > /dev/null 2>&1 &
  started+=($!)
done
is_up() { sinfo -h -o %T 2> /dev/null | grep -q idle; }
patiently is_up || fail "the cluster does not start"

cat > scenes/rope.toml <<'SCENE'
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
sweep() { printf 'format = "ropewalk-sweep-1"\nscene = "rope.toml"\n[vary]\n%s\n' "$2" > "scenes/$1.toml"; }
sweep sizes 'rope.tubes = [1, 7]'
sweep many 'start.seed = { from = 1, to = 1500, points = 1500 }'

"$ropewalk" sweep scenes/sizes.toml --out study --slurm job.sh >/dev/null
is_done() { [ -z "$(squeue -h)" ]; }
(cd elsewhere && sbatch ../job.sh >/dev/null) || fail "the array is refused"
patiently is_done || fail "the array does not end"
"$ropewalk" gather study --columns time_ps > table.csv || fail "the campaign is none"
[ "$(grep -c ',finished,' table.csv)" = 2 ] || fail "not all points are done: $(cat table.csv)"
[ -z "$(ls elsewhere)" ] || fail "files are left where the job was submitted: $(ls elsewhere)"

# One run in pieces: each job submits the next one, which after the first piece has time for all the rest.
sed 's/^tubes = 1/tubes = 37/; s/^length_nm = 14/length_nm = 40/; s/^duration_ps = .*/duration_ps = 12/' scenes/rope.toml > scenes/long.toml
"$ropewalk" run scenes/long.toml --out long --wall-time 1 --slurm long.sh >/dev/null
(cd elsewhere && sbatch ../long.sh >/dev/null) || fail "the job of a run is refused"
patiently grep -q 'Submitted batch job' long.messages.txt || fail "one job was enough: $(cat long.messages.txt)"
sed -i "s/--wall-time '1'/--wall-time '1000'/" long.sh
patiently is_done || fail "the jobs of a run do not end: $(cat long.messages.txt)"
grep -q '"status": "finished"' long/manifest.json || fail "the run is not done: $(cat long.messages.txt)"
[ -z "$(ls elsewhere)" ] || fail "files are left where the job was submitted: $(ls elsewhere)"
"$ropewalk" run scenes/long.toml --out long --wall-time 1 --slurm again.sh 2> said && fail "a job would resume another run"
grep -q 'is there already' said || fail "an earlier run is not named: $(cat said)"

# A job on two ranks of LAMMPS, which asks SLURM when it ends: a whole one, and one whose first piece has a second. The
# next one goes on to the same state.
if [ -n "$lmp" ]; then
  mkdir bin && ln -s "$lmp" bin/lmp-ropewalk
  sed 's/^duration_ps = .*/duration_ps = 40/' scenes/long.toml > scenes/ranks.toml
  for job in whole pieces; do
    "$ropewalk" export scenes/ranks.toml --lammps $job >/dev/null
    sed -i 's/--ntasks=.*/--ntasks=2/; s/--time=.*/--time=00:05:00/' $job/job.sh
    [ $job = whole ] || sed -i 's/^srun lmp/[ -e first ] || { touch first; wall="-var wall 1"; }\n&/' $job/job.sh
    (cd $job && PATH=$work/bin:$PATH OMPI_ALLOW_RUN_AS_ROOT=1 sbatch job.sh >/dev/null) || fail "the job of ranks is refused"
    patiently is_done || fail "the job of ranks does not end: $(cat $job/messages.txt)"
    ! grep -q 'does not tell' $job/messages.txt || fail "a job of ranks does not know its end"
    grep -q 'by 2 MPI' $job/messages.txt || fail "not two ranks: $(cat $job/messages.txt)"
    "$ropewalk" import $job >/dev/null || fail "what ranks wrote is not taken: $(cat $job/messages.txt)"
  done
  grep -q 'Submitted batch job' pieces/messages.txt || fail "one job was enough: $(cat pieces/messages.txt)"
  grep -q '"status": "finished"' pieces/manifest.json || fail "the pieces do not reach the end"
  # The same bits where the piece could stop at a multiple of 512 steps, which a busy machine does not reach in a second.
  paste -d, <(grep -v '^#' whole/final.csv) <(grep -v '^#' pieces/final.csv) | awk -F, '
    NR > 1 { n = NF / 2; for (i = 1; i <= n; ++i) { d = $i - $(i + n); if (d * d > 1e-8) { print; bad = 1 } } }
    END { exit bad || NR < 60 }' || fail "a job in pieces goes elsewhere"
fi

# A search for thresholds, one point a task; the same command then makes the page of all.
{ printf 'format = "ropewalk-sweep-1"\nscene = "rope.toml"\n[threshold]\nkey = "twist.moment_nN_nm"\nfrom = 1\nto = 9\n'
  printf 'column = "moment_nN_nm"\nabove = 2\naccuracy = 0.2\n[vary]\nrope.length_nm = [14, 21]\n'; } > scenes/turn.toml
"$ropewalk" threshold scenes/turn.toml --out turn --slurm turn.sh >/dev/null
(cd elsewhere && sbatch ../turn.sh >/dev/null) || fail "the array of a search is refused"
patiently is_done || fail "the array of a search does not end"
[ "$(ls turn/points/*/threshold.csv | wc -l)" = 2 ] || fail "not both points are searched: $(cat turn/messages/*.txt)"
runs=$(ls -d turn/points/*/moment* | wc -l)
"$ropewalk" threshold scenes/turn.toml --out turn --quiet > said || fail "the search is none"
[ "$(ls -d turn/points/*/moment* | wc -l)" = "$runs" ] || fail "trials are run again"
grep -q 'by bisection [0-9]' said || fail "no threshold is found: $(cat said)"

# More points than SLURM has tasks by default.
"$ropewalk" sweep scenes/many.toml --slurm many.sh >/dev/null
sbatch --hold many.sh > said 2>&1 || fail "an array of 1500 points is refused: $(cat said)"
scancel --me
chosen=$(SLURM_ARRAY_TASK_ID=750 bash -c "$(sed -n 's/^exec .*--only \(".*"\) --jobs.*/echo \1/p' many.sh)")
[ "$chosen" = 750,1500 ] || fail "the last task of 1500 points runs $chosen"
