#!/bin/sh
# What a ray costs with all that hangs on it, by scene and integrator, in CPU ns: what guided renders reckon with (plain.cpp);
# over what it costs path; and CPU microseconds a sample.
# Usage: ray_cost.sh AJAR [SECONDS [SCENE.xml ...]]    one thread; 8 s each; all scenes that are there
set -e
ajar=${1?usage: ray_cost.sh AJAR [SECONDS [SCENE.xml ...]]} seconds=${2:-8}
root=$(dirname "$0")/..
if [ $# -gt 2 ]; then shift 2; else . "$root/benchmarks/scenes.sh"; fi
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
echo '| scene | path | guided-path | bdpt | guided-bdpt | guided-vcm |
|---|---|---|---|---|---|'
for file in "$@"; do
  for integrator in path guided-path bdpt guided-bdpt guided-vcm; do
    case $integrator in guided*) all="--plan all" ;; *) all= ;; esac
    "$ajar" render "$file" --integrator $integrator $all --size 80x60 --cpu-time "${seconds}s" --threads 1 -q -o "$folder/$integrator.exr" || continue 2
  done
  python3 - "$file" "$folder" <<'TABLE'
import json, os, sys
file, folder = sys.argv[1:]
row = []
for way in ('path', 'guided-path', 'bdpt', 'guided-bdpt', 'guided-vcm'):
    out = json.load(open(f'{folder}/{way}.json'))
    cpu = sum(out['cpu_seconds'][k] for k in ('trace', 'learn', 'rebuild'))
    row.append((1e9 * cpu / sum(out['rays'].values()), 1e6 / out['samples_per_cpu_second']))
name = os.path.basename(os.path.dirname(file))
print(f'| {name} | ' + ' | '.join(f'{ray:.0f} ns, {ray / row[0][0]:.2f}, {sample:.2f} us a sample' for ray, sample in row) + ' |', flush=True)
TABLE
done
