"""The door of scenes/ajar: leaf, furniture, frame."""
from mesh import Mesh, box, curve, tube

# The clear opening in the dividing wall, the leaf in it, and the gaps around the closed leaf [m].
OPENING, HEIGHT, DEPTH = 0.900, 2.050, 0.140
LEAF, GAP_LATCH, GAP_BELOW, GAP_HINGE, GAP_ABOVE = 0.035, 0.005, 0.005, 0.002, 0.002


def leaf():
    """Two panels. The hinge axis is the y axis; the leaf fills x in [-width, 0], z in [-LEAF, 0]."""
    width, low, high = OPENING - GAP_LATCH - GAP_HINGE, GAP_BELOW, HEIGHT - GAP_ABOVE
    stile, lock, rail = 0.115, (0.86, 1.02), 0.13
    wood, panels = Mesh(), Mesh()
    for x in (-width, -stile):
        wood.join(box((x, low, -LEAF), (x + stile, high, 0), 0.0015, grain=1, shift=(0.3 * x, x)))
    inset = 0.0006  # rails lie a hair behind the stiles into which they run, so no two faces coincide
    for y0, y1 in ((low, low + 0.20), lock, (high - rail, high)):
        wood.join(box((-width + stile - 0.01, y0, -LEAF + inset), (-stile + 0.01, y1, -inset), 0.0015, grain=0,
                      shift=(y0, 0)))
    x0, x1 = -width + stile, -stile
    for k, (y0, y1) in enumerate(((low + 0.20, lock[0]), (lock[1], high - rail))):
        panels.join(box((x0 - 0.01, y0 - 0.01, -LEAF / 2 - 0.006), (x1 + 0.01, y1 + 0.01, -LEAF / 2 + 0.006), grain=1,
                        shift=(k * 0.37, 0.21)))
        field = box((x0 + 0.05, y0 + 0.05, -LEAF + 0.006), (x1 - 0.05, y1 - 0.05, -0.006), 0.008, grain=1,
                    shift=(k * 0.53, 0.11))
        panels.join(field)
        for z, s in ((-0.012, 1), (-LEAF + 0.012, -1)):  # moulding around the panel
            for a, b in (((x0, y0), (x1, y0)), ((x1, y0), (x1, y1)), ((x1, y1), (x0, y1)), ((x0, y1), (x0, y0))):
                wood.join(tube([(a[0], a[1], z), (b[0], b[1], z)], 0.009, 8, caps=False))
    return wood.join(panels)


def handle():
    """Plate and lever on both sides, in the leaf's own frame."""
    mesh = Mesh()
    x, y = -(OPENING - GAP_LATCH - GAP_HINGE) + 0.058, 1.02
    for z, s in ((0.0, 1), (-LEAF, -1)):
        low, high = sorted((z - s * 0.001, z + s * 0.005))
        mesh.join(box((x - 0.021, y - 0.115, low), (x + 0.021, y + 0.06, high), 0.002))
        neck = [(x, y, z), (x, y, z + s * 0.035), (x + 0.006, y, z + s * 0.048), (x + 0.022, y, z + s * 0.054),
                (x + 0.07, y + 0.002, z + s * 0.054),
                (x + 0.122, y - 0.003, z + s * 0.052)]
        mesh.join(tube(curve(neck, 6), 0.0085, 16))
        mesh.join(tube([(x, y - 0.075, z + s * 0.004), (x, y - 0.075, z + s * 0.007)], 0.008, 16))
    return mesh


def frame():
    """Lining, stops (hinge side and top only, so that light can pass at the latch), architraves on both sides.
    Opening coordinates: x = 0 at the latch side, hinge side at x = OPENING, front of the wall at z = 0."""
    wood, lip = Mesh(), 0.001
    back, front = -DEPTH - lip, lip
    for x in (-0.03, OPENING):
        wood.join(box((x, -0.01, back), (x + 0.03, HEIGHT + 0.03, front)))
    wood.join(box((-0.02, HEIGHT, back + 0.0005), (OPENING + 0.02, HEIGHT + 0.029, front - 0.0005)))
    stop = -LEAF - 0.001
    wood.join(box((OPENING - 0.015, -0.01, -DEPTH + 0.01), (OPENING + 0.01, HEIGHT + 0.01, stop), 0.002))
    wood.join(box((0, HEIGHT - 0.015, -DEPTH + 0.0105), (OPENING - 0.005, HEIGHT + 0.01, stop - 0.0004), 0.002))
    for low, high in ((0.0, 0.012), (-DEPTH - 0.018, -DEPTH)):
        for x in (-0.078, OPENING + 0.008):
            wood.join(box((x, -0.01, low), (x + 0.07, HEIGHT + 0.008, high), 0.004))
        wood.join(box((-0.084, HEIGHT + 0.008, low),
                      (OPENING + 0.084, HEIGHT + 0.082, high + (0.003 if low == 0 else 0)), 0.004))
    return wood


def hinges():
    mesh = Mesh()
    for y in (0.22, 1.05, 1.80):
        mesh.join(tube([(0.001, y, 0.006), (0.001, y + 0.09, 0.006)], 0.007, 12))
        mesh.join(tube([(0.001, y - 0.004, 0.006), (0.001, y + 0.094, 0.006)], 0.005, 12))
    return mesh
