"""Furniture of scenes/ajar, each piece with its foot at y = 0."""
import math
import random

from mesh import Mesh, box, curve, tapered, tube


def boxes(*parts):
    mesh = Mesh()
    for part in parts:
        mesh.join(box(*part[:2], **part[2]) if len(part) > 2 else box(*part))
    return mesh


def skirting(length):
    return box((0, -0.01, -0.01), (length, 0.085, 0.012),
               0.004).join(box((0, -0.01, -0.01), (length, 0.060, 0.016), 0.003))


def table():
    mesh = Mesh()
    for k in range(5):  # five boards
        z = -0.43 + k * 0.172
        mesh.join(box((-0.80, 0.718, z + 0.0004), (0.80, 0.750, z + 0.1716), 0.0015, grain=0,
                      shift=(0.41 * k, 0.13 * k)))
    mesh.join(box((-0.70, 0.630, -0.345), (0.70, 0.7185, -0.323), 0.002, grain=0))
    mesh.join(box((-0.70, 0.630, 0.323), (0.70, 0.7185, 0.345), 0.002, grain=0, shift=(0.5, 0.2)))
    for x in (-0.715, 0.693):
        mesh.join(box((x, 0.630, -0.34), (x + 0.022, 0.7185, 0.34), 0.002, grain=2))
    for x in (-0.735, 0.675):
        for z in (-0.365, 0.305):
            mesh.join(tapered((x, 0, z), (x + 0.06, 0.7185, z + 0.06), 0.62, 0.002))
    return mesh


def chair():
    """Seat at 0.45 m, the back at -z."""
    mesh = box((-0.21, 0.43, -0.20), (0.21, 0.455, 0.22), 0.006, grain=2)
    for x in (-0.19, 0.155):
        mesh.join(tapered((x, 0, 0.165), (x + 0.035, 0.431, 0.20), 0.65, 0.002))
        leg = [(x + 0.0175, 0, -0.235), (x + 0.0175, 0.43, -0.1825), (x + 0.0175, 0.66, -0.205),
               (x + 0.0175, 0.93, -0.265)]
        mesh.join(tube(curve(leg, 5), 0.0165, 10))
    for z in (-0.18, 0.18):
        mesh.join(box((-0.165, 0.375, z - 0.009), (0.165, 0.4305, z + 0.009), 0.002))
    for x in (-0.172, 0.172):
        mesh.join(box((x - 0.009, 0.375, -0.17), (x + 0.009, 0.4304, 0.17), 0.002, grain=2))
        mesh.join(tube([(x, 0.17, -0.205), (x, 0.19, 0.178)], 0.010, 8))
    mesh.join(tube([(-0.172, 0.18, -0.01), (0.172, 0.18, -0.01)], 0.009, 8))
    for y, z, h in ((0.86, -0.250, 0.085), (0.74, -0.226, 0.04), (0.63, -0.205, 0.04)):  # curved back rails
        path = [(x, y, z - 0.035 * (1 - (x / 0.175) ** 2)) for x in (-0.175, -0.14, -0.1, -0.05, 0, 0.05, 0.1, 0.14,
                                                                     0.175)]
        rail = Mesh()
        for a, b in zip(path, path[1:]):
            n0, n1 = [(0.4 * p[0], 0, 1) for p in (a, b)]
            for s in (1, -1):
                quad = []
                for p, n, dy in ((a, n0, -h / 2), (b, n1, -h / 2), (b, n1, h / 2), (a, n0, h / 2)):
                    length = math.sqrt(n[0] ** 2 + 1)
                    normal = (s * n[0] / length * -1, 0, s / length)
                    quad.append(((p[0], p[1] + dy, p[2] + s * 0.007), (p[0], p[1] + dy), normal))
                rail.face(quad)
                edge = ((a, -0.007), (b, -0.007), (b, 0.007), (a, 0.007))
                rail.face([((p[0], p[1] + s * h / 2, p[2] + t), (p[0], p[2]), (0, s, 0)) for p, t in edge])
        mesh.join(rail)
    return mesh


def bookcase():
    """Open shelf with a closed back: 0.30 deep (x), 1.00 wide (z), 1.95 high; its back at x = 0."""
    mesh = box((0.001, 0.02, -0.49), (0.012, 1.94, 0.49), 0, grain=1)
    for z in (-0.50, 0.475):
        mesh.join(box((0.0, 0, z), (0.30, 1.95, z + 0.025), 0.0015, grain=1, shift=(z, 0)))
    for y in (0.06, 0.44, 0.80, 1.16, 1.52, 1.92):
        mesh.join(box((0.0005, y, -0.476), (0.2985, y + 0.025, 0.476), 0.0015, grain=2, shift=(y, y)))
    mesh.join(box((0.02, 0, -0.476), (0.27, 0.061, 0.476), 0.001, grain=2))
    return mesh


