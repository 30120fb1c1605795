"""Writes N small lights for scenes/lights. Usage: python3 lights.py N SEED [FILE]

Without FILE: scenes/lights/lights-N.xml. Spheres, disks, rectangles, points and spots at random places of the hall;
powers differ by a factor of about 1000.
The total power does not depend on N (it is scaled to 350 W), so pictures with different N are comparable.
"""
import math
import os
import random
import sys

TOTAL = 350.0  # watts per colour channel, on average


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    count, seed = int(sys.argv[1]), int(sys.argv[2])
    here = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'lights')
    path = sys.argv[3] if len(sys.argv) > 3 else os.path.join(here, f'lights-{count}.xml')
    rng = random.Random(seed)
    drawn = [10 ** rng.uniform(0, 3) for _ in range(count)]
    scale = TOTAL / sum(drawn)
    out = [f'<!-- {count} lights, seed {seed}; made by scenes/make/lights.py -->', '<scene version="3.0.0">']
    for watts in drawn:
        watts *= scale
        hue = rng.random()
        colour = [0.55 + 0.45 * math.cos(2 * math.pi * (hue - k / 3)) for k in range(3)]
        mean = sum(colour) / 3
        colour = [c / mean for c in colour]
        while True:  # outside the pillars
            x, y, z = rng.uniform(-3.7, 3.7), rng.uniform(0.15, 3.8), rng.uniform(-9.5, 5.5)
            if min(math.hypot(x - px, z - pz) for px in (-2.2, 2.2) for pz in (-7.5, -5, -2.5, 0, 2.5, 5)) > 0.6:
                break
        kind = rng.choice(('sphere', 'sphere', 'disk', 'rectangle', 'point', 'spot'))
        size = rng.uniform(0.02, 0.06)
        turn = f'<rotate x="1" angle="{rng.uniform(0, 180):.0f}"/><rotate y="1" angle="{rng.uniform(0, 360):.0f}"/>'
        move = f'<translate x="{x:.3f}" y="{y:.3f}" z="{z:.3f}"/>'

        def rgb(name, k): return f'<rgb name="{name}" value="{", ".join(f"{c * k:.4g}" for c in colour)}"/>'
        def point(name): return f'<point name="{name}" x="{x:.3f}" y="{y:.3f}" z="{z:.3f}"/>'
        def frame(steps): return f'<transform name="to_world">{steps}{move}</transform>'

        if kind == 'point':
            intensity = rgb('intensity', watts / (4 * math.pi))
            out.append(f'\t<emitter type="point">{point("position")}{intensity}</emitter>')
            continue
        if kind == 'spot':  # a cone of 35 degrees has 2 pi (1 - cos 35) = 1.136 sr; the soft edge takes about a third
            out.append(f'\t<emitter type="spot">{frame(turn)}{rgb("intensity", watts / 0.75)}'
                       '<float name="cutoff_angle" value="35"/></emitter>')
            continue
        if kind == 'sphere':
            area = 4 * math.pi * size * size
            place = f'{point("center")}<float name="radius" value="{size:.4f}"/>'
        else:
            area = math.pi * size * size if kind == 'disk' else 4 * size * size
            place = frame(f'<scale value="{size:.4f}"/>{turn}')
        radiance = rgb('radiance', watts / (math.pi * area))
        out.append(f'\t<shape type="{kind}">{place}<ref id="black"/><emitter type="area">{radiance}</emitter></shape>')
    out.append('</scene>')
    with open(path, 'w', encoding='ascii') as file:
        file.write('\n'.join(out) + '\n')


if __name__ == '__main__':
    main()
