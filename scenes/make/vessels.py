"""Turned and bent things of scenes/ajar: pots, glass, fruit, vase and twigs, lamp."""
import math
import random

from mesh import Mesh, curve, revolve, tube


def carafe(segments=64):
    """A carafe of wine as its three interfaces: glass to air, wine to glass, wine to air. They share their edges."""
    outer = curve([(0.052, 0.0035), (0.066, 0.012), (0.078, 0.04), (0.076, 0.075), (0.052, 0.118), (0.028, 0.155),
                   (0.0215, 0.19), (0.0225, 0.225), (0.034, 0.262)], 4)
    inner = curve([(0.0315, 0.2635), (0.0198, 0.225), (0.0187, 0.19), (0.0252, 0.155), (0.0492, 0.118),
                   (0.0732, 0.075), (0.0752, 0.041),
                   (0.064, 0.016), (0.045, 0.0085)], 4)
    lip = [outer[-1], (0.0343, 0.2632), (0.0336, 0.2643), (0.0325, 0.2644), inner[0]]
    foot = [(0, 0.0012), (0.03, 0.0008), (0.044, 0.0), (0.049, 0.001), outer[0]]
    floor = [inner[-1], (0.03, 0.0072), (0, 0.0068)]
    glass = revolve([foot, outer, lip, inner, floor], segments)
    # the inner wall is cut at the wine's level: air meets glass above, wine meets glass below
    level = 0.098
    i = next(k for k in range(len(inner)) if inner[k][1] < level)
    (r0, y0), (r1, y1) = inner[i - 1], inner[i]
    edge = (r0 + (r1 - r0) * (level - y0) / (y1 - y0), level)
    dry, wet = inner[:i] + [edge], [edge] + inner[i:]
    glass = revolve([foot, outer, lip, dry], segments)
    wine = revolve([floor[::-1], wet[::-1]], segments)
    return glass, wine, revolve([[edge, (0, level)]], segments)


def tumbler(segments=48):
    outer = [(0.030, 0.0015), (0.0305, 0.004), (0.0325, 0.04), (0.035, 0.09)]
    inner = [(0.0332, 0.0905), (0.0308, 0.04), (0.0288, 0.016)]
    lip = [outer[-1], (0.0350, 0.0910), (0.0345, 0.0915), (0.0337, 0.0915), inner[0]]
    return revolve([[(0, 0.0), (0.028, 0.0), (0.0295, 0.0004), outer[0]], outer, lip, inner,
                    [inner[-1], (0.026, 0.0125), (0, 0.0115)]], segments)


def teapot():
    """Ceramic pot of our own: round body, spout, handle, lid with a knob."""
    body = curve([(0.050, 0.004), (0.072, 0.020), (0.090, 0.055), (0.086, 0.090), (0.062, 0.117), (0.046, 0.124)], 5)
    mesh = revolve([[(0, 0.003), (0.044, 0.003), (0.046, 0.0), (0.050, 0.0), (0.050, 0.004)], body,
                    [(0.046, 0.124), (0.046, 0.128), (0.043, 0.128), (0.043, 0.12)]], 48)
    lid = curve([(0.0425, 0.124), (0.041, 0.130), (0.026, 0.139), (0.010, 0.143), (0.006, 0.147)], 4)
    knob = curve([(0.006, 0.147), (0.008, 0.151), (0.0135, 0.158), (0.011, 0.166), (0, 0.168)], 4)
    mesh.join(revolve([lid, knob], 40))
    spout = curve([(0.070, 0.040, 0), (0.105, 0.052, 0), (0.122, 0.085, 0), (0.138, 0.120, 0), (0.152, 0.130, 0)], 5)
    mesh.join(tube(spout, [0.022 - 0.0135 * min(1, 1.25 * i / (len(spout) - 1)) for i in range(len(spout))], 20,
                   caps=True, flat=0.8))
    grip = curve([(-0.078, 0.098, 0), (-0.108, 0.113, 0), (-0.136, 0.098, 0), (-0.136, 0.062, 0), (-0.112, 0.036, 0),
                  (-0.084, 0.034, 0)], 5)
    mesh.join(tube(grip, 0.0072, 14, flat=1.5))
    return mesh


def pot():
    """A tall metal coffee pot with a long spout."""
    body = curve([(0.058, 0.004), (0.064, 0.018), (0.060, 0.06), (0.048, 0.12), (0.040, 0.165), (0.044, 0.19)], 5)
    mesh = revolve([[(0, 0.003), (0.052, 0.003), (0.054, 0.0), (0.058, 0.004)], body,
                    [(0.044, 0.19), (0.0455, 0.193), (0.044, 0.196), (0.040, 0.196)]], 48)
    mesh.join(revolve([curve([(0.0415, 0.195), (0.039, 0.205), (0.022, 0.222), (0.006, 0.231)], 4),
                       curve([(0.006, 0.231), (0.0105, 0.240), (0.008, 0.248), (0, 0.250)], 4)], 40))
    spout = curve([(0.046, 0.055, 0), (0.082, 0.072, 0), (0.100, 0.115, 0), (0.108, 0.160, 0), (0.126, 0.186, 0)], 5)
    mesh.join(tube(spout, [0.016 - 0.0095 * i / (len(spout) - 1) for i in range(len(spout))], 18))
    return mesh


def pot_handle():
    return tube(curve([(-0.043, 0.170, 0), (-0.075, 0.185, 0), (-0.108, 0.172, 0), (-0.116, 0.13, 0),
                       (-0.100, 0.085, 0), (-0.058, 0.06, 0)], 5), 0.0068, 14, flat=1.4)


