#!/bin/sh
# The plan against every integrator by hand, at equal CPU time with the pilot counted: relMSE without the worst 0.1 %
# of pixels, mean over seeds, and the plan's over the best one's. References of our own scenes are made once, by bdpt.
# Usage: plan.sh AJAR FOLDER [SECONDS] [SEEDS]     scenes: $SCENES, else all of them
set -e
ajar=$1 folder=$2 seconds=${3:-20} seeds=${4:-2}
root=$(dirname "$0")/..
shared=${AJAR_SHARED_SCENES:-$root/../shared/scenes}
mkdir -p "$folder"
# name, file, size, depth, reference ('-': made here), parameters
table="cornell-box $shared/cornell-box/scene.xml 256x256 10 $shared/../references/cornell-box-256x256-depth10.exr
veach-mis $shared/veach-mis/scene.xml 384x216 5 $shared/../references/veach-mis-384x216-depth5.exr
veach-ajar $shared/veach-ajar/scene.xml 320x180 10 $shared/../references/veach-ajar-320x180-depth10.exr
box $root/scenes/box/box.xml 128x128 10 -
sunrise $root/scenes/sunrise/sunrise.xml 128x128 10 -
door $root/scenes/door/door.xml 128x128 10 -
glass $root/scenes/glass/glass.xml 128x128 10 -
materials $root/scenes/materials/materials.xml 128x128 10 -
wall $root/scenes/wall/wall.xml 128x128 10 -"
echo "$table" | while read -r name file size depth reference parameters; do
  case " ${SCENES:-$name} " in *" $name "*) ;; *) continue ;; esac
  if [ ! -f "$file" ]; then
    echo "$name: left out, there is no $file" >&2
    continue
  fi
  common="-q --threads 1 --size $size --max-depth $depth $parameters"
  if [ "$reference" = - ]; then
    reference=$folder/$name-reference.exr
    [ -f "$reference" ] || "$ajar" render "$file" $common --integrator bdpt --cpu-time $((seconds * 10))s --seed 999 -o "$reference"
  fi
  seed=1
  while [ $seed -le "$seeds" ]; do
    for how in path bdpt guided-path guided-bdpt auto; do
      image=$folder/$name-$how-$seed
      if [ $how = auto ]; then option="--plan auto"; else option="--integrator $how"; fi
      "$ajar" render "$file" $common $option --cpu-time "${seconds}s" --seed $seed -o "$image.exr" 2> /dev/null
      "$ajar" compare "$image.exr" "$reference" > "$image.error.json"
    done
    seed=$((seed + 1))
  done
  echo "$name" >> "$folder/done"
done
python3 - "$folder" "$seeds" <<'TABLE'
import json, sys
folder, seeds = sys.argv[1], range(1, int(sys.argv[2]) + 1)
ways = ('path', 'bdpt', 'guided-path', 'guided-bdpt', 'auto')
print('| scene | path | bdpt | guided-path | guided-bdpt | plan | planned | over the best |')
print('|---|---:|---:|---:|---:|---:|---|---:|')
for name in dict.fromkeys(open(folder + '/done').read().split()):
    error = {w: sum(json.load(open(f'{folder}/{name}-{w}-{s}.error.json'))['relmse_trimmed'] for s in seeds) / len(seeds) for w in ways}
    chosen = {json.load(open(f'{folder}/{name}-auto-{s}.json'))['options']['integrator'] for s in seeds}
    best = min(error[w] for w in ways[:-1])
    print(f'| {name} | ' + ' | '.join(f'{error[w]:.2g}' for w in ways) + f' | {", ".join(sorted(chosen))} | {error["auto"] / best:.2f} |')
TABLE
