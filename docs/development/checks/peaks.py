#!/usr/bin/env python3
"""Frequencies of the peaks of a synthesized FRF.

    python3 docs/development/checks/peaks.py PROGRAM FIXTURE OUT/IN FREQUENCY ...

Near each FREQUENCY (Hz) the FRF is synthesized on ever finer lines; printed is where the largest magnitude lies, to 1e-5 of the frequency.
PROGRAM is the built binary. Needs numpy and pyuff.
"""
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
import pyuff


def magnitude(program, fixture, frf, start, stop, step):
    with tempfile.TemporaryDirectory() as folder:
        output = pathlib.Path(folder) / "f.uff"
        subprocess.run([program, "synthesize", fixture, "--frf", frf, "--lines", f"{start:.9g}:{stop:.9g}:{step:.9g}", "-o", output],
                       check=True, capture_output=True)
        dataset = pyuff.UFF(str(output)).read_sets(0)
    return np.asarray(dataset["x"]), np.abs(dataset["data"])


def main():
    program, fixture, frf, *near = sys.argv[1:]
    for frequency in map(float, near):
        centre = frequency
        for width in (2e-2, 2e-3, 2e-4):
            lines, size = magnitude(program, fixture, frf, centre * (1 - width), centre * (1 + width), centre * width / 40)
            at = int(np.argmax(size))
            if at in (0, len(lines) - 1):
                sys.exit(f"no peak within 2 % of {frequency} Hz")
            centre = lines[at]
        print(f"{frequency:10.3f} -> {centre:10.4f} Hz")


if __name__ == "__main__":
    main()
