#!/usr/bin/env python3
"""The lumped model (SIM) against the finite-element twin, and what the diagnosis says of the difference.

    python3 docs/development/checks/sim_against_fem.py PROGRAM [EXAMPLE ...]

For each of the paper's inferred fixtures: frequencies of SIM, of the twin, of the twin with one of the things switched off that SIM leaves
out, and with all of them; the four FRFs of the twin with 1 % noise diagnosed with the SIM fixture; the findings that were left beside the
ranking. PROGRAM is the built binary. No pass or fail: docs/guide/solid.md has the figures.
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np
import pyuff

ROOT = pathlib.Path(__file__).resolve().parents[3] / "fixtures" / "paper"
PROGRAM = str(pathlib.Path(sys.argv[1]).resolve())
EXAMPLES = sys.argv[2:] or ["D0", "E0", "F01", "F02"]
THINGS = ["joint-mass", "shear", "plate-action", "block-flexibility"]


def run(folder, *words):
    done = subprocess.run([PROGRAM, *map(str, words)], cwd=folder, capture_output=True, text=True)
    if done.returncode:
        sys.exit(done.stderr)
    return done.stdout


def frequencies(text):
    return [float(value) for value in re.findall(r"mode \d+: ([\d.]+) Hz, transverse", text)][:2]


def lumped_frequencies(example):
    """Two rigid blocks and an Euler beam, from the fixture's numbers."""
    f = json.loads((ROOT / f"{example}.json").read_text())
    x2, x3 = f["points"]["2"]["x"], f["points"]["3"]["x"]
    beam, length = f["joints"]["J"]["beam"], x3 - x2
    ei = beam["youngs_modulus"] * beam["second_moment"]
    masses = np.zeros((4, 4))
    for i, (body, x) in enumerate((("A", x2), ("B", x3))):
        b = f["bodies"][body]
        c = b["x_cg"] - x
        masses[2 * i : 2 * i + 2, 2 * i : 2 * i + 2] = [[b["mass"], b["mass"] * c], [b["mass"] * c, b["inertia"] + b["mass"] * c * c]]
    d = np.array([[-1, -length, 1, 0], [0, -1, 0, 1]])
    k = ei / length**3 * np.array([[12, -6 * length], [-6 * length, 4 * length**2]])
    values = np.sort(np.linalg.eigvals(np.linalg.solve(masses, d.T @ k @ d)).real)
    return np.sqrt(values[2:]) / (2 * np.pi)


def noisy(source, target, share, seed):
    random = np.random.default_rng(seed)
    sets = []
    for s in pyuff.UFF(str(source)).read_sets():
        noise = random.standard_normal(len(s["data"])) + 1j * random.standard_normal(len(s["data"]))
        data = s["data"] + share / np.sqrt(2) * np.abs(s["data"]) * noise
        sets.append(pyuff.prepare_58(
            binary=0, func_type=4, rsp_node=s["rsp_node"], rsp_dir=2, ref_node=s["ref_node"], ref_dir=2, data=data, x=s["x"], id1="noisy",
            rsp_ent_name="NONE", ref_ent_name="NONE", abscissa_spacing=1, abscissa_spec_data_type=18, ordinate_spec_data_type=12,
            orddenom_spec_data_type=13))
    pyuff.UFF(str(target)).write_sets(sets, "add")


for example in EXAMPLES:
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        fixture = ROOT / f"{example}.json"
        sim = lumped_frequencies(example)
        full = frequencies(run(folder, "fem", fixture, "-o", "fem.uff"))
        print(f"{example}: SIM {sim[0]:.2f} {sim[1]:.2f} Hz; FEM {full[0]:.2f} {full[1]:.2f} Hz "
              f"({100 * (full[0] / sim[0] - 1):+.2f} % {100 * (full[1] / sim[1] - 1):+.2f} %)")
        effects = []
        for thing in THINGS:
            one = frequencies(run(folder, "fem", fixture, "--without", thing, "-o", "one.uff"))
            change = [100 * (b / a - 1) for a, b in zip(one, full)]
            effects.append((max(map(abs, change)), thing, change))
        for _, thing, change in sorted(effects, reverse=True):
            print(f"  {thing:<18} changes the two frequencies by {change[0]:+.2f} % {change[1]:+.2f} %")
        bare = frequencies(run(folder, "fem", fixture, "--without", *THINGS, "-o", "bare.uff"))
        print(f"  without all four the twin is {100 * (bare[0] / sim[0] - 1):+.2f} % {100 * (bare[1] / sim[1] - 1):+.2f} % off SIM")
        noisy(folder / "fem.uff", folder / "noisy.uff", 0.01, 1)
        for more in ((), ("--exact",)):
            text = run(folder, "diagnose", fixture, "noisy.uff", "--assume-units", "m/s^2,N", *more, "-o", "out")
            d = json.loads((folder / "out" / "diagnosis.json").read_text())
            chi2, nrmse = d["fit"]["chi2_per_dof"], d["fit"]["nrmse"]
            print(f"  diagnose {' '.join(more)}: {d['verdict']}; chi2/dof {chi2['nominal']:.3g} {chi2['refitted']:.3g} {chi2['repaired']:.3g}; "
                  f"nrmse {nrmse['nominal']:.3g} {nrmse['refitted']:.3g} {nrmse['repaired']:.3g}")
            for finding in d["findings"]:
                number = lambda value, form: "unknown" if value is None else format(value, form)
                values = ", ".join(
                    f"{key} {number(p['value'], '.4g')} ± {number(p['std'], '.2g')} {p['unit']}" for key, p in finding["parameters"].items())
                others = "; ".join(f"{a['kind']} {a['place']} {a['probability']:.2f}" for a in finding["alternatives"][:4])
                print(f"    {finding['kind']} at {finding['place']} {finding.get('dof') or ''} (p {finding['probability']:.2f}): {values}"
                      + (f" [or {others}]" if others else ""))