def bowl():
    outer = curve([(0.045, 0.010), (0.075, 0.022), (0.110, 0.050), (0.132, 0.085)], 5)
    inner = curve([(0.1285, 0.0855), (0.106, 0.053), (0.072, 0.027), (0.040, 0.016), (0, 0.0145)], 5)
    foot = [(0, 0.002), (0.040, 0.002), (0.041, 0.0), (0.046, 0.0), (0.045, 0.010)]
    return revolve([foot, outer, [outer[-1], (0.1315, 0.0868), (0.130, 0.0868), inner[0]], inner], 56)


def apple():
    side = curve([(0.004, 0.006), (0.014, 0.001), (0.029, 0.014), (0.0385, 0.040), (0.034, 0.062), (0.018, 0.070),
                  (0.006, 0.064), (0, 0.0585)], 5)
    return revolve([[(0, 0.008)] + side], 32)


def stalk():
    return tube(curve([(0, 0.057, 0), (0.002, 0.068, 0.001), (0.006, 0.080, 0.001)], 4), 0.0014, 8)


def vase():
    """Tall floor vase, open above."""
    outer = curve([(0.085, 0.004), (0.115, 0.06), (0.150, 0.22), (0.135, 0.38), (0.075, 0.50), (0.052, 0.56),
                   (0.062, 0.62)], 5)
    inner = curve([(0.056, 0.622), (0.046, 0.56), (0.069, 0.50), (0.128, 0.38), (0.142, 0.22), (0.09, 0.03)], 4)
    return revolve([[(0, 0), (0.082, 0), (0.085, 0.004)], outer,
                    [outer[-1], (0.0615, 0.6245), (0.0575, 0.6245), inner[0]], inner, [(0.09, 0.03), (0, 0.03)]], 48)


def candlestick():
    foot = curve([(0.052, 0.003), (0.050, 0.009), (0.030, 0.017), (0.013, 0.028), (0.009, 0.045)], 4)
    stem = curve([(0.009, 0.045), (0.016, 0.060), (0.0085, 0.078), (0.0075, 0.125), (0.014, 0.143), (0.009, 0.155)], 4)
    pan = [(0.009, 0.155), (0.031, 0.160), (0.034, 0.165), (0.031, 0.1645), (0.0145, 0.1625)]
    cup = [(0.0145, 0.1625), (0.0145, 0.188), (0.0118, 0.188), (0.0118, 0.165), (0, 0.165)]
    return revolve([[(0, 0.002), (0.045, 0.002), (0.046, 0.0), (0.052, 0.0), (0.052, 0.003)], foot, stem] +
                   [[a, b] for a, b in zip(pan + cup[1:], pan[1:] + cup[1:])], 40)


def candle():
    """Stands in the candlestick; its wick has never been lit."""
    wax = revolve([[(0, 0.166), (0.0112, 0.166)], [(0.0112, 0.166), (0.0105, 0.330)],
                   curve([(0.0105, 0.330), (0.0095, 0.334), (0.005, 0.337), (0, 0.338)], 3)], 32)
    return wax.join(tube([(0, 0.336, 0), (0.0008, 0.342, 0), (0.0028, 0.348, 0)], 0.0012, 8))


def twigs(seed):
    """Bare branches that stand in the vase."""
    rng = random.Random(seed)
    mesh = Mesh()

    def grow(p, d, length, radius, level):
        points, q, v = [p], p, d
        steps = 4
        for _ in range(steps):
            v = tuple(c + rng.uniform(-0.12, 0.12) for c in v)
            v = (v[0], v[1] + 0.05, v[2])
            norm = math.sqrt(sum(c * c for c in v))
            v = tuple(c / norm for c in v)
            q = tuple(a + b * length / steps for a, b in zip(q, v))
            points.append(q)
        path = curve(points, 2)
        mesh.join(tube(path, [radius * (1 - 0.55 * i / (len(path) - 1)) for i in range(len(path))],
                       6 if level == 0 else 5))
        if level < 2:
            for k in range(3 if level == 0 else 2):
                i = rng.randrange(len(path) // 3, len(path) - 1)
                side = tuple(c + rng.uniform(-0.75, 0.75) for c in v)
                grow(path[i], side, length * rng.uniform(0.35, 0.6), radius * 0.55, level + 1)

    for k in range(5):
        a = 2.4 * k
        lean = 0.12 + 0.05 * k
        grow((0.02 * math.cos(a), 0.10, 0.02 * math.sin(a)), (lean * math.cos(a), 1, lean * math.sin(a)),
             rng.uniform(0.95, 1.15), 0.0048, 0)
    # a thicket that stays inside the neck of the vase (inner radius 0.046 m at 0.56 m)
    for f in mesh.faces:
        for i, (p, t, n) in enumerate(f):
            if p[1] < 0.62:
                r = math.hypot(p[0], p[2])
                limit = 0.040
                if r > limit:
                    f[i] = ((p[0] * limit / r, p[1], p[2] * limit / r), t, n)
    return mesh


def lamp():
    """Uplighter: foot, pole and an open metal bowl; the light is a disk that lies in the bowl, at 1.745 m."""
    metal = revolve([[(0, 0.0), (0.14, 0.0), (0.142, 0.004)],
                     [(0.142, 0.004), (0.14, 0.018), (0.02, 0.026), (0.0125, 0.032)],
                     [(0.0125, 0.032), (0.0125, 1.66)]], 32)
    outer = curve([(0.0125, 1.66), (0.03, 1.67), (0.10, 1.71), (0.155, 1.77), (0.175, 1.82)], 4)
    inner = curve([(0.172, 1.8205), (0.151, 1.772), (0.097, 1.714), (0.03, 1.676), (0, 1.674)], 4)
    return metal.join(revolve([outer, [outer[-1], (0.1745, 1.822), (0.1725, 1.822), inner[0]], inner], 40))
