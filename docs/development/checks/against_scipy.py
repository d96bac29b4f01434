#!/usr/bin/env python3
"""Checks the program against NumPy, SciPy and pyuff on the shipped example.

    python3 docs/development/checks/against_scipy.py PROGRAM

(a) natural frequencies by scipy.linalg.eigh and FRFs by dense solution of -w^2 M + i w C + K against `synthesize`;
(b) eq (7) and the exact relation, line by line in NumPy, against `decompose`; (c) the variance formula of H1 estimates, and the standard
deviations of K and C against numerical derivatives on every line and a Monte Carlo on one. PROGRAM is the built binary. Ends with status 1
if a deviation is too large.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
import pyuff
import scipy.linalg
import scipy.optimize

EXAMPLE = pathlib.Path(__file__).resolve().parents[3] / "fixtures" / "glued-joint"
PAIRS = [(4, 1), (3, 1), (4, 2), (3, 2)]
failures = []


def report(what, value, limit):
    verdict = "ok" if value <= limit else "TOO LARGE"
    print(f"  {what:<72} {value:.2e}  {verdict}")
    if value > limit:
        failures.append(what)


def plain(entry):
    if isinstance(entry, dict):
        return entry["value"] if "value" in entry else {key: plain(value) for key, value in entry.items()}
    return [plain(value) for value in entry] if isinstance(entry, list) else entry


class Blocks:
    """Mass, damping and stiffness of two rigid blocks and a beam on (y2, θ2, y3, θ3), from the fixture's JSON."""

    def __init__(self):
        fixture = plain(json.loads((EXAMPLE / "fixture.json").read_text()))
        self.x = {int(name): point["x"] for name, point in fixture["points"].items()}
        self.length = self.x[3] - self.x[2]
        self.masses = []
        for body, x in (("A", self.x[2]), ("B", self.x[3])):
            block = fixture["bodies"][body]
            m, c = block["mass"], block["x_cg"] - x
            self.masses.append(np.array([[m, m * c], [m * c, block["inertia"] + m * c * c]]))
        beam, l = fixture["joints"]["J"]["beam"], self.length
        self.across = np.array([[1, l], [0, 1]])
        self.joint = beam["youngs_modulus"] * beam["second_moment"] / l**3 * np.array([[12, -6 * l], [-6 * l, 4 * l * l]])
        d = np.hstack([-self.across, np.eye(2)])
        self.K = d.T @ self.joint @ d
        self.M = scipy.linalg.block_diag(*self.masses)
        eigenvalues, shapes = scipy.linalg.eigh(self.K, self.M)
        self.hz = np.sqrt(np.maximum(eigenvalues, 0)) / (2 * np.pi)
        viscous = np.zeros(4)
        viscous[2:] = 2 * np.array(fixture["damping"]["modal_ratios"]) * np.sqrt(eigenvalues[2:])
        weighted = self.M @ shapes
        self.C = weighted @ np.diag(viscous) @ weighted.T

    def seat(self, point):
        block = 0 if point in (1, 2) else 1
        row = np.zeros(4)
        row[2 * block:2 * block + 2] = 1, self.x[point] - self.x[2 + block]
        return row

    def accelerance(self, hz, response, reference):
        w = 2 * np.pi * hz[:, None, None]
        dynamic = -w**2 * self.M + 1j * w * self.C + self.K
        moved = np.linalg.solve(dynamic, np.broadcast_to(self.seat(reference)[:, None], (len(hz), 4, 1)))
        return -(2 * np.pi * hz)**2 * (self.seat(response) @ moved)[:, 0]

    def h41(self, hz, frfs):
        """(y, θ) at 4 due to (force, moment) at 1, from accelerances in the order of PAIRS (eq 19-23)."""
        h = [frf / -(2 * np.pi * hz)**2 for frf in frfs]
        sensors, hits = self.x[4] - self.x[3], self.x[2] - self.x[1]
        rotations = (h[0] - h[1]) / sensors, (h[2] - h[3]) / sensors
        return np.stack([np.stack([h[0], (h[2] - h[0]) / hits], -1),
                         np.stack([rotations[0], (rotations[1] - rotations[0]) / hits], -1)], -2)

    def dynamic_joint(self, hz, frfs, relation):
        w2 = (2 * np.pi * hz)[:, None, None]**2
        near, far = (np.linalg.inv(mass) / -w2 for mass in self.masses)
        # A load at 1 is a load at 2 with another moment; the motion at 4 is that at 3 carried along.
        to_two = np.array([[1, 0], [self.x[1] - self.x[2], 1]])
        to_four = np.array([[1, self.x[4] - self.x[3]], [0, 1]])
        across = self.across if relation == "exact" else np.eye(2)
        through = across @ near @ to_two @ np.linalg.inv(self.h41(hz, frfs)) @ to_four @ far
        return np.linalg.inv(through - far - across @ near @ across.T)


