#!/usr/bin/env python3
"""How often `compare` calls tests of one joint different, and tests of two joints the same.

    python3 docs/development/checks/same_joint.py PROGRAM FIXTURE PAIRS NOISE [--stiffer SHARE] [--first SEED] [--independent] [--draw]

Of FIXTURE 2·PAIRS tests are synthesized with NOISE (per cent, seeds from SEED on), decomposed by it and compared two by two. With --stiffer the second of each pair is of a fixture
whose joint's beam is stiffer by this share. With --draw the masses, inertias and places of each pair are drawn once from the fixture's deviations. Printed is the share of pairs with
p-values of equality below some bounds, how far they are from uniform, how often each number differs to 95 %, pairs by their most probable laws, and cautions. PROGRAM is the built
binary. Needs nothing but Python.
"""
import argparse
import collections
import json
import pathlib
import random
import subprocess
import tempfile

BOUNDS = (0.01, 0.05, 0.2, 0.5, 0.8, 0.95)


def drawn(fixture, seed):
    """The fixture with the bodies' quantities and the points' places drawn from their deviations."""
    draw = random.Random(seed)
    truth = json.loads(json.dumps(fixture))
    for part in list(truth["bodies"].values()) + list(truth["points"].values()):
        for quantity in part.values():
            if isinstance(quantity, dict) and isinstance(quantity.get("std"), float):
                quantity["value"] += quantity["std"] * draw.gauss(0.0, 1.0)
    return truth


def stiffened(fixture, share):
    truth = json.loads(json.dumps(fixture))
    for joint in truth["joints"].values():
        joint["beam"]["second_moment"]["value"] *= 1.0 + share
    return truth


class Bench:
    def __init__(self, arguments, folder):
        self.arguments, self.folder = arguments, folder
        self.stated = json.loads(pathlib.Path(arguments.fixture).read_text())

    def run(self, *command):
        done = subprocess.run([self.arguments.program, *map(str, command)], capture_output=True, text=True)
        if done.returncode not in (0, 1):
            raise SystemExit(f"{' '.join(map(str, command))}: {done.stderr}")

    def decomposed(self, name, truth, seed):
        fixture, recording = self.folder / f"{name}.json", self.folder / f"{name}.uff"
        fixture.write_text(json.dumps(truth))
        self.run("synthesize", fixture, "--noise", self.arguments.noise, "--seed", seed, "-o", recording)
        self.run("decompose", self.arguments.fixture, recording, "-o", self.folder / name)
        joint = json.loads((self.folder / name / "stiffness.json").read_text())["joint"]
        return joint["follows"]["law"] + (" (C held)" if joint.get("on_the_boundary_of_passive") else "")

    def pair(self, number):
        first = self.arguments.first + 2 * number
        truth = drawn(self.stated, first) if self.arguments.draw else self.stated
        laws = [self.decomposed("a", truth, first),
                self.decomposed("b", stiffened(truth, self.arguments.stiffer), first + 1)]
        options = ["--independent"] if self.arguments.independent else []
        self.run("compare", self.folder / "a", self.folder / "b", "-o", self.folder / "out", *options)
        return laws, json.loads((self.folder / "out" / "comparison.json").read_text())


def main():
    parser = argparse.ArgumentParser()
    for name, kind in (("program", str), ("fixture", str), ("pairs", int), ("noise", float)):
        parser.add_argument(name, type=kind)
    parser.add_argument("--stiffer", type=float, default=0.0)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--independent", action="store_true")
    parser.add_argument("--draw", action="store_true")
    arguments = parser.parse_args()
    p_values, differs, laws, cautions, untested = [], collections.Counter(), collections.Counter(), collections.Counter(), 0
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(arguments, pathlib.Path(folder))
        for number in range(arguments.pairs):
            followed, compared = bench.pair(number)
            laws[" / ".join(sorted(followed))] += 1
            cautions.update(caution["what"] for caution in compared["cautions"])
            pair = compared["pairs"][0]
            for entry in pair["numbers"]:
                low, high = entry["difference"]["ci95"]
                differs[entry["element"]] += low > 0.0 or high < 0.0
            if pair["equality"] is None:
                untested += 1
            else:
                p_values.append((pair["equality"]["p_value"], arguments.first + 2 * number))
    (smallest, seed), p_values = min(p_values), sorted(p for p, _ in p_values)
    count = len(p_values)
    print(f"{count} pairs tested, {untested} not")
    print("p below " + ", ".join(f"{bound}: {sum(p < bound for p in p_values) / count:.3f}" for bound in BOUNDS))
    print(f"smallest {smallest:.2g}, seed {seed}; farthest from uniform "
          f"{max(max((i + 1) / count - p, p - i / count) for i, p in enumerate(p_values)):.3f}")
    print("differ to 95 %: " + ", ".join(f"{element} {n / arguments.pairs:.3f}" for element, n in differs.items()))
    print("laws: " + "; ".join(f"{law}: {n}" for law, n in laws.most_common()))
    print("cautions: " + (", ".join(f"{what}: {n}" for what, n in cautions.items()) or "none"))


if __name__ == "__main__":
    main()
