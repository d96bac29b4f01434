#!/usr/bin/env python3
"""Tests joints on the same two blocks and asks the program whether they are the same, and by how much they differ.

    python3 docs/development/checks/compare_with_numpy.py PROGRAM [--blocks 200] [--seed 1] [--only KIND …] [--keep DIR]

Nothing of the program's own mechanics is used: two rigid blocks and a joint of K + iωC or K(1 + iη), written here with NumPy. Each set of BLOCKS is drawn from its fixture's tolerances once; seven
recordings are made on it, four FRFs with coherence of ten blows, 5 to 1200 Hz, with a noise of 0.3, 1 or 3 % in turn. Kinds, each with its own pairs of these:

    equal        one joint twice, viscous
    equal_loss   one joint twice, structural
    one_percent  the second 1 % stiffer
    five_percent the second 5 % stiffer
    laws         a viscous joint and a structural one of the same K, with the same losses at one frequency
    specimens    one joint three times; in specimens_differ the third 1 % stiffer

Of each: p of equality (share below 0.01 and 0.05, distance from uniform), the share said to contradict on the blocks, the share of 95 % intervals of ratios and differences that hold the truth, and how wide
they are against the best possible: Cramér and Rao's bound of both joints, the law known and the blocks in common. Ends with status 1 where a share is farther from what is stated than chance takes it
one time in a thousand (of intervals: only if fewer hold).

With --keep recordings and decompositions stay in DIR, and those that are there are used again.
"""
import argparse
import functools
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
import pyuff
from scipy.stats import binom, kstest
from slips_with_numpy import stated

LINES = np.arange(5.0, 1200.1, 2.5)
PAIRS = [("4", "1"), ("3", "1"), ("4", "2"), ("3", "2")]
NOISE = (0.003, 0.01, 0.03)
BLOWS = 10
#: How much larger K is, and whether its losses are structural.
RECORDINGS = {"a": (1.0, False), "b": (1.0, False), "c": (1.0, False), "one": (1.01, False), "five": (1.05, False), "loss": (1.0, True), "loss2": (1.0, True)}
KINDS = {
    "equal": ["a", "b"],
    "equal_loss": ["loss", "loss2"],
    "one_percent": ["a", "one"],
    "five_percent": ["a", "five"],
    "laws": ["a", "loss"],
    "specimens": ["a", "b", "c"],
    "specimens_differ": ["a", "b", "one"],
}
NUMBERS = ["K11", "K12", "K22", "C11", "C12", "C22"]
LOSS = 0.01


def quantities(fixture):
    """Values and deviations of all that blocks and points state: masses and inertias, then places."""
    bodies = [fixture["bodies"][name][key] for name in "AB" for key in ("mass", "inertia", "x_cg")]
    all = bodies + [fixture["points"][name]["x"] for name in "1234"]
    return np.array([each["value"] for each in all]), np.array([each["std"] for each in all])


def accelerances(q, stiffness, damping, is_structural):
    """H of each pair by line: `damping` is the imaginary part of K where that is structural."""
    (mass_a, inertia_a, cg_a, mass_b, inertia_b, cg_b), places = q[:6], dict(zip("1234", q[6:]))
    mass = np.diag([mass_a, inertia_a, mass_b, inertia_b])
    row = lambda name: np.array([1, places[name] - cg_a, 0, 0]) if name in "12" else np.array([0, 0, 1, places[name] - cg_b])
    length = places["3"] - places["2"]
    across = np.array([row("3") - row("2") - length * np.array([0, 1, 0, 0]), [0, -1, 0, 1]])
    s = 2j * np.pi * LINES
    dynamic = stiffness + (1j * damping if is_structural else s[:, None, None] * damping)
    impedance = s[:, None, None] ** 2 * mass + across.T @ dynamic @ across
    moved = np.linalg.solve(impedance, np.broadcast_to(np.array([row("1"), row("2")]).T, (len(s), 4, 2)))
    return np.array([s**2 * (moved[:, :, int(i) - 1] @ row(o)) for o, i in PAIRS])


