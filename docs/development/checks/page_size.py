"""FRFs of a universal file in ASCII with one per cent of noise, as CSV: python3 page_size.py many.uff > many.csv

For the size of a diagnosis's page; commands and figures are in docs/records/2026-11-23-page.md.
"""

import random
import re
import sys

random.seed(1)
frfs = {}
for dataset in re.split(r"^    -1\n", open(sys.argv[1]).read(), flags=re.M):
    lines = dataset.splitlines()
    if len(lines) < 13 or lines[0].strip() != "58":
        continue
    channels, axis = lines[6].split(), lines[7].split()
    first, step = float(axis[3]), float(axis[4])
    values = [float(word) for line in lines[12:] for word in line.split()]
    frfs[f"{channels[-5]}/{channels[-2]}"] = [complex(*pair) for pair in zip(values[::2], values[1::2])]

print("frequency [Hz]," + ",".join(f"{name} real,{name} imag" for name in frfs))
for line, at_line in enumerate(zip(*frfs.values())):
    row = []
    for value in at_line:
        std = 0.01 * abs(value) + 0.003
        row += [f"{value.real + random.gauss(0, std):.8g}", f"{value.imag + random.gauss(0, std):.8g}"]
    print(f"{first + step * line:g}," + ",".join(row))
