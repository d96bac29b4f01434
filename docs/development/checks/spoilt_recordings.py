"""What a diagnosis makes of recordings that hold something no structure's model has.

Two blocks on a strip, drawn once from their tolerances, with nothing or one thing left out, are synthesized by the program; NumPy then spoils each recording in one of seven ways and adds
noise of 0.1 % with the coherence that says so, or adds the noise and files the recording in one of seven wrong ways. One line a diagnosis: verdict, processor time, names.

    python3 docs/development/checks/spoilt_recordings.py PROGRAM [--only WORD …]

Needs numpy and pyuff.
"""

import argparse
import json
import os
import pathlib
import resource
import shutil
import subprocess
import sys
import tempfile

import numpy as np
import pyuff

FRFS = ["3/1", "4/1", "3/2", "4/2"]
LINES = "20:1092.5:1.25"
NOISE, AVERAGES = 1e-3, 10

HIDDEN = {
    "null": [],
    "lump": [{"kind": "added_mass", "place": "B", "x": 0.12, "mass": 0.06}],
    "ground": [{"kind": "support", "place": "B", "x": 0.11, "stiffness": 1.65e5}],
    "glue": [{"kind": "interface_compliance", "place": "3", "dof": "rotation", "stiffness": 6000.0}],
    "delay": [{"kind": "channel_delay", "place": "response 4", "seconds": 2e-5}],
}


def fixture():
    known = lambda value, relative: {"value": value, "std": relative * abs(value)}
    placed = lambda x: {"value": x, "std": 2e-4}
    block = lambda mass, inertia, x: {"mass": known(mass, 0.002), "inertia": known(inertia, 0.01), "x_cg": placed(x)}
    return {
        "bodies": {"A": block(1.1, 9.5e-4, -0.03), "B": block(1.2, 9.9e-4, 0.095)},
        "points": {
            "1": {"body": "A", "x": placed(-0.06)},
            "2": {"body": "A", "x": placed(0.0)},
            "3": {"body": "B", "x": placed(0.065)},
            "4": {"body": "B", "x": placed(0.125)},
        },
        "joints": {"J": {"from": "2", "to": "3", "beam": {"youngs_modulus": known(2.07e11, 0.01), "second_moment": known(3.67e-10, 0.01)}}},
        "damping": {"modal_ratios": [{"value": 0.004, "std": 6e-4}, {"value": 0.006, "std": 9e-4}]},
    }


def true_structure(hidden):
    """The fixture as a structure has it: quantities off by chance, and what is hidden."""
    random = np.random.default_rng(5)
    truth = fixture()
    for body in truth["bodies"].values():
        for quantity in body.values():
            quantity["value"] += 0.7 * quantity["std"] * random.normal()
    truth["joints"]["J"]["beam"]["youngs_modulus"]["value"] *= 1 + 0.007 * random.normal()
    truth["damping"]["modal_ratios"][0]["value"] *= 1.15
    return {**truth, "physics": hidden}


# --- what spoils a recording: of values h at frequencies x, between points o and i, the FRFs' rms being `size` ------------------------------------------------------

def ripple(h, x, o, i, random, size):
    """Half a per cent, as reflections and leakage make it."""
    return h * (1 + 0.005 * np.cos(2 * np.pi * x / 23 + random.uniform(0, 6)))


def other_plane(h, x, o, i, random, size):
    """A mode out of the plane, seen by sensors and blows that are not quite in it."""
    seen = {"1": 0.3, "2": -0.1, "3": 0.25, "4": 0.4}
    s, natural = 2j * np.pi * x, 2 * np.pi * 377.0
    return h + 0.06 * size * seen[o] * seen[i] * s**2 / (natural**2 + 2 * 0.003 * natural * s + s**2)


def gains(h, x, o, i, random, size):
    """Each record by 3 %."""
    return h * (1 + 0.03 * random.normal())


def roving(h, x, o, i, random, size):
    """A sensor that is carried from point to point: resonances 0.3 % apart."""
    shifted = x * {"3": 1.0015, "4": 0.9985}[o]
    return np.interp(shifted, x, h.real) + 1j * np.interp(shifted, x, h.imag)


def low_noise(h, x, o, i, random, size):
    """Noise that grows to 8 % at the lowest line, of which the coherence says nothing."""
    noise = random.normal(size=len(x)) + 1j * random.normal(size=len(x))
    return h * (1 + 0.03 * noise * (40 / x) ** 1.5)


def offset(h, x, o, i, random, size):
    """A constant on all FRFs."""
    return h + 4e-4 * size * (1 + 0.3j)


def phase(h, x, o, i, random, size):
    """A hundredth of a radian between force and response."""
    return h * np.exp(0.01j)


# --- how a recording is filed: values and lines of noisy ones, the FRF being the `n`-th ----------------------------------------------------------------------------

def gap(h, x, n):
    """One FRF exactly zero on twenty lines, as pyuff writes NaN."""
    return np.where((n == 0) & (np.abs(np.arange(len(x)) - 210) < 10), 0, h), x


