#!/usr/bin/env bash
# The modules of the page in space hold to eslint: no name without a definition or an import, none that is not used, none
# written to from another module.
#
#     scripts.sh REPOSITORY
set -euo pipefail
command -v eslint >/dev/null || { echo "eslint is not installed"; exit 77; }
export NODE_PATH=/usr/share/nodejs  # of Debian, where another node than Debian's looks elsewhere
cd "$1/mdem/report/view"
lint=(eslint -f unix -c "$PWD/.eslintrc.json" --no-eslintrc)
"${lint[@]}" ./*.js

# The test of the test: each of these faults is seen.
bad=$(mktemp -d)
trap 'rm -r "$bad"' EXIT
cd "$bad"
while IFS='|' read -r rule line; do
  printf 'import {frames} from "./frames.js";\n%s\n' "$line" >bad.js
  "${lint[@]}" bad.js >said && { echo "not seen: $line"; exit 1; }
  grep -q "$rule" said || { echo "$line: said instead:"; cat said; exit 1; }
done <<'FAULTS'
no-undef|export const twice = 2 * frame + frames;
no-unused-vars|export const one = 1;
no-import-assign|frames = 2;
eqeqeq|export const none = frames == 0;
FAULTS