class Blocks:
    """One set of blocks with a joint, as stated and as it is."""

    def __init__(self, number, seed):
        random = np.random.default_rng([seed, number])
        self.fixture, self.noise = stated(random), NOISE[number % len(NOISE)]
        self.stated, self.std = quantities(self.fixture)
        self.truth = self.stated + self.std * random.standard_normal(len(self.std))
        length = self.truth[8] - self.truth[7]
        beam = self.fixture["joints"]["J"]["beam"]
        bending = 2.07e11 * beam["second_moment"]["value"] * (1 + 0.01 * random.standard_normal())
        self.stiffness = bending / length**3 * np.array([[12, -6 * length], [-6 * length, 4 * length**2]])
        reduced = np.prod(self.truth[[0, 3]]) / np.sum(self.truth[[0, 3]])
        self.resonance = np.sqrt(self.stiffness[0, 0] / reduced)
        self.random = random

    def joint(self, name):
        """K, and C or Im K."""
        factor, is_structural = RECORDINGS[name]
        damping = LOSS * self.stiffness * (1 if is_structural else 1 / self.resonance)
        return factor * self.stiffness, damping, is_structural

    def truths(self, name):
        """The six numbers, C of a structural joint by the frequency at which it is stated, 602.5 Hz."""
        stiffness, damping, is_structural = self.joint(name)
        damping = damping / (2 * np.pi * 602.5) if is_structural else damping
        return np.array([matrix[i] for matrix in (stiffness, damping) for i in ((0, 0), (0, 1), (1, 1))])

    def deviations(self, exact):
        """Standard deviation of the mean of all blows, of each FRF's real and of its imaginary part."""
        return self.noise * np.sqrt(np.mean(abs(exact) ** 2, axis=1) / 2)

    def record(self, name, path, random):
        exact = accelerances(self.truth, *self.joint(name))
        deviation = self.deviations(exact)[:, None, None] * np.sqrt(BLOWS)
        noise = random.standard_normal((2, len(PAIRS), BLOWS, len(LINES)))
        each = exact[:, None] + deviation * (noise[0] + 1j * noise[1])
        mean = each.mean(1)
        coherence = abs(mean) ** 2 / (abs(each) ** 2).mean(1)
        path.unlink(missing_ok=True)
        file = pyuff.UFF(str(path))
        for at, pair in enumerate(PAIRS):
            file.write_sets(dataset(4, pair, mean[at]))
            file.write_sets(dataset(6, pair, coherence[at]))

    def information(self, name):
        """Fisher's of the six numbers and the quantities, each in units of itself or of its deviation."""
        stiffness, damping, is_structural = self.joint(name)
        six = np.array([matrix[i] for matrix in (stiffness, damping) for i in ((0, 0), (0, 1), (1, 1))])
        square = lambda a, b, d: np.array([[a, b], [b, d]])
        of = lambda x: accelerances(self.truth + self.std * x[6:], square(*(six * (1 + x[:6]))[:3]), square(*(six * (1 + x[:6]))[3:]), is_structural)
        deviation = self.deviations(of(np.zeros(6 + len(self.std))))[:, None]
        columns = []
        for at in range(6 + len(self.std)):
            step = np.zeros(6 + len(self.std))
            step[at] = 1e-6 if at < 3 else 1e-3
            slope = (of(step) - of(-step)) / (2 * step[at] * deviation)
            columns.append(np.concatenate([slope.real.ravel(), slope.imag.ravel()]))
        columns = np.array(columns)
        return columns @ columns.T

    def bound(self, first, second):
        """Least standard deviation of each ratio, in units of it."""
        n = len(self.std)
        information = np.zeros((12 + n, 12 + n))
        for at, name in enumerate((first, second)):
            own = np.r_[6 * at:6 * at + 6, 12:12 + n]
            information[np.ix_(own, own)] += self.information(name)
        information[12:, 12:] += np.eye(n)
        scale = np.sqrt(np.diag(information))
        covariance = np.linalg.inv(information / np.outer(scale, scale)) / np.outer(scale, scale)
        contrast = np.hstack([-np.eye(6), np.eye(6), np.zeros((6, n))])
        return np.sqrt(np.diag(contrast @ covariance @ contrast.T))


