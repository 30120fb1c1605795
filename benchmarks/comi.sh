#!/usr/bin/env bash
# The tables of Comi 2019 (4.2 and 4.3) on our scenes: 32 spp, 256x256, no next-event estimation; cosine sampling
# against fields learned in a separate pass and then frozen. Usage: comi.sh AJAR FOLDER [SEEDS]
set -euo pipefail
ajar=${1?usage: comi.sh AJAR FOLDER [SEEDS]} folder=${2?FOLDER} seeds=${3:-5}
root=$(dirname "$0")/..
mkdir -p "$folder"
for scene in box sunrise door; do
  file=$root/scenes/$scene/$scene.xml
  reference=$folder/$scene-reference.exr
  [[ -f $reference ]] || "$ajar" render "$file" -q --size 256x256 --max-depth 20 --integrator bdpt --spp 128 --seed 999 -o "$reference"
  for method in cosine grid probes adaptive; do
    fields=$folder/$scene-$method.fields
    how=(--integrator path --no-next-event)
    if [[ $method != cosine ]]; then
      how=(--integrator guided-path --no-next-event --train 64 --field-rate visits)
      "$ajar" render "$file" -q --size 128x128 --max-depth 20 "${how[@]}" --field-structure "$method" --spp 1 --seed 99 \
        --save-fields "$fields" -o "$folder/trained.exr"
      how+=(--load-fields "$fields")
    fi
    for ((seed = 1; seed <= seeds; seed++)); do
      image=$folder/$scene-$method-$seed
      "$ajar" render "$file" -q --size 256x256 --max-depth 20 --roulette-depth 6 "${how[@]}" --spp 32 --seed $seed -o "$image.exr"
      "$ajar" compare "$image.exr" "$reference" > "$image.error.json"
    done
  done
done
python3 - "$folder" "$seeds" <<'TABLE'
import json, statistics, sys
folder, seeds = sys.argv[1], range(1, int(sys.argv[2]) + 1)
print('| scene | sampling | MSE | SSIM | bounces | paths of no contribution |\n|---|---|---:|---:|---:|---:|')
for scene in ('box', 'sunrise', 'door'):
    for method in ('cosine', 'grid', 'probes', 'adaptive'):
        runs = [(json.load(open(f'{folder}/{scene}-{method}-{s}.error.json')),
                 json.load(open(f'{folder}/{scene}-{method}-{s}.json'))) for s in seeds]
        def cell(get, form):
            x = [get(e, r) for e, r in runs]
            return f'{statistics.mean(x):{form}} ± {statistics.stdev(x) if len(x) > 1 else 0:.1g}'
        print('|', scene, '|', method, '|', cell(lambda e, r: e['mse'], '.3g'), '|', cell(lambda e, r: e['ssim'], '.3f'), '|',
              cell(lambda e, r: r['mean_path_edges']['camera'] - 1, '.3f'), '|',
              cell(lambda e, r: r['zero_contribution_paths'], '.4f'), '|')
TABLE
