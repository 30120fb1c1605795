#!/usr/bin/env bash
# The choice of lights: error at equal samples, and CPU time, in turns; relMSE against a reference that the learned choice
# rendered with another seed.      usage: benchmarks/lights.sh SCENE.xml INTEGRATOR SPP REFERENCE_TIME [AJAR [SIZE [SEEDS [CHOICES]]]]
set -euo pipefail
scene=${1?usage: benchmarks/lights.sh SCENE.xml INTEGRATOR SPP REFERENCE_TIME [AJAR [SIZE [SEEDS [CHOICES]]]]}
integrator=$2 spp=$3 reference=$4
ajar=${5:-"$(dirname "$0")/../build/release/ajar"}
size=${6:-240x135}
seeds=${7:-3}
choices=${8:-uniform power tree learned}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

phase() { grep '"cpu_seconds": {' -A8 "$work/image.json" | grep -m1 "\"$1\":" | sed -E 's/.*: *([-+0-9.e]+).*/\1/'; }

"$ajar" render "$scene" -o "$work/reference.exr" --size "$size" --cpu-time "$reference" --seed 1000 --threads 1 -q \
  --integrator "$integrator" --light-choice learned
for ((seed = 1; seed <= seeds; seed++)); do
  for choice in $choices; do
    "$ajar" render "$scene" -o "$work/image.exr" --size "$size" --spp "$spp" --seed $seed --threads 1 -q \
      --integrator "$integrator" --light-choice $choice
    error=$("$ajar" compare "$work/image.exr" "$work/reference.exr")
    awk -v c=$choice -v t="$(phase trace)" -v l="$(phase learn)" -v r="$(phase rebuild)" \
      -v e="$(sed -E 's/.*"relmse":([^,]*),.*/\1/' <<< "$error")" -v m="$(sed -E 's/.*"relmse_trimmed":([^,]*),.*/\1/' <<< "$error")" \
      'BEGIN { t += l + r; printf "%-8s relMSE %.4f  trimmed %.4f  CPU %.2f s  relMSE x CPU %.4f\n", c, e, m, t, e * t }'
  done
done
