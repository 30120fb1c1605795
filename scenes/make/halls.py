"""Halls lit by lamps of several kinds, most of which a place cannot see by: what the choice among them is measured on
(docs/results/lights.md, "Promises by what a lamp sends to the steradian").

Usage: python3 halls.py FOLDER     spots.xml, mixed.xml and few.xml
"""
import os
import random
import sys

# Numbers of spots, points, small lamps and small balls; degrees of a spot's cutoff, times 0.7 to 1.4.
HALLS = {'spots': (200, 20, 20, 0, 14), 'mixed': (30, 30, 30, 30, 25), 'few': (8, 1, 2, 0, 14)}

HEAD = '''<scene version="3.0.0"><integrator type="path"><integer name="max_depth" value="10"/></integrator>
<sensor type="perspective"><float name="fov" value="60"/><transform name="to_world"><lookat origin="-9,4,9" target="1,1.2,-1" up="0,1,0"/></transform><film type="hdrfilm"><integer name="width" value="320"/><integer name="height" value="180"/></film></sensor>
<bsdf type="diffuse" id="w"><rgb name="reflectance" value="0.6"/></bsdf>'''

# Place, rotation and half extents of floor, ceiling and walls.
WALLS = [((0, 0, 0), '<rotate x="1" angle="-90"/>', 10, 10), ((0, 6, 0), '<rotate x="1" angle="90"/>', 10, 10),
         ((0, 3, -10), '', 10, 3), ((0, 3, 10), '<rotate y="1" angle="180"/>', 10, 3),
         ((-10, 3, 0), '<rotate y="1" angle="90"/>', 10, 3), ((10, 3, 0), '<rotate y="1" angle="-90"/>', 10, 3)]


def shape(kind, steps, inside='<ref id="w"/>'):
    return f'<shape type="{kind}"><transform name="to_world">{steps}</transform>{inside}</shape>'


def rectangle(place, rotate, x, y, inside='<ref id="w"/>'):
    move = '<translate x="{}" y="{}" z="{}"/>'.format(*place)
    return shape('rectangle', f'<scale x="{x}" y="{y}" z="1"/>{rotate}{move}', inside)


def area(radiance):
    return f'<ref id="w"/><emitter type="area"><rgb name="radiance" value="{radiance}"/></emitter>'


def box(r):
    x, z, h = r.uniform(-8, 8), r.uniform(-8, 6), r.uniform(.3, 1.6)
    return shape('cube', f'<scale x="{r.uniform(.2, .7)}" y="{h}" z="{r.uniform(.2, .7)}"/>'
                         f'<rotate y="1" angle="{r.uniform(0, 90)}"/><translate x="{x}" y="{h}" z="{z}"/>')


def spot(r, many, degrees):
    x, z = r.uniform(-9, 9), r.uniform(-9, 9)
    to_x, to_z = x + r.uniform(-2, 2), z + r.uniform(-2, 2)
    cutoff = degrees * r.uniform(.7, 1.4)
    return (f'<emitter type="spot"><rgb name="intensity" value="{r.uniform(4, 12) * 200 / many / 5}"/>'
            f'<float name="cutoff_angle" value="{cutoff}"/><float name="beam_width" value="{cutoff * .75}"/>'
            f'<transform name="to_world"><lookat origin="{x},5.8,{z}" target="{to_x},0,{to_z}" up="0.1,0,1"/></transform></emitter>')


def point(r, many):
    return (f'<emitter type="point"><rgb name="intensity" value="{r.uniform(.5, 3) * 30 / many}"/>'
            f'<point name="position" x="{r.uniform(-9, 9)}" y="{r.uniform(2, 5.5)}" z="{r.uniform(-9, 9)}"/></emitter>')


def lamp(r, many):
    place = r.uniform(-9, 9), 5.7, r.uniform(-9, 9)
    return rectangle(place, '<rotate x="1" angle="90"/>', .1, .1, area(r.uniform(20, 200) * 30 / many))


def ball(r, many):
    return (f'<shape type="sphere"><point name="center" x="{r.uniform(-9, 9)}" y="{r.uniform(2, 5.5)}" z="{r.uniform(-9, 9)}"/>'
            f'<float name="radius" value="0.08"/>{area(r.uniform(20, 100) * 30 / many)}</shape>')


def hall(spots, points, lamps, balls, degrees):
    r = random.Random(1)
    out = [HEAD] + [rectangle(*wall) for wall in WALLS] + [box(r) for _ in range(25)]
    out += [spot(r, spots, degrees) for _ in range(spots)] + [point(r, points) for _ in range(points)]
    out += [lamp(r, lamps) for _ in range(lamps)] + [ball(r, balls) for _ in range(balls)]
    return '\n'.join(out + ['</scene>'])


if len(sys.argv) != 2:
    sys.exit(__doc__)
os.makedirs(sys.argv[1], exist_ok=True)
for name, what in HALLS.items():
    with open(f'{sys.argv[1]}/{name}.xml', 'w', encoding='utf-8') as file:
        file.write(hall(*what))
