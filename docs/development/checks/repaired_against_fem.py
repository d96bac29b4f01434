#!/usr/bin/env python3
"""How much closer to the finite-element twin the repaired lumped model comes than the refitted one, FRF by FRF.

    python3 docs/development/checks/repaired_against_fem.py PROGRAM [EXAMPLE ...] [--seeds 1,2] [--noise 0.01] [--options "--exact"] [--keep DIR]

For each of the paper's inferred fixtures and each seed: the twin's four FRFs (`jointscope fem`) with noise of 1 % of each value (or --noise) and the coherence of eight averages,
`jointscope diagnose` with the SIM fixture, `jointscope synthesize` of refitted.json and repaired.json, and their errors against the twin's FRFs
*without* noise on all lines up to 5 % above the second elastic frequency: rms of the difference over rms of the FRF, and rms of the difference of
levels in dB. "noise" is the error of the noisy recording itself, below which nothing need come. PROGRAM is the built binary. No pass or fail:
docs/guide/solid.md has the figures.
"""
import json
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import time

import numpy as np
import pyuff

ROOT = pathlib.Path(__file__).resolve().parents[3] / "fixtures" / "paper"
AVERAGES = 8


def option(name, default):
    if name not in sys.argv:
        return default
    place = sys.argv.index(name)
    value = sys.argv[place + 1]
    del sys.argv[place : place + 2]
    return value


SEEDS = [int(seed) for seed in option("--seeds", "1,2").split(",")]
OPTIONS = shlex.split(option("--options", ""))
NOISE = float(option("--noise", "0.01"))
KEEP = option("--keep", None)
PROGRAM = str(pathlib.Path(sys.argv[1]).resolve())
EXAMPLES = sys.argv[2:] or ["D0", "E0", "F01", "F02"]


def run(folder, *words):
    done = subprocess.run([PROGRAM, *map(str, words)], cwd=folder, capture_output=True, text=True)
    if done.returncode:
        sys.exit(done.stderr)
    return done.stdout


def read(path):
    """Lines in Hz, and the FRFs by name, as accelerances."""
    sets = [s for s in pyuff.UFF(str(path)).read_sets() if s["func_type"] == 4]
    return sets[0]["x"], {f"{s['rsp_node']}/{s['ref_node']}": s["data"] for s in sets}


def recorded(hz, frfs, path, seed):
    """Eight averages of each FRF, every response off by a random share of itself: their mean is off by NOISE; H1 and its coherence."""
    random = np.random.default_rng(seed)
    sets = []
    for name, values in frfs.items():
        response, reference = map(int, name.split("/"))
        shape = (AVERAGES, len(values))
        noise = (random.standard_normal(shape) + 1j * random.standard_normal(shape)) * NOISE * np.sqrt(AVERAGES / 2)
        responses = values * (1 + noise)
        h1 = responses.mean(axis=0)
        coherence = np.abs(h1) ** 2 / (np.abs(responses) ** 2).mean(axis=0)
        common = dict(binary=0, rsp_node=response, rsp_dir=2, ref_node=reference, ref_dir=2, x=hz, id1="the twin with noise",
                      id5=f"averages {AVERAGES}", rsp_ent_name="NONE", abscissa_spacing=1, abscissa_spec_data_type=18)
        sets.append(pyuff.prepare_58(func_type=4, data=h1, ordinate_spec_data_type=12, orddenom_spec_data_type=13,
                                    ordinate_axis_units_lab="m/s^2", orddenom_axis_units_lab="N", **common))
        sets.append(pyuff.prepare_58(func_type=6, data=coherence, ordinate_spec_data_type=1, orddenom_spec_data_type=0, **common))
    pyuff.UFF(str(path)).write_sets(sets, "overwrite")


def errors(found, true):
    """Rms of the difference over rms, and rms of the difference of levels in dB."""
    share = np.sqrt(np.mean(np.abs(found - true) ** 2) / np.mean(np.abs(true) ** 2))
    return share, np.sqrt(np.mean((20 * np.log10(np.abs(found) / np.abs(true))) ** 2))


