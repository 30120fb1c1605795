#!/usr/bin/env bash
# Samples per CPU second, rays per CPU second, memory, and how one thread scales to two, in turns so that drift of the machine
# meets all alike.      usage: benchmarks/speed.sh SCENE.xml [AJAR [SIZE [ROUNDS]]]
set -euo pipefail
scene=${1?usage: benchmarks/speed.sh SCENE.xml [AJAR [SIZE [ROUNDS]]]}
ajar=${2:-"$(dirname "$0")/../build/release/ajar"}
size=${3:-320x180}
rounds=${4:-3}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

number() { grep -m1 "\"$1\":" "$work/image.json" | sed -E 's/.*: *([-+0-9.e]+).*/\1/'; }

for ((round = 1; round <= rounds; round++)); do
  for integrator in path bdpt light; do
    for threads in 1 2; do
      "$ajar" render "$scene" -o "$work/image.exr" --size "$size" --spp 16 --max-depth 10 --integrator $integrator --threads $threads -q
      samples=$(number samples_per_cpu_second)
      rays=$(number rays_per_second)
      cpu_rays=$(number rays_per_cpu_second)
      memory=$(number memory_peak_bytes)
      awk "BEGIN { printf \"%-5s %d threads  %.3f us CPU/sample  %.3f Mrays/CPU s  %.3f Mrays/s  %.0f MB\n\", \
        \"$integrator\", $threads, 1e6 / $samples, $cpu_rays / 1e6, $rays / 1e6, $memory / 1e6 }"
    done
  done
done