def padded(h, x, n):
    """All FRFs exactly zero from 850 Hz on, as of an analyser that exports the band its filters pass."""
    return np.where(x >= 850, 0, h), x


def shorter(h, x, n):
    """One FRF without the lines from 850 Hz on."""
    return (h[x < 850], x[x < 850]) if n == 1 else (h, x)


def magnitude(h, x, n):
    """One FRF without its phase."""
    return np.abs(h) + 0j if n == 1 else h, x


def degrees(h, x, n):
    """Magnitude and phase in degrees for real and imaginary part."""
    return np.abs(h) + 1j * np.degrees(np.angle(h)), x


def decibels(h, x, n):
    """Level in dB and phase in radians for real and imaginary part."""
    return 20 * np.log10(np.abs(h)) + 1j * np.angle(h), x


def one_value(h, x, n):
    """A value of one FRF a hundred times what it is."""
    return np.where((n == 1) & (np.arange(len(x)) == 333), 100 * h, h), x


FILED = {f.__name__: f for f in [gap, padded, shorter, magnitude, degrees, decibels, one_value]}
SPOILT = {"nothing": lambda h, *_: h, **{f.__name__: f for f in [ripple, other_plane, gains, roving, low_noise, offset, phase]}}


def written(path, sets, spoil=lambda h, *_: h, filed=lambda h, x, n: (h, x)):
    size = np.sqrt(np.mean([np.mean(np.abs(s["data"]) ** 2) for s in sets]))
    random = np.random.default_rng(7)
    file = pyuff.UFF(str(path))
    for n, frf in enumerate(sets):
        x = np.asarray(frf["x"])
        h = spoil(np.asarray(frf["data"]), x, str(frf["rsp_node"]), str(frf["ref_node"]), random, size)
        h = h * (1 + NOISE / np.sqrt(2) * (random.normal(size=len(x)) + 1j * random.normal(size=len(x))))
        h, x = filed(h, x, n)
        label = {"id5": f"averages {AVERAGES}", "x": x}
        file.write_sets({**frf, **label, "data": h}, "add")
        none = {"ordinate_spec_data_type": 0, "orddenom_spec_data_type": 0}
        coherence = np.full(len(x), 1 / (1 + 2 * AVERAGES * NOISE**2))
        file.write_sets({**frf, **label, **none, "func_type": 6, "ord_type": 2, "data": coherence}, "add")


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("program")
    arguments.add_argument("--only", nargs="*", help="names of what is hidden, or of what spoils")
    given = arguments.parse_args()
    program = str(pathlib.Path(shutil.which(given.program) or given.program).resolve())
    used = lambda: sum(resource.getrusage(resource.RUSAGE_CHILDREN)[:2])
    alone = {**os.environ, "RAYON_NUM_THREADS": "1"}
    right = named = wrong = 0
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        (folder / "fixture.json").write_text(json.dumps(fixture()))
        for what, hidden in HIDDEN.items():
            (folder / "truth.json").write_text(json.dumps(true_structure(hidden)))
            wanted = [word for frf in FRFS for word in ("--frf", frf)]
            words = [program, "synthesize", "truth.json", *wanted, "--lines", LINES, "-o", "exact.uff"]
            subprocess.run(words, cwd=folder, check=True, capture_output=True)
            sets = [s for s in pyuff.UFF(str(folder / "exact.uff")).read_sets() if s["type"] == 58]
            ways = {how: {"spoil": spoil} for how, spoil in SPOILT.items()} | {how: {"filed": filed} for how, filed in FILED.items()}
            for how, way in ways.items():
                if given.only and what not in given.only and how not in given.only:
                    continue
                (folder / "frfs.uff").unlink(missing_ok=True)
                written(folder / "frfs.uff", sets, **way)
                before = used()
                words = [program, "diagnose", "fixture.json", "frfs.uff", "-o", "out"]
                done = subprocess.run(words, cwd=folder, capture_output=True, text=True, env=alone)
                seconds = used() - before
                if done.returncode:
                    print(f"{what:7s}{how:12s} {done.stderr.strip()[-150:]}", flush=True)
                    continue
                answer = json.loads((folder / "out" / "diagnosis.json").read_text())
                kinds = [finding["kind"] for finding in answer["findings"]]
                is_right = all(effect["kind"] in kinds for effect in hidden)
                named, right = named + bool(hidden), right + (bool(hidden) and is_right)
                wrong += len(kinds) > sum(effect["kind"] in kinds for effect in hidden)
                line = " ".join(f"{f['kind']}@{f['place']}:{f['probability']:.2f}" for f in answer["findings"])
                print(f"{what:7s}{how:12s} {answer['verdict']:17s} {seconds:5.1f} s  {line}", flush=True)
    print(f"named what was hidden {right} of {named}; something else named {wrong}")


if __name__ == "__main__":
    sys.exit(main())
