#!/bin/sh
# Plans one scene, runs the planned model, the default and the finest, and holds the first against the last:
# one.sh PROGRAM SCENE [OPTION ...]. What exists is kept.
set -eu
program=$1 scene=$2
shift 2
name=$(basename "$scene" .toml)
mkdir -p runs
if [ ! -f "runs/$name-planned.toml" ]; then
  rm -f "runs/$name-finest.toml"
  "$program" plan "$scene" -j 2 --pilot-seconds 120 "$@" -o "runs/$name-planned.toml" --finest "runs/$name-finest.toml" >"runs/$name.txt" 2>&1
fi
cp "$scene" "runs/$name-default.toml"
for model in planned default finest; do
  run=runs/$name-$model
  grep -q '"status": "finished"' "$run/manifest.json" 2>/dev/null ||
    "$program" run "$run.toml" --out "$run" --threads 1 --force --quiet >"$run.txt" 2>&1 || true
done
"$program" plan --check "runs/$name-planned" --against "runs/$name-finest" >"runs/$name-check.txt" 2>&1
