"""Meshes for Ajar's scenes: boxes with chamfered edges, bodies of revolution, tubes; written as OBJ or binary PLY.

Metres, y up. Every vertex carries its own normal, so a file looks the same with and without smoothing in the loader.
"""
import math
import struct


def add(a, b): return (a[0] + b[0], a[1] + b[1], a[2] + b[2])
def sub(a, b): return (a[0] - b[0], a[1] - b[1], a[2] - b[2])
def mul(a, s): return (a[0] * s, a[1] * s, a[2] * s)
def dot(a, b): return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
def cross(a, b): return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = math.sqrt(dot(a, a))
    return mul(a, 1 / length) if length > 0 else (0.0, 1.0, 0.0)


class Mesh:
    """Polygons of (position, uv, normal) corners."""

    def __init__(self):
        self.faces = []

    def face(self, corners):
        """Adds one convex polygon; turns it so that it is counter-clockwise seen from where its normals point."""
        points = [c[0] for c in corners]
        area = (0.0, 0.0, 0.0)
        for i in range(1, len(points) - 1):
            area = add(area, cross(sub(points[i], points[0]), sub(points[i + 1], points[0])))
        if dot(area, area) == 0:
            return
        mean = (0.0, 0.0, 0.0)
        for c in corners:
            mean = add(mean, c[2])
        self.faces.append(list(reversed(corners)) if dot(area, mean) < 0 else list(corners))

    def join(self, other):
        self.faces += other.faces
        return self

    def moved(self, offset=(0, 0, 0), turn=0.0, axis=1):
        """A copy, first turned about an axis (degrees), then moved."""
        c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))
        j, k = (axis + 1) % 3, (axis + 2) % 3

        def rotate(p):
            q = list(p)
            q[j], q[k] = c * p[j] - s * p[k], s * p[j] + c * p[k]
            return tuple(q)

        out = Mesh()
        out.faces = [[(add(rotate(p), offset), t, rotate(n)) for p, t, n in f] for f in self.faces]
        return out

    def bounds(self):
        points = [c[0] for f in self.faces for c in f]
        return tuple(min(p[i] for p in points) for i in range(3)), tuple(max(p[i] for p in points) for i in range(3))

    def write_obj(self, path, uv=True):
        lists, seen = {'v': [], 'vt': [], 'vn': []}, {}

        def index(kind, values, digits):
            words = (f'{x:.{digits}f}'.rstrip('0').rstrip('.') for x in values)
            line = ' '.join('0' if w in ('-0', '') else w for w in words)
            key = (kind, line)
            if key not in seen:
                lists[kind].append(line)
                seen[key] = len(lists[kind])
            return seen[key]

        lines = []
        for f in self.faces:
            words = []
            for p, t, n in f:
                v, m = index('v', p, 5), index('vn', n, 4)
                words.append(f'{v}/{index("vt", t, 4)}/{m}' if uv else f'{v}//{m}')
            lines.append('f ' + ' '.join(words))
        with open(path, 'w', encoding='ascii') as out:
            out.write('# made by scenes/make; metres, y up\n')
            for kind, values in lists.items():
                out.writelines(f'{kind} {x}\n' for x in values)
            out.write('\n'.join(lines) + '\n')

    def write_ply(self, path):
        """Binary little-endian, positions and normals, polygons as they are."""
        seen, data, faces = {}, [], []
        for f in self.faces:
            ids = []
            for p, _, n in f:
                key = struct.pack('<6f', *(round(x, 6) + 0.0 for x in p), *(round(x, 4) + 0.0 for x in n))
                if key not in seen:
                    seen[key] = len(data)
                    data.append(key)
                if not ids or (ids[-1] != seen[key] and ids[0] != seen[key]):
                    ids.append(seen[key])
            if len(ids) > 2:
                faces.append(struct.pack(f'<B{len(ids)}i', len(ids), *ids))
        with open(path, 'wb') as out:
            head = ('ply\nformat binary_little_endian 1.0\ncomment made by scenes/make; metres, y up\n'
                    f'element vertex {len(data)}\n' +
                    ''.join(f'property float {n}\n' for n in 'x y z nx ny nz'.split()) +
                    f'element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n')
            out.write(head.encode('ascii'))
            out.write(b''.join(data))
            out.write(b''.join(faces))


