#!/usr/bin/env python3
"""The mode indicator (CMIF) of `jointscope modes` and `jointscope check` against NumPy's singular values of the same FRFs.

    python3 docs/development/checks/indicator_with_numpy.py PROGRAM

PROGRAM is the built binary. FRFs of three responses to three references with 2 % noise, two of the modes closer than their widths, and one FRF more than the matrix, are written as a table
and analysed; the curves are those that `--also csv` writes. Ends with status 1 where one departs by more than 1e-10 of itself. Needs numpy.
"""
import csv
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

LINES = np.arange(20.0, 420.0, 0.5)
# Hz, damping ratio, shape at nodes 1, 2, 3, 4.
MODES = [(120.0, 0.01, [1.0, 0.4, -0.7, 0.2]), (121.0, 0.012, [0.6, -0.9, 0.5, 0.3]), (300.0, 0.008, [0.8, 0.7, 0.9, -0.4])]
FIXTURE = {
    "name": "a block on springs",
    "bodies": {"A": {"mass": 2.0, "inertia": 4e-3, "x_cg": 0.0}},
    "points": {str(node): {"body": "A", "x": 0.05 * (node - 2)} for node in (1, 2, 3, 4)},
    "supports": {"left": {"body": "A", "x": -0.05, "stiffness": 6e5}, "right": {"body": "A", "x": 0.05, "stiffness": 8e5}},
    "damping": {"modal_ratios": [0.01, 0.01]},
}
MATRIX = [(response, reference) for response in (1, 2, 3) for reference in (1, 2, 3)]
PAIRS = MATRIX + [(4, 1)]


def accelerances():
    s, random = 2j * np.pi * LINES, np.random.default_rng(5)
    frfs = {}
    for response, reference in PAIRS:
        value = np.zeros(len(LINES), complex)
        for hz, ratio, shape in MODES:
            natural = 2 * np.pi * hz
            value += shape[response - 1] * shape[reference - 1] * s**2 / (s**2 + 2 * ratio * natural * s + natural**2)
        noise = random.standard_normal(len(LINES)) + 1j * random.standard_normal(len(LINES))
        frfs[response, reference] = value * (1 + 0.02 * noise)
    return frfs


def write(path, frfs):
    with open(path, "w") as file:
        names = [f"{response}/{reference} {part} [m/s^2/N]" for response, reference in frfs for part in ("real", "imag")]
        print("frequency [Hz]", *names, sep=",", file=file)
        for line, hz in enumerate(LINES):
            print(repr(float(hz)), *(repr(float(part)) for frf in frfs.values() for part in (frf[line].real, frf[line].imag)), sep=",", file=file)


def curves(folder):
    """Frequencies and columns of the indicator's curves by heading."""
    (path,) = folder.glob("curves/*mode-indicator*.csv")
    with open(path) as file:
        head, *rows = csv.reader(file)
    return {name: np.array([float(row[place] or "nan") for row in rows]) for place, name in enumerate(head)}


def main(program):
    frfs = accelerances()
    matrix = np.array([[frfs[response, reference] for reference in (1, 2, 3)] for response in (1, 2, 3)]).transpose(2, 0, 1)
    expected = np.linalg.svd(matrix, compute_uv=False)
    worst = 0.0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write(folder / "frfs.csv", frfs)
        (folder / "fixture.json").write_text(json.dumps(FIXTURE))
        for command in (["modes", "frfs.csv", "-o", "modes"], ["check", "fixture.json", "frfs.csv", "-o", "check"]):
            run = subprocess.run([program, *command, "--also", "csv"], cwd=folder, capture_output=True, text=True)
            if run.returncode:
                raise SystemExit(run.stderr)
            found = curves(folder / command[-1])
            assert np.array_equal(found["Frequency [Hz]"], LINES)
            for place, symbol in enumerate("₁₂₃"):
                curve = found[f"σ{symbol} measured [(m/s^2)/N]"]
                departure = np.max(np.abs(curve / expected[:, place] - 1))
                worst = max(worst, departure)
                print(f"{command[0]:6} σ{symbol}: {curve.min():.3e} to {curve.max():.3e}, largest departure from NumPy's {departure:.1e}")
    print("largest departure", f"{worst:.1e}")
    return int(worst > 1e-10)


if __name__ == "__main__":
    sys.exit(main(str(pathlib.Path(sys.argv[1]).resolve())))
