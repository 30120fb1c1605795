"""Pictures for Ajar's scenes: PNG and Radiance HDR writers, tileable noise. Standard library only."""
import math
import random
import struct
import zlib


def write_png(path, width, height, pixel, channels=3):
    """pixel(x, y) -> `channels` numbers in [0, 1], stored as they are (sRGB code values); row 0 on top."""
    rows, previous = [], bytes(width * channels)
    for y in range(height):
        row = bytearray()
        for x in range(width):
            value = pixel(x, y)
            row += bytes(max(0, min(255, int(c * 255 + 0.5))) for c in ((value,) if channels == 1 else value))
        best = None
        for kind in range(3):  # none, sub, up: whichever leaves the smallest sum
            if kind == 0:
                data = bytes(row)
            elif kind == 1:
                data = bytes((row[i] - (row[i - channels] if i >= channels else 0)) & 255 for i in range(len(row)))
            else:
                data = bytes((row[i] - previous[i]) & 255 for i in range(len(row)))
            cost = sum(b if b < 128 else 256 - b for b in data)
            if best is None or cost < best[0]:
                best = (cost, bytes([kind]) + data)
        rows.append(best[1])
        previous = bytes(row)

    def chunk(name, data):
        return struct.pack('>I', len(data)) + name + data + struct.pack('>I', zlib.crc32(name + data))

    head = struct.pack('>IIBBBBB', width, height, 8, {1: 0, 3: 2, 4: 6}[channels], 0, 0, 0)
    with open(path, 'wb') as out:
        out.write(b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', head) + chunk(b'IDAT',
                                                                      zlib.compress(b''.join(rows),
                                                                                    9)) + chunk(b'IEND', b''))


def write_hdr(path, width, height, pixel):
    """pixel(x, y) -> linear RGB of any size; Radiance RGBE, run-length encoded rows."""
    def rgbe(c):
        peak = max(c)
        if peak < 1e-32:
            return (0, 0, 0, 0)
        mantissa, exponent = math.frexp(peak)
        k = mantissa * 256 / peak
        return (int(c[0] * k), int(c[1] * k), int(c[2] * k), exponent + 128)

    def packed(values):
        """Runs of equal bytes as (128 + n, value), the rest literally."""
        out, i = bytearray(), 0
        while i < len(values):
            run = 1
            while i + run < len(values) and run < 127 and values[i + run] == values[i]:
                run += 1
            if run >= 3:
                out += bytes((128 + run, values[i]))
                i += run
                continue
            j = i
            while j < len(values) and j - i < 128 and (j + 2 >= len(values) or len(set(values[j:j + 3])) > 1):
                j += 1
            out += bytes((j - i,)) + bytes(values[i:j])
            i = j
        return bytes(out)

    with open(path, 'wb') as out:
        out.write(f'#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n'.encode('ascii'))
        for y in range(height):
            row = [rgbe(pixel(x, y)) for x in range(width)]
            out.write(bytes((2, 2, width >> 8, width & 255)))
            for c in range(4):
                out.write(packed([p[c] for p in row]))


def noise(seed, cells_x, cells_y):
    """Tileable value noise with values in [0, 1]; period 1 in u and v, cells_x × cells_y lattice cells."""
    rng = random.Random(seed)
    table = [[rng.random() for _ in range(cells_x)] for _ in range(cells_y)]

    def at(u, v):
        x, y = u * cells_x, v * cells_y
        i, j = math.floor(x), math.floor(y)
        a, b = x - i, y - j
        a, b = a * a * (3 - 2 * a), b * b * (3 - 2 * b)
        top, low = table[j % cells_y], table[(j + 1) % cells_y]
        i0, i1 = i % cells_x, (i + 1) % cells_x
        return (top[i0] * (1 - a) + top[i1] * a) * (1 - b) + (low[i0] * (1 - a) + low[i1] * a) * b

    return at


def fractal(seed, cells_x, cells_y, octaves):
    """Sum of octaves of tileable noise, values in [0, 1]."""
    layers = [(noise(seed + k, cells_x << k, cells_y << k), 0.5 ** k) for k in range(octaves)]
    total = sum(w for _, w in layers)
    return lambda u, v: sum(f(u, v) * w for f, w in layers) / total


def mix(a, b, t):
    return tuple(x + (y - x) * t for x, y in zip(a, b))


def smooth(low, high, x):
    t = max(0.0, min(1.0, (x - low) / (high - low)))
    return t * t * (3 - 2 * t)
