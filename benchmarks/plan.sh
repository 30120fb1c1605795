#!/bin/sh
# The plan against every integrator by hand: time to equal error, with the pilot and with its choices of several seeds.
# ajar bench renders every scene with every integrator (benchmarks/plan.json; finished runs and references are kept), and
# ajar plan chooses for the same image and budget. A choice costs what the chosen integrator's error at the end of the
# budget, grown by the share that the pilot took, is over the best one's: the render itself would be the same again.
# Errors are relMSE without the worst 0.1 % of pixels, less the reference's own, geometric means over seeds; in the last
# column the square of the mean absolute error instead, which does not hang on how many fireflies are cut.
# Usage: plan.sh AJAR FOLDER [SEEDS [SECONDS]]    SECONDS: another budget to plan for; THREADS: of ajar, all if empty
set -e
ajar=$1 folder=$2 seeds=${3:-3} seconds=$4
root=$(dirname "$0")/..
shared=${AJAR_SHARED_SCENES:-$root/../shared/scenes}
threads=${THREADS:+--threads $THREADS}
mkdir -p "$folder"
"$ajar" bench "$root/benchmarks/plan.json" -o "$folder/bench" --references "$folder/references" $threads > "$folder/bench.txt"
# Name, file, size, depth, budget, of the scenes that were rendered.
python3 - "$folder" "$root/benchmarks" "$shared" "$seconds" > "$folder/scenes.txt" <<'LIST'
import json, os, sys
folder, suite, shared, seconds = sys.argv[1:]
results = json.load(open(folder + '/bench/results.json'))
for s in results['scenes']:
    if s['skipped'] or not s['methods']: continue
    near = os.path.join(suite, s['file'])
    print(s['name'], near if os.path.exists(near) else os.path.join(shared, s['file']), f"{s['width']}x{s['height']}",
          s['max_depth'], seconds or results['budget']['cpu_seconds'])
LIST
while read -r name file size depth budget; do
  seed=1
  while [ $seed -le "$seeds" ]; do
    "$ajar" plan "$file" --size "$size" --max-depth "$depth" --cpu-time "${budget}s" --seed $seed $threads --json > "$folder/$name-$seed.json"
    seed=$((seed + 1))
  done
done < "$folder/scenes.txt"
python3 - "$folder" "$seeds" <<'TABLE'
import json, math, sys
folder, seeds = sys.argv[1], range(1, int(sys.argv[2]) + 1)
budgets = {line.split()[0]: float(line.split()[4]) for line in open(folder + '/scenes.txt')}
ways = ('path', 'bdpt', 'guided-path', 'guided-bdpt')
mean = lambda x: math.exp(sum(map(math.log, x)) / len(x))
print('| scene | path | bdpt | guided-path | guided-bdpt | planned | pilot | plan / best | all / plan | plan / best, absolute |\n|---|---:|---:|---:|---:|---|---:|---:|---:|---:|')
ratios, gains, absolutes = [], [], []
for scene in json.load(open(folder + '/bench/results.json'))['scenes']:
    if scene['name'] not in budgets or not all(m['runs'] for m in scene['methods']): continue
    own = scene['reference']['relmse'] or 0
    # relMSE of a reference counts all pixels: no more than half of what is measured is taken off.
    error = {m['name']: mean([max(r['samples'][-1]['relmse_trimmed'] - own, r['samples'][-1]['relmse_trimmed'] / 2) for r in m['runs']])
             for m in scene['methods']}
    plans = [json.load(open(f"{folder}/{scene['name']}-{s}.json")) for s in seeds]
    pilot = sum(p['cpu_seconds'] for p in plans) / len(plans) / budgets[scene['name']]
    best = min(error.values())
    grown = [1 / (1 - min(p['cpu_seconds'] / budgets[scene['name']], 0.5)) for p in plans]
    costs = [error[p['integrator']] * g for p, g in zip(plans, grown)]
    ratios.append(mean(costs) / best), gains.append(error['guided-bdpt'] / mean(costs))
    absolute = {m['name']: mean([r['samples'][-1]['mape'] ** 2 for r in m['runs']]) for m in scene['methods']}
    absolutes.append(mean([absolute[p['integrator']] * g for p, g in zip(plans, grown)]) / min(absolute.values()))
    chosen = [p['integrator'] for p in plans]
    planned = ', '.join(f"{c} {chosen.count(c)}" for c in dict.fromkeys(chosen))
    print(f"| {scene['name']} | " + ' | '.join(f'{error[w]:.2g}' for w in ways) + f' | {planned} | {100 * pilot:.0f} % | {ratios[-1]:.2f} | {gains[-1]:.2f} | {absolutes[-1]:.2f} |')
print(f'| mean | | | | | | | {mean(ratios):.2f} | {mean(gains):.2f} | {mean(absolutes):.2f} |')
TABLE
