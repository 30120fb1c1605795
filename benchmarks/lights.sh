#!/usr/bin/env bash
# The choice of lights: error at equal samples, and CPU time, in turns; relMSE against a reference that the last choice
# rendered with another seed. At the end every choice over the first one: geometric mean of error (without the worst 0.1 % of
# pixels) times CPU time, and the standard error of that mean. What guides does so to the end.
# usage: benchmarks/lights.sh SCENE.xml INTEGRATOR SPP REFERENCE_TIME [AJAR [SIZE [SEEDS [CHOICES]]]]
#   CHOICES "uniform power tree learned"; path, bdpt and what guides can learn
set -euo pipefail
scene=${1?usage: benchmarks/lights.sh SCENE.xml INTEGRATOR SPP REFERENCE_TIME [AJAR [SIZE [SEEDS [CHOICES]]]]}
integrator=${2?INTEGRATOR} spp=${3?SPP} reference=${4?REFERENCE_TIME}
ajar=${5:-"$(dirname "$0")/../build/release/ajar"}
size=${6:-240x135}
seeds=${7:-3}
choices=${8:-uniform power tree learned}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
all=()
[[ $integrator == guided* ]] && all=(--plan all)

# render FILE CHOICE SEED LIMIT...
render() {
  "$ajar" render "$scene" -o "$1" --size "$size" --integrator "$integrator" "${all[@]}" --light-choice "$2" --seed "$3" \
    "${@:4}" --threads 1 -q
}
render "$work/reference.exr" "${choices##* }" 1000 --cpu-time "$reference"
for ((seed = 1; seed <= seeds; seed++)); do
  for choice in $choices; do
    render "$work/image.exr" "$choice" "$seed" --spp "$spp"
    echo "$choice $("$ajar" compare "$work/image.exr" "$work/reference.exr")" "$(tr -d '\n' < "$work/image.json")"
  done
done | python3 -c '
import json, math, sys
costs, read = {}, json.JSONDecoder().raw_decode
for line in sys.stdin:
    choice, rest = line.split(" ", 1)
    error, end = read(rest)
    record, _ = read(rest[end:].lstrip())
    cpu = sum(record["cpu_seconds"].get(part, 0) for part in ("trace", "learn", "rebuild"))
    relmse, trimmed = error["relmse"], error["relmse_trimmed"]
    costs.setdefault(choice, []).append(math.log(trimmed * cpu))
    print(f"{choice:8} relMSE {relmse:.4g}  trimmed {trimmed:.4g}  CPU {cpu:.2f} s  relMSE x CPU {relmse * cpu:.4g}", flush=True)
first = next(iter(costs))
for choice, of_seeds in costs.items():
    ratios = [a - b for a, b in zip(of_seeds, costs[first])]
    mean = sum(ratios) / len(ratios)
    spread = math.sqrt(sum((r - mean) ** 2 for r in ratios) / max(len(ratios) - 1, 1) / len(ratios))
    if choice != first:
        print(f"{choice} over {first}: {math.exp(mean):.3f} +- {math.exp(mean) * spread:.3f}")
'
