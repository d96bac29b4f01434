"""Noisy FRFs of many points as CSV, for the size of a diagnosis page: python3 page_size.py > many.csv

Sixteen FRFs on 6,400 lines of two modes and rigid motion, one per cent of noise; the figures are in docs/records/2026-11-23-page.md.
"""

import random

random.seed(1)
NAMES = [f"{out}/{into}" for out in range(1, 5) for into in range(1, 5)]
SHAPES = [(0.4, [1, 1, 1, 1]), (0.3, [-1.2, -0.2, 0.4, 1.3]), (0.5, [1.0, -0.9, -0.8, 1.1]), (0.4, [1.0, -1.1, 1.0, -0.9])]
MODES = [(0.0, 0.0), (0.0, 0.0), (412.0, 0.003), (890.0, 0.003)]


def accelerance(f, out, into):
    s2 = -(f**2)
    return sum(
        g * shape[out] * shape[into] * s2 / (s2 + 2j * z * f0 * f + f0**2)
        for (g, shape), (f0, z) in zip(SHAPES, MODES)
    )


print("frequency [Hz]," + ",".join(f"{name} real,{name} imag" for name in NAMES))
for line in range(1, 6401):
    f, row = 0.5 * line, []
    for name in NAMES:
        value = accelerance(f, int(name[0]) - 1, int(name[2]) - 1)
        std = 0.01 * abs(value) + 0.003
        row += [f"{value.real + random.gauss(0, std):.8g}", f"{value.imag + random.gauss(0, std):.8g}"]
    print(f"{f:g}," + ",".join(row))