def run(program, *arguments):
    subprocess.run([program, *arguments], check=True, capture_output=True)


def read(path):
    """Frequencies, FRFs and coherences by (response, reference), averages."""
    frfs, coherences, averages = {}, {}, None
    datasets = pyuff.UFF(str(path)).read_sets()
    for dataset in datasets if isinstance(datasets, list) else [datasets]:
        pair = int(dataset["rsp_node"]), int(dataset["ref_node"])
        hz = np.asarray(dataset["x"])
        if dataset["func_type"] == 4:
            frfs[pair] = np.asarray(dataset["data"], complex)
            averages = int(dataset["id5"].split()[1]) if dataset["id5"].startswith("averages") else averages
        else:
            coherences[pair] = np.real(dataset["data"])
    return hz, frfs, coherences, averages


def forward(program, blocks, folder):
    print("(a) synthesis")
    run(program, "synthesize", EXAMPLE / "fixture.json", "-o", folder / "f.uff")
    hz, frfs, *_ = read(folder / "f.uff")
    worst = max(np.max(np.abs(frfs[pair] / blocks.accelerance(hz, *pair) - 1)) for pair in PAIRS)
    report(f"FRFs by dense solution, 4 x {len(hz)} lines, largest relative", worst, 1e-9)
    for natural in blocks.hz[2:]:
        lines = f"{natural * 0.9995:.9g}:{natural * 1.0005:.9g}:{natural * 1e-6:.9g}"
        run(program, "synthesize", EXAMPLE / "fixture.json", "--frf", "4/1", "--lines", lines, "-o", folder / "p.uff")
        hz, frfs, *_ = read(folder / "p.uff")
        receptance = frfs[4, 1] / -(2 * np.pi * hz)**2
        peak = hz[np.argmax(np.abs(receptance))]
        report(f"peak of 4/1 against scipy.linalg.eigh, {natural:.4f} Hz, relative", abs(peak / natural - 1), 1e-4)


def backward(program, blocks, folder):
    print("(b) decomposition")
    hz, frfs, *_ = read(EXAMPLE / "hammer-test.uff")
    for relation in ("exact", "paper"):
        run(program, "decompose", EXAMPLE / "fixture.json", EXAMPLE / "hammer-test.uff", "--relation", relation, "-o", folder / relation)
        lines = json.loads((folder / relation / "stiffness.json").read_text())["lines"]
        expected = blocks.dynamic_joint(hz, [frfs[pair] for pair in PAIRS], relation)
        w = 2 * np.pi * hz[:, None, None]
        for name, part in (("stiffness", expected.real), ("damping", expected.imag / w)):
            found = np.array([line[name] for line in lines])
            scale = np.abs(expected) if name == "stiffness" else np.abs(expected) / w
            report(f"{relation}: {name}, {len(lines)} lines, largest relative to |k_ij(w)|", np.max(np.abs(found - part) / scale), 1e-7)
        assert len(lines) == len(hz)


def smoothed(accelerance, coherence, averages, half=25):
    """(1 - g2)/((n - 1) g2) |H|^2 fitted as S + N |H|^2 over 51 lines, weights of one over the square of the fit."""
    size = np.abs(accelerance)**2
    raw = (1 - coherence) / ((averages - 1) * coherence) * size
    windows = [slice(max(0, i - half), i + half + 1) for i in range(len(raw))]
    fit = np.array([raw[w].mean() for w in windows])
    for _ in range(3):
        fresh = np.empty_like(fit)
        for i, w in enumerate(windows):
            row = 1 / fit[w]
            design = np.stack([np.ones_like(size[w]), size[w]], -1) * row[:, None]
            floor, share = np.linalg.lstsq(design, raw[w] * row, rcond=None)[0]
            if floor < 0:
                floor, share = 0, np.sum(row**2 * raw[w] * size[w]) / np.sum(row**2 * size[w]**2)
            elif share < 0:
                floor, share = np.sum(row**2 * raw[w]) / np.sum(row**2), 0
            fresh[i] = floor + share * size[i]
        fit = fresh
    return fit * levels(raw / fit, 2 * (averages - 1))


