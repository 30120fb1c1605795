#!/usr/bin/env bash
# CPU time of the same samples by two builds, in turns (A B B A) so that drift of the machine meets both alike: B over A.
# usage: builds.sh AJAR_A AJAR_B [ROUNDS [SPP [SCENE.xml ...]]]    2 rounds of 16 spp at 160x90; all scenes that are there
set -euo pipefail
a=${1?usage: builds.sh AJAR_A AJAR_B [ROUNDS [SPP [SCENE.xml ...]]]} b=${2?AJAR_B} rounds=${3:-2} spp=${4:-16}
root=$(dirname "$0")/..
if (($# > 4)); then shift 4; else source "$root/benchmarks/scenes.sh"; fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# seconds AJAR SCENE INTEGRATOR
seconds() {
  local all=()
  [[ $3 == guided* ]] && all=(--plan all)
  "$1" render "$2" -o "$work/image.exr" --integrator "$3" "${all[@]}" --size 160x90 --max-depth 10 --spp "$spp" --threads 1 -q &&
    python3 -c 'import json, sys; t = json.load(open(sys.argv[1]))["cpu_seconds"]; print(t["trace"] + t.get("learn", 0) + t.get("rebuild", 0))' "$work/image.json"
}
for scene; do
  for integrator in path bdpt guided-bdpt; do
    times=()
    for ((round = 0; round < rounds; round++)); do
      for ajar in "$a" "$b" "$b" "$a"; do times+=("$(seconds "$ajar" "$scene" "$integrator")") || continue 4; done
    done
    echo "$(basename "$(dirname "$scene")") $integrator ${times[*]}"
  done
done | python3 -c '
import math, sys
ratios = {}
for line in sys.stdin:
    scene, integrator, *times = line.split()
    t = list(map(float, times))
    a, b = sum(t[0::4]) + sum(t[3::4]), sum(t[1::4]) + sum(t[2::4])
    ratios.setdefault(integrator, []).append(b / a)
    print(f"{scene:12} {integrator:12} {a:8.2f} s {b:8.2f} s {b / a:6.3f}", flush=True)
for integrator, r in ratios.items():
    print(f"geometric mean of {len(r)} scenes, {integrator}: {math.exp(sum(map(math.log, r)) / len(r)):.3f}")
'
