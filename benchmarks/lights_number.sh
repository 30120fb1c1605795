#!/usr/bin/env bash
# Many lights: time to load (reading the file and the tree), time of a sample and memory as their number grows, by power and by
# the tree; a table on the output and, where a file is named, a plot of it (both axes logarithmic).
# usage: benchmarks/lights_number.sh [AJAR [PLOT.svg [NUMBERS]]]
set -euo pipefail
here=$(cd "$(dirname "$0")/.." && pwd)
ajar=${1:-"$here/build/release/ajar"}
plot=${2:-}
numbers=${3:-10 100 1000 10000 100000}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

field() { python3 -c "import json, sys; j = json.load(open('$work/image.json')); print($1)"; }

echo "lights choice load_s us_per_sample peak_MB" | tee "$work/table"
for n in $numbers; do
  python3 "$here/scenes/make/lights.py" "$n" 7 "$work/lights-$n.xml"
  for choice in power tree; do
    "$ajar" render "$here/scenes/lights/lights.xml" -D lights="$work/lights-$n.xml" -o "$work/image.exr" --integrator path \
      --light-choice $choice --max-depth 3 --spp 8 --size 160x90 --threads 1 -q
    echo "$n $choice $(field 'j["cpu_seconds"]["load"]') $(field 'j["cpu_seconds"]["trace"] / (8 * 160 * 90) * 1e6') $(field 'j["memory_peak_bytes"] / 1e6')"
  done
done | tee -a "$work/table"

[[ -z $plot ]] || python3 - "$work/table" "$plot" <<'PLOT'
import math, sys
rows = [line.split() for line in open(sys.argv[1])][1:]
series = [("load, s", 2, "tree", "#c0392b"), ("sample by the tree, µs", 3, "tree", "#2471a3"),
          ("sample by power, µs", 3, "power", "#7fb3d5"), ("peak of memory, GB", 4, "tree", "#1e8449")]
x = lambda n: 60 + 100 * math.log10(n / 10)
y = lambda v: 340 - 60 * (math.log10(v) + 3)
out = ['<svg xmlns="http://www.w3.org/2000/svg" width="700" height="400" font-family="sans-serif" font-size="12">',
       '<rect width="700" height="400" fill="white"/>']
for e in range(1, 6):
    out.append(f'<path d="M{x(10**e)} 40V340" stroke="#ddd"/><text x="{x(10**e)}" y="358" text-anchor="middle">{10**e}</text>')
for e in range(-3, 3):
    out.append(f'<path d="M60 {y(10**e)}H460" stroke="#ddd"/><text x="54" y="{y(10**e) + 4}" text-anchor="end">{10.0**e:g}</text>')
out.append('<text x="260" y="380" text-anchor="middle">lights</text>')
for k, (name, column, choice, colour) in enumerate(series):
    points = [(int(r[0]), float(r[column]) / (1000 if column == 4 else 1)) for r in rows if r[1] == choice]
    path = " ".join(f"{x(n):.1f},{y(max(v, 1e-3)):.1f}" for n, v in points)
    out.append(f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="2"/>')
    out.append(f'<path d="M480 {60 + 22 * k}h20" stroke="{colour}" stroke-width="2"/><text x="506" y="{64 + 22 * k}">{name}</text>')
open(sys.argv[2], "w").write("\n".join(out) + "\n</svg>\n")
PLOT
