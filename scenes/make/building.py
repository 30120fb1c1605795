"""Writes the buildings of scenes/lights: storeys of rooms with doorways and furniture, and many small lamps in them.
Usage: python3 building.py

lights-5000: 200 rooms in 2 storeys, 25 ball lamps each, a light of its own each. lights-15000: 300 rooms in 3 storeys, 25
square lamps of two triangles each; lamps of one colour are one mesh, so there are 8 lights of 1875 triangles, more or
less. Powers differ by a factor of 100.
"""
import math
import os
import random

from mesh import Mesh, box

HERE = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'lights')
WIDTH, DEPTH, HEIGHT, WALL = 5.0, 4.0, 3.0, 0.16  # of a room, from wall to wall; storeys are HEIGHT apart
DOOR, LINTEL = 0.95, 2.10

HEAD = '''<!-- {count} lamps in {rooms} rooms, most of them behind walls; made by scenes/make/building.py.
     Tests: the choice of a light where hardly any is seen. -->
<scene version="3.0.0">
	<default name="resx" value="480"/>
	<default name="resy" value="270"/>
	<default name="spp" value="64"/>
	<default name="max_depth" value="5"/>
	<default name="integrator" value="path"/>
	<integrator type="$integrator"><integer name="max_depth" value="$max_depth"/></integrator>
	<sensor type="perspective">
		<float name="fov" value="78"/>
		<transform name="to_world"><lookat origin="{eye}" target="{target}" up="0, 1, 0"/></transform>
		<sampler type="independent"><integer name="sample_count" value="$spp"/></sampler>
		<film type="hdrfilm">
			<integer name="width" value="$resx"/>
			<integer name="height" value="$resy"/>
			<rfilter type="gaussian"/>
		</film>
	</sensor>
	<bsdf type="twosided" id="plaster"><bsdf type="diffuse"><rgb name="reflectance" value="0.68, 0.66, 0.62"/></bsdf></bsdf>
	<bsdf type="twosided" id="floor">
		<bsdf type="roughplastic">
			<rgb name="diffuse_reflectance" value="0.30, 0.21, 0.14"/>
			<string name="distribution" value="ggx"/>
			<float name="alpha" value="0.25"/>
		</bsdf>
	</bsdf>
	<bsdf type="twosided" id="wood"><bsdf type="diffuse"><rgb name="reflectance" value="0.42, 0.28, 0.16"/></bsdf></bsdf>
	<bsdf type="twosided" id="cloth"><bsdf type="diffuse"><rgb name="reflectance" value="0.20, 0.30, 0.42"/></bsdf></bsdf>
	<bsdf type="diffuse" id="black"><rgb name="reflectance" value="0"/></bsdf>
'''


def add_doorway(mesh, low, high, axis, at):
    """A wall along `axis` (0: x, 2: z) with an opening of DOOR x LINTEL that begins at `at`."""
    def part(a0, a1, y0, y1):
        lo, hi = list(low), list(high)
        lo[axis], hi[axis], lo[1], hi[1] = a0, a1, y0, y1
        mesh.join(box(tuple(lo), tuple(hi)))
    part(low[axis], at, low[1], high[1])
    part(at + DOOR, high[axis], low[1], high[1])
    part(at, at + DOOR, low[1] + LINTEL, high[1])


def furnish(rng, x, y, z, wood, cloth):
    """A table, a cupboard, a sofa: boxes along the walls, not in the way of doors."""
    tx, tz = x + rng.uniform(1.6, 2.6), z + rng.uniform(1.3, 2.0)
    wood.join(box((tx, y + 0.72, tz), (tx + 1.3, y + 0.76, tz + 0.75)))
    for dx in (0.05, 1.2):
        for dz in (0.05, 0.65):
            wood.join(box((tx + dx, y, tz + dz), (tx + dx + 0.05, y + 0.72, tz + dz + 0.05)))
    cx = x + rng.uniform(0.3, 1.2)
    wood.join(box((cx, y, z + WALL), (cx + 0.9, y + rng.uniform(1.2, 2.0), z + WALL + 0.4)))
    sx = x + rng.uniform(2.2, 2.8)
    for lo, hi in (((0, 0.12, 0), (1.8, 0.42, 0.8)), ((0, 0.42, 0.62), (1.8, 0.85, 0.8)), ((0, 0.42, 0), (0.15, 0.62, 0.62)),
                   ((1.65, 0.42, 0), (1.8, 0.62, 0.62))):
        z0 = z + DEPTH - WALL - 0.85
        cloth.join(box((sx + lo[0], y + lo[1], z0 + lo[2]), (sx + hi[0], y + hi[1], z0 + hi[2])))
    return tx, tz