def levels(ratio, degrees, told=150, shortest=4, fewest=8):
    """What variances show beside a slow fit, by the most likely exponential over so few lines as tell a level, too large in the mean by the few degrees of freedom that it has."""
    half = min(max(int(np.ceil(told / degrees / 2)), shortest), 25)
    at_line = np.ones_like(ratio)
    for i in range(len(ratio)):
        near = np.arange(max(0, i - half), min(len(ratio), i + half + 1))
        if len(near) < fewest:
            continue
        away, own = near - i, ratio[near]
        cost = lambda q: np.sum(q[0] + q[1] * away + own * np.exp(-q[0] - q[1] * away))
        level = scipy.optimize.minimize(cost, [np.log(own.mean()), 0.0], tol=1e-10).x[0]
        total = degrees * len(near)
        at_line[i] = np.exp(level) * total / (total - 2)
    return at_line


def noise(program, blocks, folder):
    print("(c) noise")
    random = np.random.default_rng(1)
    normal = lambda *shape: (random.standard_normal(shape) + 1j * random.standard_normal(shape)) / np.sqrt(2)
    truth, runs = 2 - 1j, 200_000
    for n in (5, 8, 20):
        force = 1 + 0.2 * normal(runs, n)
        response = truth * force + 0.3 * normal(runs, n)
        xx, yy = np.sum(np.abs(force)**2, 1), np.sum(np.abs(response)**2, 1)
        xy = np.sum(response * force.conj(), 1)
        h1, g2 = xy / xx, np.abs(xy)**2 / (xx * yy)
        ratio = np.mean((1 - g2) / ((n - 1) * g2) * np.abs(h1)**2) / np.mean(np.abs(h1 - truth)**2)
        report(f"variance formula, {n} averages, mean against scatter of H1, |ratio - 1|", abs(ratio - 1), 0.02)
    hz, frfs, coherences, averages = read(EXAMPLE / "hammer-test.uff")
    values = np.array([frfs[pair] for pair in PAIRS])
    variance = np.array([smoothed(frfs[pair], coherences[pair], averages) for pair in PAIRS])
    lines = json.loads((folder / "exact" / "stiffness.json").read_text())["lines"]
    # Derivatives by central differences: the map from FRFs to k is analytic, so real steps are enough.
    total = np.zeros((len(hz), 2, 2))
    for index in range(4):
        step = np.zeros_like(values)
        step[index] = 1e-6 * np.abs(values[index])
        slope = blocks.dynamic_joint(hz, values + step, "exact") - blocks.dynamic_joint(hz, values - step, "exact")
        total += np.abs(slope / (2 * step[index].real)[:, None, None])**2 * variance[index][:, None, None]
    expected = np.sqrt(total / 2)
    found = np.array([line["std"]["stiffness"] for line in lines])
    report("std of K by derivatives, all lines and elements, largest relative", np.max(np.abs(found / expected - 1)), 1e-3)
    calm = [line for line in range(len(hz)) if not lines[line]["noisy"]]
    line = min(calm, key=lambda i: np.max(found[i] / np.abs(lines[i]["stiffness"])))
    w = 2 * np.pi * hz[line]
    # The propagation is of first order: a tenth of the noise shows that order alone, the noise itself what it leaves out.
    for share, limit in ((0.1, 0.01), (1.0, 0.1)):
        draws = values[:, line, None] + share * np.sqrt(variance[:, line, None]) * normal(4, 100_000)
        k = blocks.dynamic_joint(np.full(100_000, hz[line]), draws, "exact")
        for name, spread in (("stiffness", np.std(k.real, 0)), ("damping", np.std(k.imag / w, 0))):
            worst = np.max(np.abs(share * np.array(lines[line]["std"][name]) / spread - 1))
            report(f"std of {name} at {hz[line]:g} Hz, 100,000 draws, {share:g} of the noise, relative", worst, limit)


def main():
    program, blocks = pathlib.Path(sys.argv[1]).resolve(), Blocks()
    with tempfile.TemporaryDirectory() as folder:
        for check in (forward, backward, noise):
            check(program, blocks, pathlib.Path(folder))
    print(f"{len(failures)} failures")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
