"""Writes scenes/window and scenes/atrium: rooms that sun and sky light through openings. Usage: python3 daylight.py"""
import math
import os

HERE = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..')

HEAD = '''<!-- {title}; made by scenes/make/daylight.py.
     Tests: {tests}. -->
<scene version="3.0.0">
	<default name="resx" value="480"/>
	<default name="resy" value="270"/>
	<default name="spp" value="64"/>
	<default name="max_depth" value="8"/>
	<default name="integrator" value="path"/>
	<integrator type="$integrator"><integer name="max_depth" value="$max_depth"/></integrator>
	<sensor type="perspective">
		<float name="fov" value="{fov}"/>
		<transform name="to_world"><lookat origin="{eye}" target="{target}" up="0, 1, 0"/></transform>
		<sampler type="independent"><integer name="sample_count" value="$spp"/></sampler>
		<film type="hdrfilm">
			<integer name="width" value="$resx"/>
			<integer name="height" value="$resy"/>
			<rfilter type="gaussian"/>
		</film>
	</sensor>
	<emitter type="sunsky">
		<float name="turbidity" value="3"/>
		<vector name="sun_direction" value="{sun}"/>
		<transform name="to_world"><rotate x="1" angle="-90"/></transform>
		<float name="scale" value="{scale}"/>
	</emitter>
'''


def diffuse(name, rgb):
    return (f'\t<bsdf type="twosided" id="{name}"><bsdf type="diffuse"><rgb name="reflectance" value="{rgb}"/></bsdf>'
            '</bsdf>')


def cube(low, high, material):
    c = [(low[i] + high[i]) / 2 for i in range(3)]
    h = [(high[i] - low[i]) / 2 for i in range(3)]
    return (f'\t<shape type="cube"><transform name="to_world"><scale x="{h[0]:.4g}" y="{h[1]:.4g}" z="{h[2]:.4g}"/>'
            f'<translate x="{c[0]:.4g}" y="{c[1]:.4g}" z="{c[2]:.4g}"/></transform><ref id="{material}"/></shape>')


def with_holes(low, high, axis, holes, material):
    """A slab across `axis`, with rectangular holes ((u0, v0), (u1, v1)) along the other two axes: cut along u first."""
    u, v = [i for i in range(3) if i != axis]
    out, at = [], low[u]
    for (u0, v0), (u1, v1) in sorted(holes):
        def part(a, b):
            lo, hi = list(low), list(high)
            lo[u], lo[v], hi[u], hi[v] = a[0], a[1], b[0], b[1]
            if all(hi[i] > lo[i] for i in range(3)):
                out.append(cube(lo, hi, material))
        if u0 > at:
            part((at, low[v]), (u0, high[v]))
        part((u0, low[v]), (u1, v0))
        part((u0, v1), (u1, high[v]))
        at = u1
    lo, hi = list(low), list(high)
    lo[u] = at
    out.append(cube(lo, hi, material))
    return out


def write(name, lines):
    os.makedirs(os.path.join(HERE, name), exist_ok=True)
    with open(os.path.join(HERE, name, name + '.xml'), 'w', encoding='ascii') as file:
        file.write('\n'.join(lines) + '\n</scene>\n')


def window():
    out = [HEAD.format(title='window: a room of 5 m x 4 m with one window; sun and sky, a street and a house across',
                       tests='tiles of the sky that are seen through a window, and light subpaths that must find it',
                       fov=70, eye='-2.2, 1.6, 1.7', target='1.2, 1.0, -1.2', sun='1.6, 1.25, 0.55', scale=12),
           diffuse('wall', '0.75, 0.73, 0.70'), diffuse('floor', '0.36, 0.25, 0.16'), diffuse('wood', '0.45, 0.30, 0.18'),
           diffuse('cloth', '0.35, 0.12, 0.10'), diffuse('street', '0.25, 0.25, 0.25'), diffuse('brick', '0.42, 0.22, 0.16')]
    out += [cube((-2.7, -0.2, -2.2), (2.9, 0, 2.2), 'floor'), cube((-2.7, 2.7, -2.2), (2.9, 2.9, 2.2), 'wall'),
            cube((-2.7, 0, -2.2), (-2.5, 2.7, 2.2), 'wall'), cube((-2.7, 0, -2.2), (2.9, 2.7, -2.0), 'wall'),
            cube((-2.7, 0, 2.0), (2.9, 2.7, 2.2), 'wall')]
    out += with_holes((2.5, 0, -2.0), (2.9, 2.7, 2.0), 0, [((0.9, -0.5), (2.2, 0.8))], 'wall')
    out += [cube((2.68, 0.9, 0.12), (2.74, 2.2, 0.18), 'wood'), cube((2.68, 1.53, -0.5), (2.74, 1.58, 0.8), 'wood')]
    out += [cube((-0.6, 0.72, -0.6), (0.9, 0.77, 0.3), 'wood')]
    out += [cube((x, 0, z), (x + 0.06, 0.72, z + 0.06), 'wood') for x in (-0.55, 0.78) for z in (-0.55, 0.18)]
    out += [cube((-1.9, 0, -2.0), (-0.9, 1.9, -1.55), 'wood'), cube((0.4, 0.12, -1.95), (2.2, 0.45, -1.15), 'cloth'),
            cube((0.4, 0.45, -1.95), (2.2, 0.9, -1.75), 'cloth')]
    out += [cube((-30, -3.2, -30), (30, -3.0, 30), 'street'), cube((14, -3, -20), (16, 2.2, 20), 'brick')]
    write('window', out)


