#!/bin/sh
# Error and flicker of guided lights over a film, against unguided virtual point lights with fresh numbers, at equal CPU
# time a frame; two seeds beside each other, a thread each. References are the means of two sequences of other seeds.
# usage: film.sh AJAR OUT [FRAMES [SECONDS [REFERENCE_SECONDS [SIZE]]]]      e.g. film.sh build/release/ajar out/film 48 8s 20s 192x108
# MOTION: what moves in place of the door (door=2..60); e.g. MOTION='eye=3.36 1.34 4..2.2 1.34 3.2', a camera that goes in.
# Needs python3 with numpy and OpenImageIO. What is there already is not rendered again.
set -e
usage='usage: film.sh AJAR OUT [FRAMES [SECONDS [REFERENCE_SECONDS [SIZE]]]]'
ajar=${1?$usage} out=${2?$usage} frames=${3:-48} seconds=${4:-2s} reference=${5:-10s} size=${6:-96x54}
scene=$(dirname "$0")/../scenes/ajar/ajar.xml

sequence() {
  name=$1
  shift
  "$ajar" animate "$scene" --frames "$frames" -D "${MOTION:-door=2..60}" --size "$size" -q --threads 1 "$@" \
    -o "$out/$name/frame_%04d.exr" >/dev/null
}
both() {
  name=$1
  shift
  sequence "$name/1" --seed 1 --cpu-time "$seconds" "$@" &
  sequence "$name/2" --seed 2 --cpu-time "$seconds" "$@"
  wait $!
}

sequence reference/1 --seed 191 --cpu-time "$reference" --integrator guided-bdpt --coherent fields &
sequence reference/2 --seed 192 --cpu-time "$reference" --integrator guided-bdpt --coherent fields
wait $!
both plain --integrator plain-vpl --coherent off
both plain_limited --integrator plain-vpl --coherent off --limit-fireflies
both vpl_limited --integrator vpl --limit-fireflies
both guided_limited --integrator guided-bdpt --limit-fireflies

python3 - "$out" plain plain_limited vpl_limited guided_limited <<'TABLE'
import glob, json, os, sys
import numpy as np
import OpenImageIO as oiio

def image(path):
    return oiio.ImageBuf(path).get_pixels(oiio.FLOAT)[:, :, :3].astype(np.float64)

def trimmed(error):
    return np.sort(error)[:-max(1, len(error) // 1000)].mean()

def figures(folder):
    """Means over frames of relMSE, of that without the worst 0.1 %, of flicker, and of samples per pixel."""
    rows, flicker, before = [], [], None
    for path in sorted(glob.glob(f"{folder}/frame_*.exr")):
        r = reference[os.path.basename(path)]
        i, scale = image(path), r * r + 0.01
        error = ((i - r) ** 2 / scale).mean(2).ravel()
        rows.append((error.mean(), trimmed(error), json.load(open(path[:-3] + "json"))["spp"]))
        if before:
            flicker.append((((i - before[0]) - (r - before[1])) ** 2 / scale).mean())
        before = i, r
    all_pixels, kept, spp = np.mean(rows, axis=0)
    return all_pixels, kept, np.mean(flicker), spp

out, names = sys.argv[1], sys.argv[2:]
reference, own = {}, []
for path in sorted(glob.glob(f"{out}/reference/1/frame_*.exr")):
    a, b = image(path), image(path.replace("/1/frame", "/2/frame"))
    r = reference[os.path.basename(path)] = (a + b) / 2
    own.append(trimmed(((a - b) ** 2 / 4 / (r * r + 0.01)).mean(2).ravel()))
own = np.mean(own)
print(f"{len(reference)} frames; the references' own error, trimmed: {own:.4f}")
base = None
for name in names:
    seeds = np.array([figures(f"{out}/{name}/{seed}") for seed in (1, 2)])
    base = seeds.mean(0) if base is None else base
    e, t, f, _ = seeds.mean(0)
    each = "  ".join(f"{s[3]:.1f} spp, {s[0]:.4f}, {s[1]:.4f}, {s[2]:.4f}" for s in seeds)
    print(f"{name:15} {each}  over {names[0]}: {e / base[0]:.2f}, {t / base[1]:.2f}"
          f" ({(t - own) / (base[1] - own):.2f} less the references'), 1/{base[2] / f:.1f}")
TABLE
