#!/usr/bin/env bash
# Holds the kernels of a device to compilers that are stricter than the one that runs them in the other tests:
#
#   clang, which comes with PoCL: OpenCL C 1.2 to the letter
#   nvcc, where it is installed: no register is spilled, and enough groups fit on a multiprocessor
#
#   tests/device/compilers.sh SOURCE_DIR       exit code 77: neither compiler is there
set -euo pipefail
model=$1/mdem/model kernels=$1/mdem/sim/device
here=$(cd "$(dirname "$0")" && pwd)
scratch=$(mktemp -d)
trap 'rm -r "$scratch"' EXIT
PATH=$PATH:/usr/local/cuda/bin
compilers=0

numbers() { printf '#define NODES %s\n#define TYPES %s\n#define LOCAL_TYPES TYPES\n' "$1" "$2"; }

clang=$(command -v clang || command -v clang-15 || true)
if [ -n "$clang" ]; then
  compilers=$((compilers + 1))
  { numbers 5 1; cat "$model"/{dialect,forms}.h "$kernels"/{dialect,types,kernels}.h; } > "$scratch/kernels.cl"
  "$clang" -x cl -cl-std=CL1.2 -Wall -pedantic-errors -Werror -fsyntax-only -Xclang -finclude-default-header "$scratch/kernels.cl"
  echo "$clang takes the kernels as OpenCL C 1.2"
fi

if nvcc=$(command -v nvcc); then
  compilers=$((compilers + 1))
  for types in 1 6; do
    { numbers 5 "$types"; cat "$here/cuda_dialect.h" "$model/forms.h" "$kernels"/{types,kernels}.h; } > "$scratch/kernels.cu"
    "$nvcc" -arch=sm_90 -fmad=false -Xptxas -v -cubin -o "$scratch/kernels.cubin" "$scratch/kernels.cu" 2> "$scratch/told"
    awk -v types="$types" '
      /Compiling entry function/ { split($0, of, "\x27"); kernel = of[2] }
      /spill stores/ && !/ 0 bytes spill stores, 0 bytes spill loads/ { print kernel ": " $0; bad = 1 }
      /Used [0-9]+ registers/ { match($0, /Used [0-9]+/); used = substr($0, RSTART + 5, RLENGTH - 5) + 0; count++
        if (kernel == "line_contact") print kernel " with " types " types of tubes: " used " registers"
        # 65536 registers: 8 groups of 128 on a multiprocessor, half of those that fit at most
        if (used > (kernel == "line_contact" ? 64 : 128)) { print kernel ": " used " registers"; bad = 1 } }
      END { if (count < 12) { print count " kernels were compiled"; bad = 1 } exit bad }' "$scratch/told"
  done
fi
[ "$compilers" -gt 0 ] || exit 77
