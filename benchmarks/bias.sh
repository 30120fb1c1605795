#!/usr/bin/env bash
# Bias of merging by region: the light of rectangles of our door scene by an integrator over that by guided-bdpt, which has
# none; the mean of many seeds with its standard error, which their spread gives.
# usage: benchmarks/bias.sh AJAR OUT SEEDS DOOR RADIANCE [SECONDS[:OPTIONS] ...]
#   e.g. benchmarks/bias.sh build/release/ajar out/bias 8 40 60000 15 60 "60:--merge-radius 10"
# Each SECONDS is a run of guided-vcm; guided-bdpt takes 60. Images that are there already are not rendered again.
set -euo pipefail
root=$(dirname "$0")/..
usage="usage: bias.sh AJAR OUT SEEDS DOOR RADIANCE [SECONDS[:OPTIONS] ...]"
ajar=${1?$usage} out=${2?$usage} seeds=${3?$usage} door=${4?$usage} radiance=${5?$usage}
shift 5
mkdir -p "$out"

regions=("wall 120 20 70 75" "corner 36 20 14 75" "beside-gap 200 15 14 125" "leaf 232 12 52 136" "under-leaf 226 150 64 12"
         "carpet 60 160 90 18" "table 40 112 110 12" "all 0 0 320 180")

images() {  # NAME SECONDS INTEGRATOR FIRST_SEED [OPTION ...]
  local name=$1 seconds=$2 integrator=$3 first=$4
  shift 4
  for ((k = 0; k < seeds; k++)); do
    local image=$out/$name.$k.exr
    [[ -e $image ]] || "$ajar" render "$root/scenes/ajar/ajar.xml" -D door="$door" -D radiance="$radiance" --size 320x180 --max-depth 10 \
      --integrator "$integrator" --seed $((first + k)) --cpu-time "${seconds}s" --threads 1 -q "$@" -o "$image"
  done
}

light() {  # NAME X Y WIDTH HEIGHT: mean value there, one line a seed
  local name=$1
  shift
  for ((k = 0; k < seeds; k++)); do
    "$ajar" compare "$out/$name.$k.exr" "$out/$name.$k.exr" --crop "$@" | sed -E 's/.*"mean":([^,]*).*/\1/'
  done
}

report() {  # NAME
  echo "door $door, $1 over guided-bdpt, $seeds seeds each"
  for region in "${regions[@]}"; do
    read -r what box <<<"$region"
    # shellcheck disable=SC2086
    paste <(light unbiased $box) <(light "$1" $box) | awk -v what="$what" '
      { n++; a += $1; aa += $1 * $1; b += $2; bb += $2 * $2 }
      END {
        a /= n; b /= n; va = (aa / n - a * a) / (n - 1); vb = (bb / n - b * b) / (n - 1)
        printf "  %-11s %+6.2f %% +- %.2f   (guided-bdpt alone +- %.2f)\n", what, 100 * (b / a - 1), 100 * b / a * sqrt(va / (a * a) + vb / (b * b)), 100 * sqrt(va) / a
      }'
  done
}

images unbiased 60 guided-bdpt 1000
for run in "$@"; do
  seconds=${run%%:*} options=()
  [[ $run == *:* ]] && read -ra options <<<"${run#*:}"
  name="merged-$(tr -c 'a-z0-9\n' '-' <<<"$run")"
  images "$name" "$seconds" guided-vcm 2000 "${options[@]}"
  report "$name"
done