def dataset(kind, pair, values):
    response, reference = pair
    unit = (12, 13, "m/s^2", "N") if kind == 4 else (0, 0, "NONE", "NONE")
    return {
        "type": 58, "func_type": kind, "rsp_node": int(response), "rsp_dir": 2, "ref_node": int(reference), "ref_dir": 2, "data": values, "x": LINES, "id1": "x", "id2": "NONE",
        "id3": "NONE", "id4": "NONE", "id5": f"averages {BLOWS}", "ver_num": 0, "load_case_id": 0, "rsp_ent_name": "NONE", "ref_ent_name": "NONE",
        "abscissa_spacing": 1, "abscissa_min": LINES[0], "abscissa_inc": LINES[1] - LINES[0], "num_pts": len(values), "z_axis_value": 0,
        "abscissa_spec_data_type": 18, "abscissa_len_unit_exp": 0, "abscissa_force_unit_exp": 0, "abscissa_temp_unit_exp": 0,
        "ordinate_spec_data_type": unit[0], "orddenom_spec_data_type": unit[1], "ord_data_type": 6 if kind == 4 else 4, "abscissa_axis_lab": "x", "abscissa_axis_units_lab": "Hz",
        "ordinate_axis_lab": "y", "ordinate_axis_units_lab": unit[2], "orddenom_axis_lab": "y", "orddenom_axis_units_lab": unit[3], "binary": 1,
    }


def run(program, folder, *words):
    ran = subprocess.run([program, *words], cwd=folder, capture_output=True, text=True, env=dict(os.environ, RAYON_NUM_THREADS="1"))
    if ran.returncode not in (0, 1):
        sys.exit(f"{folder}: {' '.join(words)}: {ran.stderr.strip()}")


