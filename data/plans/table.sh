#!/bin/sh
# plans.csv from runs/: what was promised and what was seen of each scene.
set -eu
cd "$(dirname "$0")"
echo "scene,model,pilots,planning_s,promised_percent,seen_percent,held,promised_s,seen_s,default_promised_s,default_seen_s,finest_s"
for check in runs/*-check.txt; do
  name=$(basename "$check" -check.txt)
  plan=runs/$name.txt
  wall() { sed -n 's/.*"wall_seconds": \([0-9.]*\),/\1/p' "runs/$name-$1/manifest.json"; }
  model=$(sed -n 's/^planned for [0-9.]* %: \(.*\)\. Errors promised:/\1/p' "$plan")
  pilots=$(sed -n 's/^pilots: \(.*\), [0-9.e+-]* s of processor time.*/\1/p' "$plan")
  planning=$(sed -n 's/^pilots: .*, \([0-9.e+-]*\) s of processor time.*/\1/p' "$plan")
  promised=$(awk '$6 == "%" && $5 + 0 > most { most = $5 + 0 } $7 == "%" && $6 + 0 > most { most = $6 + 0 } END { print most }' "$check")
  seen=$(sed -n 's/.* at most \([0-9.]*\) % seen: .*/\1/p' "$check")
  held=$(sed -n 's/.* % seen: \(.*\)/\1/p' "$check")
  times=$(sed -n 's/^processor time promised: \([0-9.e+]*\) s; with the default model \([0-9.e+]*\) s/\1 \2/p' "$plan")
  printf '%s,"%s","%s",%s,%s,%s,%s,%s,%.3g,%s,%.3g,%.3g\n' "$name" "$model" "$pilots" "$planning" "$promised" "$seen" "$held" \
    "${times% *}" "$(wall planned)" "${times#* }" "$(wall default)" "$(wall finest)"
done