def box(low, high, chamfer=0.0, grain=0, shift=(0.0, 0.0)):
    """Axis-parallel box with flat chamfers. uv in metres, u along the axis `grain` where there is one, plus `shift`."""
    mesh = Mesh()
    chamfer = min(chamfer, *(0.45 * (high[i] - low[i]) for i in range(3)))

    def corner(side, inset_axis):
        """The corner `side` (three signs), pulled in by the chamfer along every axis but inset_axis."""
        return tuple((high[i] if side[i] > 0 else low[i]) - (side[i] * chamfer if i != inset_axis else 0)
                     for i in range(3))

    def put(points, normal):
        along = max(range(3), key=lambda i: abs(normal[i]))
        rest = [i for i in range(3) if i != along]
        u, v = (rest if rest[0] == grain or grain == along else rest[::-1])
        mesh.face([(p, (p[u] + shift[0], p[v] + shift[1]), normal) for p in points])

    signs = (-1, 1)
    for a in range(3):
        b, c = (a + 1) % 3, (a + 2) % 3
        for s in signs:
            ring = []
            for sb, sc in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                side = [0, 0, 0]
                side[a], side[b], side[c] = s, sb, sc
                ring.append(corner(side, a))
            put(ring, tuple(s if i == a else 0 for i in range(3)))
    if chamfer > 0:
        for a in range(3):  # the twelve edges, along axis a
            b, c = (a + 1) % 3, (a + 2) % 3
            for sb in signs:
                for sc in signs:
                    ends = []
                    for s in signs:
                        side = [0, 0, 0]
                        side[a], side[b], side[c] = s, sb, sc
                        ends.append((corner(side, b), corner(side, c)))
                    normal = [0, 0, 0]
                    normal[b], normal[c] = sb, sc
                    put([ends[0][0], ends[1][0], ends[1][1], ends[0][1]], unit(normal))
        for x in signs:
            for y in signs:
                for z in signs:
                    put([corner((x, y, z), i) for i in range(3)], unit((x, y, z)))
    return mesh


def tapered(low, high, shrink, chamfer=0.0, grain=1):
    """A box whose lower end is narrower: a table leg. shrink = width at the foot / width at the top."""
    mesh = box(low, high, chamfer, grain)
    mid = ((low[0] + high[0]) / 2, (low[2] + high[2]) / 2)
    out = Mesh()
    for f in mesh.faces:
        points = []
        for p, t, _ in f:
            k = shrink + (1 - shrink) * (p[1] - low[1]) / (high[1] - low[1])
            points.append(((mid[0] + (p[0] - mid[0]) * k, p[1], mid[1] + (p[2] - mid[1]) * k), t))
        normal = unit(cross(sub(points[1][0], points[0][0]), sub(points[2][0], points[0][0])))
        out.face([(p, t, normal) for p, t in points])
    return out


def curve(points, steps):
    """Catmull-Rom through 2D or 3D control points (centripetal would be overkill here), `steps` pieces a span."""
    out = []
    n = len(points)
    for i in range(n - 1):
        p0, p1, p2, p3 = points[max(i - 1, 0)], points[i], points[i + 1], points[min(i + 2, n - 1)]
        for k in range(steps):
            t = k / steps
            out.append(tuple(b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * b - a - 3 * c + d)))
                             for a, b, c, d in zip(p0, p1, p2, p3)))
    out.append(tuple(float(x) for x in points[-1]))
    return out


