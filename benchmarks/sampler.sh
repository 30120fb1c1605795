#!/usr/bin/env bash
# Owen-scrambled Sobol points against independent numbers: relMSE at equal samples per pixel, mean over seeds, on the box scene
# and the door scene.      usage: benchmarks/sampler.sh [AJAR [SEEDS]]
set -euo pipefail
root=$(dirname "$0")/..
ajar=${1:-"$root/build/release/ajar"}
seeds=${2:-4}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

field() { sed -E "s/.*\"$1\":([^,}]*).*/\1/"; }

for scene in box ajar; do
  for integrator in path bdpt; do
    common=("$root/scenes/$scene/$scene.xml" --size 48x32 --integrator $integrator --max-depth 12 -q)
    "$ajar" render "${common[@]}" -o "$work/reference.exr" --spp 4096 --seed 4711
    for spp in 16 64 256; do
      for sampler in independent sobol; do
        sum=0
        for ((seed = 1; seed <= seeds; seed++)); do
          "$ajar" render "${common[@]}" -o "$work/image.exr" --spp $spp --seed $seed --sampler $sampler
          error=$("$ajar" compare "$work/image.exr" "$work/reference.exr" | field relmse)
          sum=$(awk "BEGIN { print $sum + $error }")
        done
        awk "BEGIN { printf \"%-5s %-5s %4d spp  %-12s relMSE %.3e\n\", \"$scene\", \"$integrator\", $spp, \"$sampler\", $sum / $seeds }"
      done
    done
  done
done