def decomposed(blocks, number, seed, program, folder, names):
    """Writes and decomposes what is not there yet."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "fixture.json").write_text(json.dumps(blocks.fixture))
    for name in names:
        if not (folder / name / "stiffness.json").exists():
            blocks.record(name, folder / f"{name}.uff", np.random.default_rng([seed, number, list(RECORDINGS).index(name)]))
            run(program, folder, "decompose", "fixture.json", f"{name}.uff", "-o", name)
            (folder / f"{name}.uff").unlink()


def compared(program, folder, names):
    run(program, folder, "compare", *names, "-o", "out-" + "-".join(names))
    return json.loads((folder / ("out-" + "-".join(names)) / "comparison.json").read_text())


class Score:
    """What came of one kind."""

    def __init__(self):
        self.p, self.untested, self.contradict, self.refuted, self.laws, self.count = [], 0, 0, 0, {}, 0
        self.holds = {"ratio": {n: [] for n in NUMBERS}, "difference": {n: [] for n in NUMBERS}}
        self.width, self.error = {n: [] for n in NUMBERS}, {n: [] for n in NUMBERS}

    def add(self, blocks, names, found):
        self.count += 1
        equality = found["equality"]
        if equality is None:
            self.untested += 1
        else:
            self.p.append(equality["p_value"])
        self.contradict += any(each["what"] == "bodies_disagree" for each in found["cautions"])
        law = found.get("law", {}).get("law", "none")
        self.laws[law] = self.laws.get(law, 0) + 1
        self.refuted += any(is_refuted(pair) for pair in found["pairs"])
        for pair in found["pairs"]:
            one, other = blocks.truths(pair["first"]), blocks.truths(pair["second"])
            is_of_one_law = RECORDINGS[pair["first"]][1] == RECORDINGS[pair["second"]][1]
            bound = blocks.bound(pair["first"], pair["second"])
            for at, number in enumerate(NUMBERS):
                entry = next((entry for entry in pair["numbers"] if entry["element"] == number), None)
                if entry is None or at >= 3 and not is_of_one_law:
                    continue
                low, high = entry["difference"]["ci95"]
                self.holds["difference"][number].append(low <= other[at] - one[at] <= high)
                if entry["ratio"] is None:
                    continue
                low, high = entry["ratio"]["ci95"]
                ratio = other[at] / one[at]
                self.holds["ratio"][number].append(low <= ratio <= high)
                self.width[number].append(entry["ratio"]["std"] / ratio / bound[at])
                self.error[number].append((entry["ratio"]["value"] / ratio - 1) / bound[at])

    def says(self, kind):
        p = np.array(self.p)
        of = lambda bound: f"{np.mean(p < bound):.3f}"
        far = kstest(p, "uniform").statistic if len(p) else np.nan
        tests = f"p below 0.01: {of(0.01)}, 0.05: {of(0.05)}; farthest from uniform {far:.3f}, smallest {p.min():.1g}" if len(p) else "no p"
        rows = [f"{kind}: {self.count} compared, {self.untested} without a test; {tests}; different: {self.refuted}; contradict on the blocks: {self.contradict}; laws {self.laws}"]
        for number in NUMBERS:
            ratio, difference = self.holds["ratio"][number], self.holds["difference"][number]
            if not ratio:
                continue
            width, error = np.array(self.width[number]), np.array(self.error[number])
            rows.append(f"   {number}: intervals hold, ratio {np.mean(ratio):.3f} of {len(ratio)}, difference {np.mean(difference):.3f}; stated/best: median {np.median(width):.2f}, "
                        f"nine of ten below {np.quantile(width, 0.9):.2f}; rms error/best {np.sqrt(np.mean(error**2)):.2f}, of the inner 98 % {np.sqrt(np.mean(np.sort(error**2)[:max(1, int(0.98 * len(error)))])):.2f}")
        return "\n".join(rows)


def is_refuted(pair):
    return pair["equality"] is not None and pair["equality"]["p_value"] < 0.05 or pair.get("laws_differ") is not None


def unlikely(count, of, share):
    """Whether chance makes a count so large less than one time in a thousand."""
    return of > 0 and binom.sf(count - 1, of, share) < 1e-3


def judged(kind, score):
    """What of it is not right, in words."""
    wrong = []
    if unlikely(score.contradict, score.count, 0.01 * (2 if kind.startswith("specimens") else 1)):
        wrong.append(f"{score.contradict} of {score.count} contradict on the blocks")
    is_of_equal_joints = kind in ("equal", "equal_loss", "specimens")
    if is_of_equal_joints:
        small = [(bound, int(np.sum(np.array(score.p) < bound))) for bound in (0.01, 0.05)]
        wrong += [f"{count} of {len(score.p)} equal joints have p < {bound}" for bound, count in small if unlikely(count, len(score.p), bound)]
        if score.count - len(score.p) > 0.05 * score.count:
            wrong.append(f"{score.count - len(score.p)} equal joints without a test")
    elif score.refuted < 0.9 * score.count:
        wrong.append(f"{score.count - score.refuted} of {score.count} are not found different")
    # The intervals of one pair's numbers, and those of three specimens, go together: a count of a kind is no more than one of its pairs.
    for what, all in score.holds.items():
        for number, holds in all.items():
            pairs = min(len(holds), score.count)
            missed = int(round(np.mean(np.logical_not(holds)) * pairs)) if holds else 0
            if unlikely(missed, pairs, 0.05):
                wrong.append(f"{number}: {missed} of {pairs} intervals of the {what} do not hold")
    return wrong


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program", type=lambda path: str(pathlib.Path(path).resolve()))
    parser.add_argument("--blocks", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", nargs="+", choices=KINDS, default=list(KINDS))
    parser.add_argument("--keep", type=pathlib.Path)
    arguments = parser.parse_args()
    names = sorted({name for kind in arguments.only for name in KINDS[kind]}, key=list(RECORDINGS).index)
    scores = {kind: Score() for kind in arguments.only}
    with tempfile.TemporaryDirectory() as temporary:
        for number in range(arguments.blocks):
            folder = (arguments.keep or pathlib.Path(temporary)).resolve() / str(number)
            blocks = Blocks(number, arguments.seed)
            blocks.information = functools.lru_cache(None)(blocks.information)
            decomposed(blocks, number, arguments.seed, arguments.program, folder, names)
            for kind, score in scores.items():
                score.add(blocks, KINDS[kind], compared(arguments.program, folder, KINDS[kind]))
    wrong = []
    for kind, score in scores.items():
        print(score.says(kind))
        found = judged(kind, score)
        wrong += found
        for each in found:
            print(f"   NOT RIGHT: {each}")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
