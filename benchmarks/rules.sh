#!/usr/bin/env bash
# Dahm and Keller 2017, figures 7 and 8, on scenes/ajar: path length, share of paths that bring something, and error of
# path tracing without learning and guided by fields of each structure and rule, learned in 32 passes and then frozen.
# Usage: rules.sh AJAR FOLDER [SEEDS]
set -euo pipefail
ajar=${1?usage: rules.sh AJAR FOLDER [SEEDS]} folder=${2?FOLDER} seeds=${3:-3}
root=$(dirname "$0")/..
common=("$root/scenes/ajar/ajar.xml" -q -D door=40 --size 320x180 --max-depth 10)
mkdir -p "$folder"
for method in path adaptive-expected adaptive-max adaptive-return grid-expected grid-max probes-expected probes-max; do
  structure=${method%-*} rule=${method#*-} how=(--integrator path)
  if [[ $method != path ]]; then
    how=(--integrator guided-path --train 32 --field-rule "$rule")
    "$ajar" render "${common[@]}" "${how[@]}" --field-structure "$structure" --spp 1 --seed 99 \
      --save-fields "$folder/$method.fields" -o "$folder/trained.exr"
    how+=(--load-fields "$folder/$method.fields")
  fi
  for ((seed = 1; seed <= seeds; seed++)); do
    "$ajar" render "${common[@]}" "${how[@]}" --spp 32 --seed $seed -o "$folder/$method-$seed.exr"
    "$ajar" compare "$folder/$method-$seed.exr" "$root/benchmarks/references/ajar-40-320x180-depth10.exr" \
      > "$folder/$method-$seed.error.json"
  done
done
python3 - "$folder" "$seeds" <<'TABLE'
import json, statistics, sys
folder, seeds = sys.argv[1], range(1, int(sys.argv[2]) + 1)
print('| fields | edges of a path | paths that bring something | relMSE | worst 0.1 % left out | us CPU a sample |\n|---|---:|---:|---:|---:|---:|')
for method in ('path', 'adaptive-expected', 'adaptive-max', 'adaptive-return', 'grid-expected', 'grid-max', 'probes-expected',
               'probes-max'):
    runs = [(json.load(open(f'{folder}/{method}-{s}.error.json')), json.load(open(f'{folder}/{method}-{s}.json'))) for s in seeds]
    def mean(get): return statistics.mean(get(e, r) for e, r in runs)
    print('|', method, '|', f"{mean(lambda e, r: r['mean_path_edges']['camera']):.2f} |",
          f"{100 * (1 - mean(lambda e, r: r['zero_contribution_paths'])):.2f} % |", f"{mean(lambda e, r: e['relmse']):.3g} |",
          f"{mean(lambda e, r: e['relmse_trimmed']):.3g} |", f"{1e6 / mean(lambda e, r: r['samples_per_cpu_second']):.1f} |")
TABLE
