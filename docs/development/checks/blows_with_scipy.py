#!/usr/bin/env python3
"""Strikes structures over time, and asks the program what of them their fixtures leave out.

    python3 docs/development/checks/blows_with_scipy.py PROGRAM [--cases 30] [--seed 1] [--only null mass stiffness support gain] [--baseline] [--keep DIR]

Nothing of the program's own mechanics is used: rigid bodies on dashpots and springs, integrated here by their complex modes with SciPy, sixteen times as fine as sampled, and an anti-alias filter before sampling. What is
stated lies within its deviations of what is. Three to five blows at two points, their strength scattered by 30 to 50 %, pulses of 0.3 to 1.2 ms, 20 to 100 ms before them, records of 0.5 to 4 s that may end while the
structure still rings, noise of 0.02 to 0.5 % of the loudest response and 0.01 to 0.1 % of the blow, 16 or 24 bits, offsets; in every fourth test mains hum of up to 0.4 %, in every fourth a double blow. By turns:

    strip   two blocks on a strip, hung up softly, damping by mode
    glue    two glued blocks, hung up softly, a viscous joint
    frame   two or three storeys on columns, damping by mode

    null       nothing: `consistent`, nothing named
    mass       1 to 5 % of a body on it
    stiffness  a joint that is stated to 2 %, 20 % softer or stiffer
    support    a spring to ground
    gain       a response that reads 5 % low or high

What is hidden has to be named first, with more than 0.5, and nothing else as surely; whether its 95 % interval holds the truth is told. With `--baseline` the same structure was struck, in another test, before that was
hidden in it, and what has changed since is asked. Ends with status 1 where one is not right.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
import pyuff
import scipy.linalg
import scipy.signal

FINER = 16
KINDS = ["null", "mass", "stiffness", "support", "gain"]


class Structure:
    """Rigid bodies that move across x and turn, as a fixture file states them in plain numbers."""

    def __init__(self, file, hidden):
        self.file = file
        self.place, size = {}, 0
        for name, body in file["bodies"].items():
            self.place[name] = size
            size += 2 if "inertia" in body else 1
        self.mass = np.zeros((size, size))
        for name, body in file["bodies"].items():
            at = self.place[name]
            self.mass[at, at] = body["mass"]
            if "inertia" in body:
                self.mass[at + 1, at + 1] = body["inertia"]
        elastic, held, viscous = np.zeros((3, size, size))
        for name, joint in file["joints"].items():
            k = self.of_joint(joint)
            elastic += k
            if hidden.get("place") == name:
                changed = (hidden["factor"] - 1) * k
            if "damping" in joint:
                viscous += self.of_joint({**joint, "stiffness": joint["damping"]})
        for support in file["supports"].values():
            row = self.row(*self.point(support))
            held += support["stiffness"] * np.outer(row, row)
            viscous += support.get("damping", 0) * np.outer(row, row)
        self.stiffness, self.damping = elastic + held, viscous
        ratios = file.get("damping", {}).get("modal_ratios", [])
        squares, shapes = scipy.linalg.eigh(self.stiffness, self.mass)
        # The first ratio is of the first mode that is not one of the suspension.
        bends = [i for i in range(size) if shapes[:, i] @ held @ shapes[:, i] < 0.95 * squares[i]]
        for i, ratio in zip(bends, ratios + ratios[-1:] * size):
            own = shapes[:, i] @ viscous @ shapes[:, i]
            across = self.mass @ shapes[:, i]
            self.damping = self.damping + (2 * ratio * np.sqrt(squares[i]) - own) * np.outer(across, across)
        if hidden["kind"] == "stiffness":
            self.stiffness = self.stiffness + changed
        if hidden["kind"] in ("mass", "support"):
            row = self.row(hidden["place"], hidden["x"])
            if hidden["kind"] == "mass":
                self.mass = self.mass + hidden["mass"] * np.outer(row, row)
            else:
                self.stiffness = self.stiffness + hidden["stiffness"] * np.outer(row, row)

    def point(self, at):
        return (at["body"], at["x"]) if "body" in at else self.point(self.file["points"][at["point"]])

    def rows(self, body, x):
        """Motion and rotation at x."""
        rows, at = np.zeros((2, len(self.mass))), self.place[body]
        rows[0, at] = 1
        if "inertia" in self.file["bodies"][body]:
            rows[0, at + 1], rows[1, at + 1] = x - self.file["bodies"][body]["x_cg"], 1
        return rows

    def row(self, body, x):
        return self.rows(body, x)[0]

    def of_joint(self, joint):
        near, far = (self.file["points"][joint[end]] for end in ("from", "to"))
        length = far["x"] - near["x"]
        relative = self.rows(far["body"], far["x"]) - np.array([[1, length], [0, 1]]) @ self.rows(near["body"], near["x"])
        return relative.T @ np.array(joint["stiffness"]) @ relative

    def answers(self, force, step, struck, outs):
        """Accelerations at points under a force that goes straight from step to step."""
        n, inverse = len(self.mass), np.linalg.inv(self.mass)
        state = np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ self.stiffness, -inverse @ self.damping]])
        drive = np.r_[np.zeros(n), inverse @ self.row(*self.point(self.file["points"][struck]))]
        read = np.array([self.row(*self.point(self.file["points"][out])) for out in outs])
        poles, vectors = np.linalg.eig(state)
        into, out = np.linalg.solve(vectors, drive.astype(complex)), read @ state[n:] @ vectors
        answer = np.outer(read @ drive[n:], force)
        for pole, entry, column in zip(poles, into, out.T):
            if pole.imag < -1e-9:
                continue
            turn = pole * step
            grown = np.exp(turn)
            later = (grown - 1 - turn) / turn**2 * step
            now = (grown - 1) / turn * step - later
            motion = scipy.signal.lfilter([later, now], [1, -grown], force.astype(complex))
            answer += (2 if pole.imag > 1e-9 else 1) * np.real(np.outer(column * entry, motion))
        return answer


def beam(stiffness, length):
    return (stiffness * np.array([[12 / length**3, -6 / length**2], [-6 / length**2, 4 / length]])).tolist()


def drawn(kind, random):
    """A structure in plain numbers."""
    about = lambda share: random.uniform(1 - share, 1 + share)
    if kind == "frame":
        count, k = int(random.integers(2, 4)), 6e4 * about(0.4)
        names = [f"F{i + 1}" for i in range(count)]
        return {
            "bodies": {name: {"mass": 4 * about(0.25), "rotates": False} for name in names},
            "points": {str(i + 1): {"body": name, "x": 0.3 * (i + 1)} for i, name in enumerate(names)},
            "joints": {f"c{i + 1}": {"from": str(i), "to": str(i + 1), "stiffness": [[k * about(0.15), 0], [0, 0]]} for i in range(1, count)},
            "supports": {"base": {"point": "1", "stiffness": k * about(0.2)}},
            "damping": {"modal_ratios": [0.01 * about(0.4) for _ in names]},
        }
    lengths, breadth, height = [0.06 * about(0.15), 0.07 * about(0.2)], 0.05 * about(0.1), 0.05 * about(0.15)
    gap = {"strip": 0.065, "glue": 0.003}[kind] * about(0.2)
    masses = [7850 * length * breadth * height for length in lengths]
    inertias = [mass * (length**2 + height**2) / 12 for mass, length in zip(masses, lengths)]
    places, mount = [-lengths[0] / 2, gap + lengths[1] / 2], 2000 * about(0.5)
    file = {
        "bodies": {name: {"mass": masses[i], "inertia": inertias[i], "x_cg": places[i]} for i, name in enumerate("AB")},
        "points": {
            "1": {"body": "A", "x": 0.005 - lengths[0]}, "2": {"body": "A", "x": -0.006},
            "3": {"body": "B", "x": gap + 0.007}, "4": {"body": "B", "x": gap + lengths[1] - 0.005},
            "5": {"body": "A", "x": 0.0}, "6": {"body": "B", "x": gap},
        },
        "supports": {
            "m A": {"body": "A", "x": -0.8 * lengths[0], "stiffness": mount, "damping": 1.5 * about(0.5)},
            "m B": {"body": "B", "x": gap + 0.8 * lengths[1], "stiffness": mount * about(0.3), "damping": 1.5 * about(0.5)},
        },
    }
    if kind == "strip":
        stiffness = beam(2.05e11 * 0.05 * about(0.1) * (0.0045 * about(0.1)) ** 3 / 12, gap)
        file["damping"] = {"modal_ratios": [0.004 * about(0.6), 0.005 * about(0.6)]}
        losses = {}
    else:
        shear, turning = 7e6 * about(0.3) * breadth * height / gap, 20e6 * about(0.3) * breadth * height**3 / 12 / gap
        stiffness = [[shear, -shear * gap / 2], [-shear * gap / 2, turning + shear * gap**2 / 4]]
        losses = {"damping": (np.array(stiffness) * 1.5e-5 * about(0.5)).tolist()}
    file["joints"] = {"J": {"from": "5", "to": "6", "stiffness": stiffness, **losses}}
    return file


def stated(file, joints, random):
    """What an analyst knows of it: numbers with the deviations that they were drawn by."""
    def within(value, share=None, deviation=None):
        deviation = abs(value) * share if share else deviation
        return {"value": float(value + deviation * random.normal()), "std": float(deviation)} if deviation else value
    matrix = lambda k, share: (lambda a, b, d: [[a, b], [b, d]])(*(within(k[i][j], share) for i, j in ((0, 0), (0, 1), (1, 1))))
    fixture = json.loads(json.dumps(file))
    frame = "1" in fixture["points"] and "inertia" not in next(iter(fixture["bodies"].values()))
    for body in fixture["bodies"].values():
        body["mass"] = within(body["mass"], 0.001)
        if "inertia" in body:
            body["inertia"], body["x_cg"] = within(body["inertia"], 0.008), within(body["x_cg"], deviation=3e-4)
    if not frame:
        for point in fixture["points"].values():
            point["x"] = within(point["x"], deviation=2e-4)
    for joint in fixture["joints"].values():
        joint["stiffness"] = matrix(joint["stiffness"], joints)
        if "damping" in joint:
            joint["damping"] = matrix(joint["damping"], 0.2)
    for support in fixture["supports"].values():
        support["stiffness"] = within(support["stiffness"], joints if frame else 0.15)
        if "damping" in support:
            support["damping"] = within(support["damping"], 0.2)
    if "damping" in fixture:
        fixture["damping"]["modal_ratios"] = [within(ratio, 0.2) for ratio in fixture["damping"]["modal_ratios"]]
    return fixture


def what(kind, file, outs, random):
    """What is hidden."""
    name = str(random.choice(list(file["bodies"])))
    own = [point["x"] for point in file["points"].values() if point["body"] == name]
    place = {"place": name, "x": random.uniform(min(own), max(own))}
    supports = [support["stiffness"] for support in file["supports"].values()]
    return {
        "null": lambda: {},
        "mass": lambda: {**place, "mass": file["bodies"][name]["mass"] * random.uniform(0.01, 0.05)},
        "stiffness": lambda: {"place": str(random.choice(list(file["joints"]))), "factor": float(random.choice([0.8, 1.2]))},
        "support": lambda: {**place, "stiffness": np.mean(supports) * (random.uniform(8, 40) if len(supports) > 1 else random.uniform(0.1, 0.3))},
        "gain": lambda: {"place": str(random.choice(outs)), "factor": float(random.choice([0.95, 1.05]))},
    }[kind]() | {"kind": kind}


def signal(values, node, hit, force, interval):
    empty = {f"{part}_{kind}_unit_exp": 0 for part in ("ordinate", "orddenom", "z_axis", "abscissa") for kind in ("len", "force", "temp")}
    return pyuff.prepare_58(
        binary=1, id1="blow", id2="bench", id3="28-Nov-26", id4="NONE", id5="NONE", func_type=1, ver_num=hit, load_case_id=0, rsp_ent_name="NONE", rsp_node=int(node), rsp_dir=2,
        ref_ent_name="NONE", ref_node=0, ref_dir=0, ord_data_type=4, num_pts=len(values), abscissa_spacing=1, abscissa_min=0.0, abscissa_inc=interval, z_axis_value=0.0,
        abscissa_spec_data_type=17, abscissa_axis_units_lab="s", ordinate_spec_data_type=13 if force else 12, ordinate_axis_units_lab="N" if force else "m/s^2",
        orddenom_spec_data_type=0, orddenom_axis_units_lab="NONE", z_axis_spec_data_type=0, z_axis_axis_units_lab="NONE", x=interval * np.arange(len(values)), data=values, spec_data_type=0, **empty)


def struck(structure, file, outs, references, hidden, path, random):
    """Writes the blows of a test."""
    frame = len(file["supports"]) == 1
    rate = 2048.0 if frame else float(random.choice([4096, 5120, 8192]))
    seconds, width = float(random.choice([2, 4] if frame else [0.5, 1, 2, 4])), random.uniform(1.5e-3, 4e-3) if frame else random.uniform(0.3e-3, 1.2e-3)
    samples, step, before = int(seconds * rate), 1 / rate / FINER, random.uniform(0.02, 0.1)
    scatter, noise, of_force = random.uniform(0.3, 0.5), 10 ** random.uniform(np.log10(2e-4), np.log10(5e-3)), 10 ** random.uniform(-4, -3)
    hum, double = random.uniform(5e-4, 4e-3) * (random.random() < 0.25), random.random() < 0.25
    low = scipy.signal.firwin(64 * FINER + 1, 0.45 * rate, fs=rate * FINER, window=("kaiser", 9))
    lead = 32 * FINER
    time = step * (np.arange(samples * FINER + 2 * lead) - lead) - before
    sampled = lambda values: scipy.signal.upfirdn(low, values, 1, FINER)[2 * lead // FINER:][:samples]
    records, count = [], int(random.integers(3, 6))
    for reference in references:
        for blow in range(count):
            size, long = 150 * random.uniform(1 - scatter, 1 + scatter), width * random.uniform(0.88, 1.12)
            pulse = lambda from_: np.where((time > from_) & (time < from_ + long), np.sin(np.pi * (time - from_) / long) ** 2, 0)
            force = size * pulse(-random.uniform(0, 1) / rate)
            if double and blow == 0 and reference == references[0]:
                force = force + random.uniform(0.15, 0.6) * size * pulse(random.uniform(0.01, 0.05))
            answers = structure.answers(force, step, reference, outs)
            records.append((reference, sampled(force), [sampled(answer) for answer in answers]))
    peaks = [max(abs(record[2][i]).max() for record in records) for i in range(len(outs))]
    hardest, bits = max(abs(record[1]).max() for record in records), int(random.choice([16, 24]))
    digital = lambda values, peak: np.round(values / peak * 2 ** (bits - 1) / 1.25) * 1.25 * peak / 2 ** (bits - 1)
    tone = lambda hz, size: size * np.sin(2 * np.pi * hz * np.arange(samples) / rate + 7 * random.random())
    sets = [pyuff.prepare_164(units_code=1, units_description="SI", temp_mode=1, length=1.0, force=1.0, temp=1.0, temp_offset=273.15)]
    for number, (reference, force, answers) in enumerate(records, 1):
        spoilt = force + hardest * (of_force * random.normal(size=samples) + 2e-3 * random.normal())
        sets.append(signal(digital(spoilt, hardest), reference, number, True, 1 / rate))
        for out, answer, peak in zip(outs, answers, peaks):
            gain = hidden["factor"] if hidden["kind"] == "gain" and hidden["place"] == out else 1.0
            spoilt = gain * answer + peak * (noise * random.normal(size=samples) + 2e-3 * random.normal()) + tone(50, hum * peak) + tone(150, 0.3 * hum * peak)
            sets.append(signal(digital(spoilt, peak), out, number, False, 1 / rate))
    path.unlink(missing_ok=True)
    pyuff.UFF(str(path)).write_sets(sets, mode="add")


NAMES = {"mass": "added_mass", "stiffness": "stiffness_change", "support": "support", "gain": "channel_gain"}
SIZES = {"mass": "mass", "stiffness": "factor", "support": "stiffness", "gain": "factor"}


def judged(answer, hidden):
    """Whether the answer is right, and whether the interval of the size holds it."""
    findings, kind = answer["findings"], hidden["kind"]
    own = f"joints/{hidden.get('place')}/stiffness"
    # A spring's stiffness that is wrong is the same thing as its change.
    same = lambda finding: sum(other["probability"] for other in finding["alternatives"] if kind == "stiffness" and (other["place"] == hidden["place"] or own in other["place"]))
    sure = [finding for finding in findings if finding["probability"] + same(finding) > 0.5]
    if kind == "null":
        return answer["verdict"] == "consistent" and not sure, None
    place = f"response {hidden['place']}" if kind == "gain" else hidden["place"]
    restated = kind == "stiffness" and sure and sure[0]["kind"] == "quantity_error" and own in sure[0]["place"]
    is_right = len(sure) == 1 and findings[0] is sure[0] and (restated or (sure[0]["kind"], sure[0]["place"]) == (NAMES[kind], place))
    interval = is_right and not restated and sure[0]["parameters"][SIZES[kind]]["ci95"]
    return is_right, interval[0] <= hidden[SIZES[kind]] <= interval[1] if interval else None


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--cases", type=int, default=30)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", nargs="+", choices=KINDS, default=KINDS)
    parser.add_argument("--baseline", action="store_true")
    parser.add_argument("--keep", type=pathlib.Path)
    arguments = parser.parse_args()
    folder = arguments.keep or pathlib.Path(tempfile.mkdtemp())
    wrong = 0
    for number, kind in enumerate(arguments.only):
        right, held, intervals = 0, 0, 0
        for case in range(arguments.cases):
            random = np.random.default_rng([arguments.seed, KINDS.index(kind), case])
            shape = ["strip", "glue", "frame"][case % 3]
            file = drawn(shape, random)
            outs = list(file["points"]) if shape == "frame" else ["1", "2", "3", "4"][: int(random.integers(3, 5))]
            references = [outs[-1], outs[0]] if shape == "frame" else ["1", ["2", "3", "4"][int(random.integers(3))]]
            hidden = what(kind, file, outs, random)
            own = folder / f"{kind}-{case:02d}"
            own.mkdir(parents=True, exist_ok=True)
            (own / "fixture.json").write_text(json.dumps(stated(file, 0.02 if kind == "stiffness" else 0.04, random), indent=1))
            (own / "truth.json").write_text(json.dumps({"structure": file, "hidden": hidden}, default=float))
            struck(Structure(file, hidden), file, outs, references, hidden, own / "blows.uff", random)
            before = []
            if arguments.baseline:
                again = np.random.default_rng([arguments.seed, KINDS.index(kind), case, 1])
                struck(Structure(file, {"kind": "null"}), file, outs, references, {"kind": "null"}, own / "before.uff", again)
                before = ["--baseline", str(own / "before.uff")]
            run = subprocess.run([arguments.program, "diagnose", str(own / "fixture.json"), *before, str(own / "blows.uff"), "--json"], capture_output=True, text=True)
            answer = json.loads(run.stdout) if run.returncode == 0 else {"verdict": run.stderr.strip().splitlines()[-1], "findings": []}
            is_right, holds = judged(answer, hidden)
            right += is_right
            held, intervals = held + bool(holds), intervals + (holds is not None)
            if not is_right or holds is False:
                names = [(finding["kind"], finding["place"], round(finding["probability"], 2)) for finding in answer["findings"]]
                fit = {model: round(chi2, 2) for model, chi2 in answer.get("fit", {}).get("chi2_per_dof", {}).items()}
                print(f"{kind}-{case:02d} {shape}: {'interval misses' if is_right else 'wrong'}: {answer['verdict']} {fit} {names}, hidden {hidden}", flush=True)
        wrong += arguments.cases - right
        print(f"{kind}: {right} of {arguments.cases} right, {held} of {intervals} intervals of 95 % hold", flush=True)
    sys.exit(wrong > 0)


if __name__ == "__main__":
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    main()
