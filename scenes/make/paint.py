"""Textures of scenes/ajar: wood, a painting, a rug."""
import math
import random

from image import fractal, mix, noise, smooth, write_png

HILLS = ((0.47, 0.13, (0.52, 0.55, 0.64)), (0.515, 0.10, (0.33, 0.42, 0.46)), (0.54, 0.05, (0.18, 0.29, 0.25)))
POPLARS = ((0.105, 0.30, 0.020), (0.16, 0.22, 0.026), (0.215, 0.34, 0.018), (0.90, 0.42, 0.020))


def wood(path, size, seed, dark, light, streaks, planks=0):
    """Wood, grain along u. planks > 0: that many floor boards across v, each with its own shade and end joints."""
    width, height = size
    fine, warp, pore = fractal(seed, 3, streaks, 3), fractal(seed + 50, 2, 3, 3), noise(seed + 90, 16, height // 2)
    rng = random.Random(seed)
    boards = [(rng.random(), rng.random(), rng.uniform(-1, 1)) for _ in range(max(planks, 1))]

    def pixel(x, y):
        u, v = x / width, y / height
        shade, edge = 0.0, 1.0
        if planks:
            row = int(v * planks)
            start, offset, tone = boards[row]
            second = ((u - start) % 1.0) < 0.5
            shade = 0.16 * tone + (0.10 if second else -0.07) * (1 if offset > 0.5 else -1)
            gap_v = min(v * planks - row, row + 1 - v * planks) / planks * height
            gap_u = min((u - start) % 0.5, 0.5 - (u - start) % 0.5) * width
            edge = min(smooth(0.0, 1.1, gap_v), smooth(0.0, 0.9, gap_u))
            u, v = u + offset + (0.31 if second else 0), v + 0.37 * offset
        g = fine((u + 0.05 * warp(u, v)) % 1, (v + 0.06 * warp(u, v)) % 1)
        rings = 0.5 + 0.5 * math.sin(2 * math.pi * (3.0 * warp(u, v) * 2 + 5 * g))
        t = 0.55 * g + 0.25 * rings + 0.25 * pore(u % 1, v % 1) + shade
        c = mix(dark, light, max(0.0, min(1.0, t)))
        return tuple(round(k * 48) / 48 * (0.45 + 0.55 * edge) for k in c)  # 48 shades keep the file small

    write_png(path, width, height, pixel)


def painting(path, width, height):
    """A lake at dusk: sky, sun, three ridges, their mirror image, a near bank with poplars."""
    ridge = [noise(3, 5, 1), noise(5, 9, 1), noise(8, 23, 1)]
    ripple, brush, clouds = fractal(11, 4, 60, 2), fractal(21, 60, 40, 2), fractal(31, 3, 10, 4)
    horizon = 0.56

    def scene(u, v):
        t = v / horizon
        sky = mix((0.30, 0.42, 0.60), (0.98, 0.76, 0.50), smooth(0.05, 1.0, t))
        c = smooth(0.52, 0.78, clouds(u, v * 0.9))
        sky = mix(sky, (0.99, 0.86, 0.74), 0.55 * c)
        d = math.hypot((u - 0.66) * width / height, v - 0.40)
        sky = mix(sky, (1.0, 0.95, 0.78), max(smooth(0.055, 0.048, d), 0.5 * math.exp(-7 * d)))
        for k, (base, amp, colour) in enumerate(HILLS):
            line = base - amp * (ridge[k](u, 0) - 0.35) - 0.012 * ridge[2](u * 2 % 1, 0)
            if v > line:
                sky = mix(colour, mix(colour, (0.95, 0.72, 0.5), 0.25), smooth(horizon, line, v))
        return sky

    def pixel(x, y):
        u, v = (x + 0.5) / width, (y + 0.5) / height
        if v < horizon:
            c = scene(u, v)
        else:
            w = ripple(u, v)
            mirrored = 2 * horizon - v - 0.05 * (w - 0.5) * (1 + 3 * (v - horizon))
            c = scene(u + 0.012 * (w - 0.5), max(0.0, mirrored))
            c = mix(c, (0.20, 0.30, 0.38), 0.30 + 0.25 * (v - horizon))
        bank = 0.86 + 0.05 * math.sin(5 * u + 0.8) + 0.02 * ridge[2](u, 0)
        if v > bank:
            c = mix((0.30, 0.36, 0.14), (0.14, 0.18, 0.08), smooth(bank, bank + 0.14, v))
        for px, top, wide in POPLARS:
            s = (v - top) / (0.90 - top)
            ragged = 0.75 + 0.5 * ridge[2]((v * 3 + px) % 1, 0)
            if 0 < s < 1 and abs(u - px) < wide * math.sin(math.pi * s**0.7)**0.6 * ragged:
                c = mix((0.10, 0.16, 0.10), (0.36, 0.34, 0.14), smooth(px - wide, px + wide, u))
        k = 0.92 + 0.16 * brush(u, v)
        return tuple(round(max(0, min(1, q * k)) * 60) / 60 for q in c)

    write_png(path, width, height, pixel)


def rug(path, width, height):
    """Woven rug: border, field, rows of lozenges."""
    thread = noise(7, width // 2, height // 2)
    cream, red, blue, dark = (0.80, 0.73, 0.60), (0.50, 0.16, 0.13), (0.17, 0.24, 0.36), (0.20, 0.13, 0.11)

    def pixel(x, y):
        u, v = x / (width - 1) - 0.5, y / (height - 1) - 0.5
        a, b = (0.5 - abs(u)) * 2.2, (0.5 - abs(v)) * 1.5  # metres to the edge
        m = min(a, b)
        if m < 0.025: c = cream
        elif m < 0.05: c = dark
        elif m < 0.15:
            s = (u * 2.2 if b < a else v * 1.5) / 0.10
            c = cream if abs((s % 1) - 0.5) + abs((m - 0.10) / 0.10) < 0.42 else blue
        elif m < 0.175: c = dark
        else:
            s, t = u * 2.2 / 0.22, v * 1.5 / 0.22
            d = abs((s + 0.5) % 1 - 0.5) + abs((t + 0.5) % 1 - 0.5)
            c = cream if d < 0.16 else (blue if d < 0.30 else (red if d < 0.86 else dark))
        k = 0.88 + 0.22 * round(thread(x / width, y / height) * 4) / 4
        return tuple(q * k for q in c)

    write_png(path, width, height, pixel)
