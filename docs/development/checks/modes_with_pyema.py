#!/usr/bin/env python3
"""Natural frequencies and damping ratios of `jointscope modes` and of pyEMA on the same FRFs, side by side.

    python3 docs/development/checks/modes_with_pyema.py PROGRAM [RECORDINGS]

PROGRAM is the built binary. FRFs of known poles with 1 % noise (NumPy, seeded) are written by pyuff as one reference and four responses and analysed by both: bias and rms error of each over the seeds.
With RECORDINGS, the real free beam RECORDINGS/modelab-beam/frf.uff besides. pyEMA's poles are those of its stabilisation chart nearest to the true ones (on the beam: to the
expected ones), which it is told; jointscope is told nothing. Needs numpy, pyuff and pyEMA (pip install pyEMA).
"""
import contextlib
import io
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
import pyEMA
import pyuff

SEEDS = 20
TESTS = {
    "0.3 to 1 %": (2.5, 400, [(120.0, 0.003), (410.0, 0.006), (700.0, 0.01)]),
    "0.01 to 3 %": (2.5, 400, [(121.1, 1e-4), (411.0, 2e-4), (700.3, 0.03)]),
    "close pair": (2.5, 400, [(400.0, 0.005), (403.0, 0.005), (700.3, 0.01)]),
    "lines ten half-widths apart": (10.0, 100, [(123.0, 0.008), (412.0, 0.0024), (708.0, 0.0015)]),
    "fine lines": (0.25, 4000, [(120.0, 0.003), (410.0, 0.006), (700.0, 0.01)]),
}
SHAPES = np.array([[1.0, 0.2, -0.3, -0.9], [0.8, -0.7, 0.6, 0.9], [0.3, 0.7, 0.9, -0.5]])


def accelerances(lines, modes):
    s = 2j * np.pi * lines
    frfs = np.full((4, len(lines)), 0.5 + 0j)
    for (hz, ratio), shape in zip(modes, SHAPES):
        natural = 2 * np.pi * hz
        frfs += np.outer(shape * shape[0], s**2 / (s**2 + 2 * ratio * natural * s + natural**2))
    return frfs


def write(path, lines, frfs):
    sets = [{
        "type": 58, "func_type": 4, "binary": 1, "rsp_node": node, "rsp_dir": 2, "ref_node": 1, "ref_dir": 2,
        "data": frf, "x": lines, "ord_data_type": 6, "abscissa_spacing": 1,
        "id1": "pyema", "id2": "NONE", "id3": "NONE", "id4": "NONE", "id5": "NONE", "load_case_id": 0, "rsp_ent_name": "NONE", "ref_ent_name": "NONE",
        "num_pts": len(lines), "abscissa_min": lines[0], "abscissa_inc": lines[1] - lines[0], "z_axis_value": 0,
        "abscissa_spec_data_type": 18, "abscissa_axis_units_lab": "Hz",
        "ordinate_spec_data_type": 12, "ordinate_axis_units_lab": "m/s^2", "orddenom_spec_data_type": 13, "orddenom_axis_units_lab": "N",
    } for node, frf in enumerate(frfs, 1)]
    for one in sets:
        pyuff.UFF(str(path)).write_sets(one, "add")


def by_jointscope(program, path):
    run = subprocess.run([program, "modes", path, "--assume-units", "m/s^2,N", "--json"], capture_output=True, text=True)
    if run.returncode:
        raise SystemExit(run.stderr)
    return [(m["frequency"], m["damping_ratio"], m["std"]["frequency"], m["std"]["damping_ratio"]) for m in json.loads(run.stdout)["modes"]]


def by_pyema(lines, frfs, near, order):
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        model = pyEMA.Model(frfs, lines, lower=max(lines[0], 1.0), upper=lines[-1], pol_order_high=order, frf_type="accelerance")
        model.get_poles(show_progress=False)
        model.select_closest_poles(near)
    return list(zip(model.nat_freq, model.nat_xi))


def main(program, recordings=None):
    print(f"pyEMA {pyEMA.__version__}, {SEEDS} seeds a test, 1 % noise; errors in % of the half-width, frequency / damping ratio\n")
    print("| test | true pole | jointscope, bias | rms | pyEMA, bias | rms |")
    print("|---|---|---|---|---|---|")
    for name, (step, count, modes) in TESTS.items():
        lines = step * np.arange(1, count + 1)
        clean = accelerances(lines, modes)
        errors = {"jointscope": [], "pyEMA": []}
        for seed in range(SEEDS):
            random = np.random.default_rng(seed)
            noise = random.standard_normal(clean.shape) + 1j * random.standard_normal(clean.shape)
            frfs = clean * (1 + 0.01 * noise / np.sqrt(2))
            with tempfile.TemporaryDirectory() as folder:
                path = pathlib.Path(folder) / "t.uff"
                write(path, lines, frfs)
                ours = by_jointscope(program, path)
            if len(ours) != len(modes):
                print(f"({name}, seed {seed}: jointscope finds {len(ours)} modes)")
                continue
            theirs = by_pyema(lines, frfs, [hz for hz, _ in modes], 30)
            half = np.array([[hz * ratio, ratio] for hz, ratio in modes])
            errors["jointscope"].append((np.array([m[:2] for m in ours]) - modes) / half)
            errors["pyEMA"].append((np.array(theirs) - modes) / half)
        for index, (hz, ratio) in enumerate(modes):
            cells = []
            for who in ("jointscope", "pyEMA"):
                of = 100 * np.array(errors[who])[:, index, :]
                bias, rms = of.mean(axis=0), np.sqrt((of**2).mean(axis=0))
                cells += [f"{bias[0]:+.2f} / {bias[1]:+.2f}", f"{rms[0]:.2f} / {rms[1]:.2f}"]
            print(f"| {name} | {hz} Hz, {100 * ratio:g} % | " + " | ".join(cells) + " |")
    if recordings:
        beam(program, pathlib.Path(recordings) / "modelab-beam")


def beam(program, folder):
    expected = json.loads((folder / "expected.json").read_text())["frequencies_hz"]
    ours = by_jointscope(program, folder / "frf.uff")
    sets = pyuff.UFF(str(folder / "frf.uff")).read_sets()
    lines = np.array(sets[0]["x"])
    frfs = np.array([s["data"] for s in sets])
    print("\n| real beam | expected | jointscope | pyEMA, 9 FRFs at once, 20 Hz about each |")
    print("|---|---|---|---|")
    for index, (hz, ratio) in enumerate(zip(expected["measured_mean_of_9"], expected["damping_ratio"])):
        near = (lines > hz - 10) & (lines < hz + 10)
        (their_hz, their_ratio), = by_pyema(lines[near], frfs[:, near], [hz], 20)
        mode = ours[index]
        print(f"| {index + 1} | {hz:.3f} Hz, {100 * ratio:.5f} % | {mode[0]:.4f} ± {mode[2]:.4f} Hz, {100 * mode[1]:.5f} ± {100 * mode[3]:.5f} % "
              f"| {their_hz:.4f} Hz, {100 * their_ratio:.5f} % |")


if __name__ == "__main__":
    main(*sys.argv[1:])
