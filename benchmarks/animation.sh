#!/bin/sh
# Error and flicker of an opening door, by integrator and by what frames have in common, at equal CPU time per frame.
# usage: animation.sh AJAR OUT [FRAMES [SECONDS [REFERENCE_SECONDS [SIZE]]]]      e.g. animation.sh build/release/ajar out/anim 0-7/24 3s 20s 96x54
# MOTION: what moves in place of the door (door=2..60); e.g. MOTION='eye=3.36 1.34 4..2.2 1.34 3.2', a camera that goes in.
set -e
usage='usage: animation.sh AJAR OUT [FRAMES [SECONDS [REFERENCE_SECONDS [SIZE]]]]'
ajar=${1?$usage} out=${2?$usage} frames=${3:-48} seconds=${4:-5s} reference=${5:-60s} size=${6:-160x90}
scene=$(dirname "$0")/../scenes/ajar/ajar.xml
animate() { "$ajar" animate "$scene" --frames "$frames" -D "${MOTION:-door=2..60}" --size "$size" -q "$@"; }

animate --integrator guided-bdpt --coherent fields --seed 99 --cpu-time "$reference" -o "$out/reference/r_%04d.exr"
measure() {
  name=$1
  shift
  animate --cpu-time "$seconds" --reference "$out/reference/r_%04d.exr" -o "$out/$name/f_%04d.exr" "$@"
  # The first figures of the record are the means.
  figure() { sed -n "/\"$1\"/{s/.*: *//;s/,\$//;p;q}" "$out/$name/animation.json"; }
  printf '%-14s %8.1f spp  relMSE %8.4f  trimmed %8.4f  flicker %8.4f\n' "$name" "$(figure spp)" "$(figure relmse)" \
    "$(figure relmse_trimmed)" "$(figure flicker)"
}
measure vpl --integrator vpl
measure vpl_fresh --integrator vpl --coherent off
measure plain --integrator plain-vpl --coherent off
measure plain_same --integrator plain-vpl
measure bdpt --integrator guided-bdpt
measure bdpt_fields --integrator guided-bdpt --coherent fields
measure bdpt_cold --integrator guided-bdpt --coherent off