def books(seed):
    """Rows of books for the bookcase; three groups, one a colour."""
    rng = random.Random(seed)
    groups = [Mesh(), Mesh(), Mesh()]
    for shelf, (begin, end) in ((0.465, (-0.46, 0.20)), (0.825, (-0.46, 0.46)), (1.185, (-0.20, 0.46)),
                                (1.545, (-0.46, 0.10))):
        z = begin
        while True:
            thick, high, deep = rng.uniform(0.018, 0.048), rng.uniform(0.19, 0.29), rng.uniform(0.15, 0.20)
            if z + thick > end:
                break
            front = 0.265 - rng.uniform(0, 0.02)
            groups[rng.randrange(3)].join(box((front - deep, shelf, z), (front, shelf + high, z + thick), 0.004))
            z += thick + 0.0012
    return groups


def stack():
    """Three books that lie on the table; covers and pages apart."""
    covers, pages, y = Mesh(), Mesh(), 0.0
    for w, d, h, turn, dx in ((0.25, 0.18, 0.030, 4, 0), (0.22, 0.155, 0.024, -9, 0.006),
                              (0.18, 0.12, 0.019, 17, -0.004)):
        cover = boxes(((-w / 2, 0, -d / 2), (w / 2, 0.0025, d / 2)), ((-w / 2, h - 0.0025, -d / 2), (w / 2, h, d / 2)),
                      ((-w / 2, 0.0024, -d / 2), (w / 2, h - 0.0024, -d / 2 + 0.003)))
        block = box((-w / 2 + 0.004, 0.002, -d / 2 + 0.002), (w / 2 - 0.004, h - 0.002, d / 2 - 0.004))
        covers.join(cover.moved((dx, y, 0), turn))
        pages.join(block.moved((dx, y, 0), turn))
        y += h + 0.0003
    return covers, pages


def picture_frame(width, height, bar):
    """Hollow frame in the xy plane, the wall at z = 0; mitred in spirit: long bars between the side bars."""
    w, h = width / 2, height / 2
    up, along = {'chamfer': 0.006, 'grain': 1}, {'chamfer': 0.006}
    return boxes(((-w - bar, -h - bar, 0), (-w, h + bar, 0.03), up), ((w, -h - bar, 0), (w + bar, h + bar, 0.03), up),
                 ((-w - 0.005, h, 0), (w + 0.005, h + bar, 0.0294), along),
                 ((-w - 0.005, -h - bar, 0), (w + 0.005, -h, 0.0294), along))


def sofa():
    """1.8 wide (x), back at -z."""
    mesh = boxes(((-0.90, 0.10, -0.42), (0.90, 0.30, 0.42), {'chamfer': 0.02}),
                 ((-0.90, 0.29, -0.42), (0.90, 0.82, -0.20), {'chamfer': 0.05}),
                 ((-0.92, 0.10, -0.43), (-0.74, 0.60, 0.43), {'chamfer': 0.04}),
                 ((0.74, 0.10, -0.43), (0.92, 0.60, 0.43), {'chamfer': 0.04}))
    for x in (-0.735, 0.005):
        mesh.join(box((x, 0.29, -0.22), (x + 0.73, 0.45, 0.44), 0.035))
        mesh.join(box((x, 0.44, -0.24), (x + 0.73, 0.80, -0.06), 0.05))
    for x in (-0.86, 0.82):
        for z in (-0.38, 0.34):
            mesh.join(box((x, 0, z), (x + 0.04, 0.11, z + 0.04)))
    return mesh


def sideboard():
    """1.4 wide (x), 0.42 deep (z, back at 0), 0.78 high, three doors."""
    mesh = boxes(((-0.70, 0.10, 0), (0.70, 0.76, 0.40), {'chamfer': 0.002}),
                 ((-0.72, 0.755, 0), (0.72, 0.785, 0.43), {'chamfer': 0.003}))
    for k in range(3):
        x = -0.69 + k * 0.462
        mesh.join(box((x, 0.12, 0.39), (x + 0.455, 0.745, 0.418), 0.003, grain=1, shift=(0.3 * k, 0.1 * k)))
    for x in (-0.66, 0.62):
        for z in (0.03, 0.33):
            mesh.join(tapered((x, 0, z), (x + 0.04, 0.11, z + 0.04), 0.7))
    return mesh
