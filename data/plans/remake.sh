#!/bin/sh
# Plans all scenes, runs them with three models each and holds them against the finest: remake.sh [PROGRAM], half an hour of
# two cores. A second call goes on where the first one stopped. Leave the machine alone meanwhile: times are compared.
set -eu
cd "$(dirname "$0")"
program=${1:-ropewalk}
for scene in scenes/*.toml; do ./one.sh "$program" "$scene"; done
./table.sh >plans.csv
