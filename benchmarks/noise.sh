#!/usr/bin/env bash
# Does --noise keep its word? Renders until the target with many seeds, 48x32 pixels; the error of each against a long render.
# usage: benchmarks/noise.sh [AJAR [SEEDS [REFERENCE_SPP]]]
set -euo pipefail
root=$(dirname "$0")/..
ajar=${1:-"$root/build/release/ajar"}
seeds=${2:-12}
long=${3:-4096}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

field() { grep -oE "\"$1\": ?[^,}]*" "$2" | head -1 | sed -E 's/.*: ?//'; }

measure() {  # SCENE INTEGRATOR TARGET [OPTION...]
  local scene=$1 integrator=$2 target=$3
  shift 3
  local name="$scene $*"
  local common=("$root/scenes/$scene/$scene.xml" --size 48x32 --integrator "$integrator" --max-depth 12 -q "$@")
  [[ -e $work/$name.exr ]] || "$ajar" render "${common[@]}" -o "$work/$name.exr" --spp "$long" --seed 4711
  for ((seed = 1; seed <= seeds; seed++)); do
    "$ajar" render "${common[@]}" -o "$work/image.exr" --noise "$target" --seed $seed
    "$ajar" compare "$work/image.exr" "$work/$name.exr" >"$work/figures"
    echo "$(field spp <(sed '/"options"/,/}/d' "$work/image.json")) $(field relmse "$work/figures")"
  done | sort -n | awk -v what="$name $integrator to $target:" -v target="$target" '
    { spp[NR] = $1; e = $2 / target; sum += e; if (NR == 1 || e < low) low = e; if (e > high) high = e }
    END { printf "%-34s %g to %g spp, true error %.2f of the target (%.2f to %.2f)\n", what, spp[1], spp[NR], sum / NR, low, high }'
}

for target in 0.01 0.002; do
  measure box path $target
  measure box bdpt $target
  measure sunrise path $target
done
measure ajar bdpt 0.2 -D door=40