def findings(diagnosis):
    for finding in diagnosis["findings"]:
        values = []
        for key, p in finding["parameters"].items():
            std = "unknown" if p["std"] is None else f"{p['std']:.2g}"
            values.append(f"{key} {p['value']:.4g} ± {std} {p['unit']}")
        others = "; ".join(f"{a['kind']} {a['place']} {a['probability']:.2f}" for a in finding["alternatives"][:6])
        yield (f"{finding['kind']} at {finding['place']} {finding.get('dof') or ''} (p {finding['probability']:.2f}): {', '.join(values)}"
               + (f" [or {others}]" if others else ""))


def compare(example, seed, folder):
    fixture = ROOT / f"{example}.json"
    said = run(folder, "fem", fixture, "-o", "fem.uff")
    second = [float(value) for value in re.findall(r"mode \d+: ([\d.]+) Hz, transverse", said)][1]
    hz, true = read(folder / "fem.uff")
    recorded(hz, true, folder / "noisy.uff", seed)
    begun = time.perf_counter()
    run(folder, "diagnose", fixture, "noisy.uff", *OPTIONS, "-o", "out")
    seconds = time.perf_counter() - begun
    diagnosis = json.loads((folder / "out" / "diagnosis.json").read_text())
    chi2 = diagnosis["fit"]["chi2_per_dof"]
    print(f"{example}, seed {seed}{' ' + ' '.join(OPTIONS) if OPTIONS else ''}: {diagnosis['verdict']} after {seconds:.1f} s; chi2/dof "
          f"{chi2['nominal']:.3g} {chi2['refitted']:.4g} {chi2['repaired']:.3g}")
    for text in findings(diagnosis):
        print(f"  {text}")
    models = {}
    for name in ("refitted", "repaired"):
        # Those of a perfect instrument: what the recording's channels do is no part of the structure.
        run(folder, "synthesize", f"out/{name}.json", "--perfect", "--lines", f"{hz[0]}:{hz[-1]}:{hz[1] - hz[0]}", "-o", f"{name}.uff")
        models[name] = read(folder / f"{name}.uff")[1]
    models["noise"] = read(folder / "noisy.uff")[1]
    used = hz <= 1.05 * second
    print(f"  up to {hz[used][-1]} Hz (second elastic mode {second:.1f} Hz):  rms error, %: refitted repaired ratio noise | level, dB: the same")
    for name, values in true.items():
        of = {model: errors(frfs[name][used], values[used]) for model, frfs in models.items()}
        text = [f"  {name}"]
        for which, scale in ((0, 100), (1, 1)):
            refitted, repaired, noise = (of[m][which] * scale for m in ("refitted", "repaired", "noise"))
            text.append(f"{refitted:9.3f} {repaired:8.4f} {refitted / repaired:7.1f} {noise:7.3f}")
        print(" | ".join(text), flush=True)
    return {model: {name: frfs[name][used] for name in true} for model, frfs in models.items() if model != "noise"}


def scatter(of_seeds):
    """By how much a model's FRFs differ from seed to seed: the part of its error that is noise."""
    for name in of_seeds[0]["refitted"]:
        shares = []
        for model in ("refitted", "repaired"):
            values = np.array([models[model][name] for models in of_seeds])
            variance = np.mean(np.abs(values - values.mean(axis=0)) ** 2) * len(values) / (len(values) - 1)
            shares.append(100 * np.sqrt(variance / np.mean(np.abs(values.mean(axis=0)) ** 2)))
        print(f"  {name} from seed to seed, rms, %: refitted {shares[0]:.3f} repaired {shares[1]:.3f}", flush=True)


for example in EXAMPLES:
    of_seeds = []
    for seed in SEEDS:
        if KEEP:
            folder = pathlib.Path(KEEP) / f"{example}-{seed}"
            folder.mkdir(parents=True, exist_ok=True)
            of_seeds.append(compare(example, seed, folder))
        else:
            with tempfile.TemporaryDirectory() as name:
                of_seeds.append(compare(example, seed, pathlib.Path(name)))
    if len(of_seeds) > 1:
        scatter(of_seeds)