def build(nx, nz, storeys, seed):
    """Meshes of walls, floors, wood, cloth, and the rooms' corners with a table each."""
    rng = random.Random(seed)
    walls, floors, wood, cloth, rooms = Mesh(), Mesh(), Mesh(), Mesh(), []
    for k in range(storeys):
        y = k * HEIGHT
        top = y + HEIGHT - 0.2
        floors.join(box((0, y - 0.2, 0), (nx * WIDTH + WALL, y, nz * DEPTH + WALL)))
        for i in range(nx + 1):
            for j in range(nz):
                low, high = (i * WIDTH, y, j * DEPTH), (i * WIDTH + WALL, top, (j + 1) * DEPTH)
                if 0 < i < nx:
                    add_doorway(walls, low, high, 2, j * DEPTH + rng.uniform(0.8, 2.0))
                else:
                    walls.join(box(low, high))
        for j in range(nz + 1):
            for i in range(nx):
                low, high = (i * WIDTH + WALL, y, j * DEPTH), ((i + 1) * WIDTH, top, j * DEPTH + WALL)
                if 0 < j < nz and rng.random() < 0.5:
                    add_doorway(walls, low, high, 0, i * WIDTH + 1.35)
                else:
                    walls.join(box(low, high))
        for i in range(nx):
            for j in range(nz):
                table = furnish(rng, i * WIDTH + WALL, y, j * DEPTH, wood, cloth)
                rooms.append((i * WIDTH + WALL, y, j * DEPTH + WALL, *table))
    floors.join(box((0, storeys * HEIGHT - 0.2, 0), (nx * WIDTH + WALL, storeys * HEIGHT, nz * DEPTH + WALL)))
    return walls, floors, wood, cloth, rooms


def lamp_place(rng, room):
    """Hanging from the ceiling, on a wall or on the table."""
    x, y, z, tx, tz = room
    kind = rng.random()
    if kind < 0.6:
        return x + rng.uniform(0.4, 4.4), y + rng.uniform(2.2, 2.7), z + rng.uniform(0.4, 3.4)
    if kind < 0.9:
        return x + rng.choice((0.12, 4.72)), y + rng.uniform(1.5, 2.2), z + rng.uniform(0.2, 0.6)
    return tx + rng.uniform(0.1, 1.2), y + rng.uniform(0.86, 1.0), tz + rng.uniform(0.1, 0.65)


def colour_of(rng):
    warm = rng.random()
    c = (1.0, 0.62 + 0.33 * warm, 0.30 + 0.62 * warm)
    return tuple(3 * v / sum(c) for v in c)


def write(name, nx, nz, storeys, seed, lamps):
    walls, floors, wood, cloth, rooms = build(nx, nz, storeys, seed)
    middle = rooms[(storeys // 2) * nx * nz + (nx // 2) * nz + nz // 2]
    x, y, z = middle[:3]
    out = [HEAD.format(count=lamps * len(rooms), rooms=len(rooms), eye=f'{x + 0.35:.2f}, {y + 1.6:.2f}, {z + 3.3:.2f}',
                       target=f'{x + 3.6:.2f}, {y + 1.1:.2f}, {z + 1.3:.2f}')]
    for mesh, material in ((walls, 'plaster'), (floors, 'floor'), (wood, 'wood'), (cloth, 'cloth')):
        mesh.write_ply(os.path.join(HERE, f'{name}-{material}.ply'))
        out.append(f'\t<shape type="ply"><string name="filename" value="{name}-{material}.ply"/>'
                   f'<boolean name="face_normals" value="true"/><ref id="{material}"/></shape>')
    rng = random.Random(seed + 1)
    colours = [colour_of(rng) for _ in range(8)]
    meshes = [Mesh() for _ in colours]
    for room in rooms:
        for _ in range(lamps):
            place = lamp_place(rng, room)
            watts = 0.08 * 10 ** rng.uniform(0, 2)
            size = rng.uniform(0.015, 0.04)
            k = rng.randrange(8)
            if name == 'lights-5000':
                radiance = watts / (4 * math.pi ** 2 * size * size)
                rgb = ', '.join(f'{c * radiance:.4g}' for c in colours[k])
                out.append(f'<shape type="sphere"><point name="center" value="{place[0]:.2f}, {place[1]:.2f}, '
                           f'{place[2]:.2f}"/><float name="radius" value="{size:.3f}"/><ref id="black"/>'
                           f'<emitter type="area"><rgb name="radiance" value="{rgb}"/></emitter></shape>')
            else:  # all of one mesh shine alike: the size makes the power
                half = 0.008 * math.sqrt(watts)
                a, b = (place[0] - half, place[2] - half), (place[0] + half, place[2] + half)
                corners = [(a[0], place[1], a[1]), (b[0], place[1], a[1]), (b[0], place[1], b[1]), (a[0], place[1], b[1])]
                meshes[k].face([(p, (0, 0), (0, -1, 0)) for p in corners])
    if name != 'lights-5000':
        for k, mesh in enumerate(meshes):
            mesh.write_ply(os.path.join(HERE, f'{name}-lamps-{k}.ply'))
            rgb = ', '.join(f'{c * 1000 / math.pi:.4g}' for c in colours[k])
            out.append(f'\t<shape type="ply"><string name="filename" value="{name}-lamps-{k}.ply"/>'
                       f'<boolean name="face_normals" value="true"/><ref id="black"/><emitter type="area">'
                       f'<rgb name="radiance" value="{rgb}"/></emitter></shape>')
    out.append('</scene>\n')
    with open(os.path.join(HERE, name + '.xml'), 'w', encoding='ascii') as file:
        file.write('\n'.join(out))


if __name__ == '__main__':
    write('lights-5000', 10, 10, 2, 5, 25)
    write('lights-15000', 10, 10, 3, 15, 25)
