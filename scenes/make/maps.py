"""Writes the small textures of bump, masks and environment. Usage: python3 maps.py"""
import math
import os
import random

from image import fractal, mix, smooth, write_hdr, write_png

SCENES = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..')


def cobbles(path, size=192, count=6):
    """Heights of rounded stones: distance to the nearest border of a tileable Voronoi pattern."""
    rng = random.Random(17)
    seeds = {(i, j): (i + rng.uniform(0.2, 0.8), j + rng.uniform(0.2, 0.8)) for i in range(count) for j in range(count)}
    rough = fractal(3, 12, 12, 3)

    def pixel(x, y):
        u, v = x / size * count, y / size * count
        near = []
        for i in range(math.floor(u) - 2, math.floor(u) + 3):
            for j in range(math.floor(v) - 2, math.floor(v) + 3):
                px, py = seeds[(i % count, j % count)]
                near.append(math.hypot(px + i - i % count - u, py + j - j % count - v))
        near.sort()
        border = near[1] - near[0]
        return 0.9 * smooth(0.0, 0.55, border) ** 0.6 + 0.1 * rough(x / size, y / size)

    write_png(path, size, size, pixel, 1)


def studs(path, size=64):
    """Normals of a round stud on a flat plate: 0.5 + 0.5 n, z out of the plate, y up in the picture."""
    def pixel(x, y):
        u, v = 2 * (x + 0.5) / size - 1, 1 - 2 * (y + 0.5) / size
        r, edge = math.hypot(u, v), 0.62
        slope = 0.0
        if 0 < r < edge:
            slope = 0.9 * math.sin(math.pi * (r / edge)) ** 2 * (r / edge)
        n = (slope * u / max(r, 1e-9), slope * v / max(r, 1e-9), 1.0)
        length = math.sqrt(sum(c * c for c in n))
        return tuple(0.5 + 0.5 * c / length for c in n)

    write_png(path, size, size, pixel)


def leaf_shape(u, v):
    """Distance-like value > 0 inside a leaf with a stalk; u in [-1, 1], v in [0, 1] upwards."""
    blade = (v - 0.18) / 0.80
    half = 0.0
    if 0 < blade < 1:
        half = 0.80 * math.sin(math.pi * blade**0.75)**0.85 * (1 + 0.06 * math.sin(40 * blade))
    return max(half - abs(u), (0.035 - abs(u)) if v < 0.3 else -1.0)


def leaf(mask, colour, width=96, height=192):
    def coords(x, y): return 2 * (x + 0.5) / width - 1, 1 - (y + 0.5) / height

    def opacity(x, y): return smooth(-0.01, 0.01, leaf_shape(*coords(x, y)))

    def pixel(x, y):
        u, v = coords(x, y)
        vein = min(abs(u), abs((v * 9 - 2.2 * abs(u)) % 1 - 0.5) * 0.25)
        c = mix((0.62, 0.74, 0.34), (0.24, 0.46, 0.14), smooth(0.0, 0.05, vein))
        return tuple(q * (0.8 + 0.3 * v) for q in c)

    write_png(mask, width, height, opacity, 1)
    write_png(colour, width, height, pixel)


def sky(path, width=256, height=128):
    """Clear evening sky: glow around the sun, a brown ground below; the sun is a block of 2 × 2 texels."""
    clouds = fractal(41, 6, 6, 4)
    sun_x, sun_y = 52, 42

    def pixel(x, y):
        u, v = (x + 0.5) / width, (y + 0.5) / height
        up = math.cos(math.pi * v)
        if x in (sun_x, sun_x + 1) and y in (sun_y, sun_y + 1):
            return (3600.0, 3000.0, 2200.0)
        if up < 0:
            return mix((0.30, 0.27, 0.22), (0.12, 0.10, 0.08), smooth(0, 0.3, -up))
        c = mix((0.95, 0.82, 0.70), (0.16, 0.30, 0.62), smooth(0.0, 0.55, up))
        c = mix(c, (1.0, 0.97, 0.95), 0.5 * smooth(0.5, 0.75, clouds(u, v)) * smooth(0.02, 0.2, up))
        du = 2 * math.pi * ((u - (sun_x + 1) / width + 0.5) % 1 - 0.5) * math.sin(math.pi * v)
        dv = math.pi * (v - (sun_y + 1) / height)
        glow = 3.0 * math.exp(-9 * math.hypot(du, dv))
        return tuple(a + glow * b for a, b in zip(c, (1.0, 0.85, 0.6)))

    write_hdr(path, width, height, pixel)


def main():
    for name in ('bump', 'masks', 'environment'):
        os.makedirs(os.path.join(SCENES, name, 'textures'), exist_ok=True)
    cobbles(os.path.join(SCENES, 'bump', 'textures', 'cobbles.png'))
    studs(os.path.join(SCENES, 'bump', 'textures', 'studs.png'))
    leaf(os.path.join(SCENES, 'masks', 'textures', 'leaf-mask.png'),
         os.path.join(SCENES, 'masks', 'textures', 'leaf.png'))
    sky(os.path.join(SCENES, 'environment', 'textures', 'sky.hdr'))


if __name__ == '__main__':
    main()