def atrium():
    out = [HEAD.format(title='atrium: a court of 16 m x 16 m with a gallery on columns, under a roof with nine skylights',
                       tests='sun and sky from above, in patches, and deep shade under the gallery', fov=72,
                       eye='-3.75, 1.7, 7.2', target='0.9, 3.0, -4', sun='0.35, 1, 0.22', scale=12),
           diffuse('stone', '0.62, 0.58, 0.52'), diffuse('floor', '0.40, 0.37, 0.34'), diffuse('column', '0.70, 0.68, 0.64'),
           diffuse('leaf', '0.10, 0.24, 0.07'), diffuse('ground', '0.22, 0.24, 0.18')]
    out += [cube((-8.3, -0.3, -8.3), (8.3, 0, 8.3), 'floor'), cube((-40, -0.6, -40), (40, -0.3, 40), 'ground')]
    for low, high in (((-8.3, 0, -8.3), (-8, 9, 8.3)), ((8, 0, -8.3), (8.3, 9, 8.3)), ((-8, 0, -8.3), (8, 9, -8)),
                      ((-8, 0, 8), (8, 9, 8.3))):
        out.append(cube(low, high, 'stone'))
    for k in range(3):  # three strips of roof, three skylights each
        z0, z1 = -8.3 + k * 16.6 / 3, -8.3 + (k + 1) * 16.6 / 3
        m = (z0 + z1) / 2
        out += with_holes((-8.3, 9, z0), (8.3, 9.5, z1), 1, [((x - 0.9, m - 0.9), (x + 0.9, m + 0.9)) for x in (-4.6, 0, 4.6)],
                          'stone')
    out += [cube((-8, 4.2, -8), (8, 4.5, -5), 'stone'), cube((-8, 4.2, 5), (8, 4.5, 8), 'stone'),
            cube((-8, 4.2, -5), (-5, 4.5, 5), 'stone'), cube((5, 4.2, -5), (8, 4.5, 5), 'stone')]
    for i in range(16):
        a, b = divmod(i, 4)
        t = -5 + 2.5 * b
        x, z = ((t, -5), (5, t), (-t, 5), (-5, -t))[a]
        out.append(f'\t<shape type="cylinder"><point name="p0" x="{x}" y="0" z="{z}"/><point name="p1" x="{x}" y="4.2" '
                   f'z="{z}"/><float name="radius" value="0.24"/><ref id="column"/></shape>')
        out += [cube((x - 0.34, 0, z - 0.34), (x + 0.34, 0.18, z + 0.34), 'column')]
    for x, z in ((-1.6, -1.2), (1.8, 1.4)):  # planted tubs
        out.append(cube((x - 0.6, 0, z - 0.6), (x + 0.6, 0.55, z + 0.6), 'stone'))
        for k in range(5):
            t = 2 * math.pi * k / 5
            out.append(f'\t<shape type="sphere"><point name="center" x="{x + 0.35 * math.cos(t):.2f}" y="{0.9 + 0.1 * k:.2f}" '
                       f'z="{z + 0.35 * math.sin(t):.2f}"/><float name="radius" value="0.36"/><ref id="leaf"/></shape>')
    write('atrium', out)


if __name__ == '__main__':
    window()
    atrium()
