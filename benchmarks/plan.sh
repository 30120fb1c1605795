#!/bin/sh
# The plan against every integrator by hand, after equal time: ajar bench renders the scenes of benchmarks/plan.json
# (finished runs and references are kept). There is time to learn in all of them, so the plan is guided-bdpt, which path
# tracing takes over from or not; the fourth column is guided-bdpt that goes on guiding.
# Errors are relMSE without the worst 0.1 % of pixels, less the reference's own, geometric means over seeds; in the last
# column the square of the mean absolute error instead, which does not hang on how many fireflies are cut.
# Usage: plan.sh AJAR FOLDER    THREADS: of ajar, all if empty
set -e
ajar=${1?usage: plan.sh AJAR FOLDER} folder=${2?FOLDER}
threads=${THREADS:+--threads $THREADS}
mkdir -p "$folder"
rm -f "$folder/bench/results.json"
status=0
"$ajar" bench "$(dirname "$0")/plan.json" -o "$folder/bench" --references "$folder/references" $threads > "$folder/bench.txt" || status=$?  # a reference may be refused
[ -e "$folder/bench/results.json" ] || exit $status
python3 - "$folder" <<'TABLE'
import json, math, sys
ways = ('path', 'bdpt', 'guided-path', 'guided-bdpt')
mean = lambda x: math.exp(sum(map(math.log, x)) / len(x))
print('| scene | path | bdpt | guided-path | guided-bdpt | planned | planned / best | guided-bdpt / planned | planned / best, absolute |\n|---|---:|---:|---:|---:|---:|---:|---:|---:|')
rows = []
for scene in json.load(open(sys.argv[1] + '/bench/results.json'))['scenes']:
    if scene['skipped'] or not all(m['runs'] for m in scene['methods']): continue
    own = scene['reference']['relmse'] or 0
    last = lambda run: run['samples'][-1]
    # relMSE of a reference counts all pixels: no more than half of what is measured is taken off.
    error = {m['name']: mean([max(last(r)['relmse_trimmed'] - own, last(r)['relmse_trimmed'] / 2) for r in m['runs']])
             for m in scene['methods']}
    absolute = {m['name']: mean([last(r)['mape'] ** 2 for r in m['runs']]) for m in scene['methods']}
    over = lambda e: e['planned'] / min(e[w] for w in ways)
    rows.append((over(error), error['guided-bdpt'] / error['planned'], over(absolute)))
    print(f"| {scene['name']} | " + ' | '.join(f'{error[w]:.2g}' for w in ways) + f" | {error['planned']:.2g} | " +
          ' | '.join(f'{x:.2f}' for x in rows[-1]) + ' |')
print('| mean | | | | | | ' + ' | '.join(f'{mean(x):.2f}' for x in zip(*rows)) + ' |')
TABLE
exit $status