def revolve(runs, segments=48):
    """Body of revolution about y. `runs` are lists of (radius, height) with the outside on the right (outer wall
    upwards); each run is smooth in itself, and two runs meet in a crease."""
    mesh = Mesh()
    ring = [(math.cos(2 * math.pi * i / segments), math.sin(2 * math.pi * i / segments)) for i in range(segments)]
    ring.append(ring[0])
    for run in runs:
        run = [(max(0.0, r), y) for r, y in run]
        normals = []
        for i in range(len(run)):
            a, b = run[max(i - 1, 0)], run[min(i + 1, len(run) - 1)]
            d = unit((b[1] - a[1], -(b[0] - a[0]), 0))
            normals.append((0.0, math.copysign(1.0, d[1])) if run[i][0] == 0 and len(run) > 2 else (d[0], d[1]))
        for i in range(len(run) - 1):
            for k in range(segments):
                quad = []
                for j, m in ((i, k), (i + 1, k), (i + 1, k + 1), (i, k + 1)):
                    if run[j][0] == 0 and m == k + 1:
                        continue  # one corner is enough at a pole
                    (r, y), (nr, ny), (c, s) = run[j], normals[j], ring[m]
                    quad.append(((r * c, y, r * s), (m / segments, i / len(run)), (nr * c, ny, nr * s)))
                mesh.face(quad)
    return mesh


def tube(path, radius, segments=12, caps=True, flat=1.0):
    """Round tube along 3D points. radius: a number or one per point; flat: the ratio of the two half axes."""
    n = len(path)
    radii = [radius] * n if isinstance(radius, (int, float)) else radius
    tangents = [unit(sub(path[min(i + 1, n - 1)], path[max(i - 1, 0)])) for i in range(n)]
    side = unit(cross(tangents[0], (0, 0, 1) if abs(tangents[0][2]) < 0.9 else (1, 0, 0)))
    rings = []
    for i in range(n):
        side = unit(sub(side, mul(tangents[i], dot(side, tangents[i]))))
        up = cross(tangents[i], side)
        ring = []
        for k in range(segments):
            c, s = math.cos(2 * math.pi * k / segments), math.sin(2 * math.pi * k / segments)
            offset = add(mul(side, c * radii[i]), mul(up, s * radii[i] * flat))
            ring.append((add(path[i], offset), unit(add(mul(side, c * flat), mul(up, s)))))
        rings.append(ring)
    mesh = Mesh()
    for i in range(n - 1):
        for k in range(segments):
            m = (k + 1) % segments
            mesh.face([(rings[a][b][0], (b / segments, a / n), rings[a][b][1]) for a,
                       b in ((i, k), (i + 1, k), (i + 1, m), (i, m))])
    if caps:
        for ring, normal in ((rings[0], mul(tangents[0], -1)), (rings[-1], tangents[-1])):
            mesh.face([(p, (0, 0), normal) for p, _ in ring])
    return mesh


def slab_with_hole(low, high, hole_low, hole_high):
    """Wall parallel to xy with one rectangular opening (x, y) through it; one closed surface."""
    mesh = Mesh()
    xs, ys = (low[0], hole_low[0], hole_high[0], high[0]), (low[1], hole_low[1], hole_high[1], high[1])

    def quad(points, normal):
        mesh.face([(p, (p[0] + p[2], p[1]), normal) for p in points])

    for z, n in ((low[2], -1), (high[2], 1)):
        for i in range(3):
            for j in range(3):
                if (i, j) != (1, 1):
                    quad([(xs[a], ys[b], z) for a, b in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1))], (0, 0, n))
    for i in range(3):
        for y, n in ((ys[0], -1), (ys[3], 1)):
            quad([(xs[a], y, z) for a, z in ((i, low[2]), (i + 1, low[2]), (i + 1, high[2]), (i, high[2]))], (0, n, 0))
        for x, n in ((xs[0], -1), (xs[3], 1)):
            quad([(x, ys[a], z) for a, z in ((i, low[2]), (i + 1, low[2]), (i + 1, high[2]), (i, high[2]))], (n, 0, 0))
    for y, n in ((ys[1], 1), (ys[2], -1)):
        quad([(x, y, z) for x, z in ((xs[1], low[2]), (xs[2], low[2]), (xs[2], high[2]), (xs[1], high[2]))], (0, n, 0))
    for x, n in ((xs[1], 1), (xs[2], -1)):
        quad([(x, y, z) for y, z in ((ys[1], low[2]), (ys[2], low[2]), (ys[2], high[2]), (ys[1], high[2]))], (n, 0, 0))
    return mesh
