#!/usr/bin/env python3
"""Joints of two blocks, recorded by NumPy, and how often their intervals hold.

    python3 docs/development/checks/joints_with_numpy.py PROGRAM [--runs 20] [--seed 1] [--only default quiet …]
    python3 docs/development/checks/joints_with_numpy.py PROGRAM --twice 1 [--runs 20] [--seed 1] [--only default wide]
    python3 docs/development/checks/joints_with_numpy.py PROGRAM --chain 3 [--runs 12] [--seed 1]

Blocks and points are drawn from their tolerances; each point is struck ten times, H1 and coherence are estimated from the hits. Nothing of the program's mechanics is
used. A score is (found − true) over the stated deviation; the root of its mean square should be 1. Ends with status 1 where that of k11, k12 or k22 is above 1.5, where a law is
wrong in more than a quarter of the runs, or where χ² per degree of freedom is above 1.1.

--twice F tests every joint twice on the same blocks, the second time F times as stiff, and has `compare` say whether both are the same: how often p is below 0.05, and the smallest.
--chain N has all joints of a chain of N blocks found at once, each stated between 0.6 and 1.6 times as stiff as it is: how many scores are beyond 4.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np
import pyuff

K = np.array([[1.44e6, -4.53e4], [-4.53e4, 2.21e3]])
C = np.array([[13.5, -0.45], [-0.45, 0.021]])
LENGTH, LINES, HITS = 0.065, 2.5 * np.arange(1, 401), 10
ACROSS = [("4", "1"), ("3", "1"), ("4", "2"), ("3", "2")]
BODIES = {"A": {"mass": 1.1775, "inertia": 5.986e-4, "x_cg": -0.030}, "B": {"mass": 1.884, "inertia": 1.57e-3, "x_cg": LENGTH + 0.040}}
POINTS = {"1": ("A", -0.055), "2": ("A", 0.0), "3": ("B", LENGTH), "4": ("B", LENGTH + 0.072)}
# Deviations of a mass and an inertia as shares, of a centre of gravity and a point in m.
USUAL, DEFAULTS, WIDE = (0.001, 0.005, 2e-4, 1e-4), (0.002, 0.01, 2e-4, 2e-4), (0.005, 0.03, 1e-3, 5e-4)
VISCOUS, STRUCTURAL = (lambda s: K + s * C), (lambda s: K * (1 + 0.03j))
# Tolerances, noise of a hit as a share of each FRF's root mean square, dynamic stiffness, the joint's mass, names of its law.
SCENARIOS = {
    "default": (DEFAULTS, 1e-3, VISCOUS, 0.0, ["viscous"]),
    "quiet": (USUAL, 1e-4, VISCOUS, 0.0, ["viscous"]),
    "usual": (USUAL, 1e-2, VISCOUS, 0.0, ["viscous"]),
    "wide": (WIDE, 1e-2, VISCOUS, 0.0, ["viscous"]),
    "light": (USUAL, 1e-2, lambda s: K + 0.03 * s * C, 0.0, ["viscous"]),
    "structural": (USUAL, 1e-2, STRUCTURAL, 0.0, ["structural"]),
    "structural with mass": (USUAL, 1e-2, STRUCTURAL, 0.05, ["structural_with_mass"]),
    "viscous with mass": (USUAL, 1e-2, VISCOUS, 0.08, ["viscous_with_mass"]),
}


def stds(tolerances):
    of_body = lambda body: {key: share * abs(body[key]) for key, share in zip(("mass", "inertia"), tolerances)} | {"x_cg": tolerances[2]}
    return {name: of_body(body) for name, body in BODIES.items()}, tolerances[3]


def drawn(tolerances, random):
    of_bodies, of_points = stds(tolerances)
    bodies = {name: {key: value + of_bodies[name][key] * random.standard_normal() for key, value in body.items()} for name, body in BODIES.items()}
    return bodies, {name: (body, x + of_points * random.standard_normal()) for name, (body, x) in POINTS.items()}


def fixture(tolerances):
    of_bodies, of_points = stds(tolerances)
    quantity = lambda value, std: {"value": value, "std": std}
    unknown = [[quantity(float(value), "unknown") for value in row] for row in K]
    return {
        "bodies": {name: {key: quantity(value, of_bodies[name][key]) for key, value in body.items()} for name, body in BODIES.items()},
        "points": {name: {"body": body, "x": quantity(x, of_points)} for name, (body, x) in POINTS.items()},
        "joints": {"J": {"from": "2", "to": "3", "stiffness": unknown}},
    }


def accelerances(structure, law, joint_mass):
    """Of two rigid blocks, each with a deflection and a rotation; a joint's mass is that of a uniform beam."""
    bodies, points = structure
    mass = np.diag([bodies[name][key] for name in "AB" for key in ("mass", "inertia")])

    def row(name):
        body, x = points[name]
        arm = x - bodies[body]["x_cg"]
        return np.array([1, arm, 0, 0] if body == "A" else [0, 0, 1, arm])

    length = points["3"][1] - points["2"][1]
    ends = np.array([row("2"), [0, 1, 0, 0], row("3"), [0, 0, 0, 1]])
    if joint_mass:
        l = length
        consistent = [[156, 22 * l, 54, -13 * l], [22 * l, 4 * l * l, 13 * l, -3 * l * l], [54, 13 * l, 156, -22 * l], [-13 * l, -3 * l * l, -22 * l, 4 * l * l]]
        mass = mass + ends.T @ (joint_mass / 420 * np.array(consistent)) @ ends
    across = np.array([[-1, -length, 1, 0], [0, -1, 0, 1]]) @ ends
    s = 2j * np.pi * LINES[:, None, None]
    receptances = np.linalg.inv(s**2 * mass + across.T @ (law(s) * np.ones_like(s)) @ across)
    return {pair: s[:, 0, 0] ** 2 * (receptances @ row(pair[1]) @ row(pair[0])) for pair in ACROSS}


def hit(exact, noise, random):
    """H1 and coherence of ten hits of about one strength."""
    white = lambda level: level * (random.standard_normal((HITS, LINES.size)) + 1j * random.standard_normal((HITS, LINES.size))) / np.sqrt(2)
    struck = np.abs(1 + 0.25 * random.standard_normal(HITS))[:, None] * np.ones(LINES.size)
    force, response = struck + white(0.1 * noise), exact * struck + white(noise * np.sqrt(np.mean(np.abs(exact) ** 2)))
    cross, own, other = (response * force.conj()).sum(0), (np.abs(force) ** 2).sum(0), (np.abs(response) ** 2).sum(0)
    return cross / own, np.abs(cross) ** 2 / (own * other)


def written(path, frfs, random, noise):
    file = pyuff.UFF(str(path))
    for (response, reference), exact in frfs.items():
        values, coherence = hit(exact, noise, random)
        for data, kind, units in ((values, 4, (12, 13)), (coherence, 6, (0, 0))):
            file.write_sets(
                {
                    "type": 58, "func_type": kind, "rsp_node": int(response), "rsp_dir": 2, "ref_node": int(reference), "ref_dir": 2, "data": data, "x": LINES,
                    "id1": "joint", "id5": f"averages {HITS}", "rsp_ent_name": "NONE", "ref_ent_name": "NONE", "abscissa_spec_data_type": 18,
                    "ordinate_spec_data_type": units[0], "orddenom_spec_data_type": units[1], "abscissa_spacing": 1, "binary": 0, "z_axis_value": 0.0,
                },
                mode="add",
            )


def asked(program, command, folder):
    """What the program answers, or its refusal."""
    answer = subprocess.run([program, *command, "--json"], cwd=folder, capture_output=True, text=True, env={**os.environ, "RAYON_NUM_THREADS": "1"})
    return (json.loads(answer.stdout), None) if answer.returncode == 0 else (None, answer.stderr.strip())


def twice(program, scenario, times, seed, number, folder):
    """χ² and p of a joint tested twice being the same, and by how many deviations the blocks' valley bends between."""
    tolerances, noise, law, mass, _ = SCENARIOS[scenario]
    random = np.random.default_rng([seed, list(SCENARIOS).index(scenario), number])
    (folder / "fixture.json").write_text(json.dumps(fixture(tolerances)))
    structure = drawn(tolerances, random)
    for test, stiffer in (("a", 1.0), ("b", times)):
        (folder / f"{test}.uff").unlink(missing_ok=True)
        written(folder / f"{test}.uff", accelerances(structure, lambda s, by=stiffer: by * law(s), mass), random, noise)
        _, refusal = asked(program, ["decompose", "fixture.json", f"{test}.uff", "-o", test], folder)
        if refusal:
            sys.exit(f"{scenario} {number}: {refusal}")
    answer, refusal = asked(program, ["compare", "a", "b"], folder)
    if refusal:
        sys.exit(f"{scenario} {number}: {refusal}")
    return answer["pairs"][0]["equality"]


def chain(program, blocks, seed, number, folder, noise=1e-2):
    """Scores of k11, k12, k22 of all joints of a chain of so many blocks; nothing where they are refused."""
    random = np.random.default_rng([seed, blocks, number])
    bodies, points, joints, x = {}, {}, {}, 0.0
    for place in range(blocks):
        body, length, mass = "ABCDEFGH"[place], random.uniform(0.05, 0.1), random.uniform(0.8, 2.2)
        bodies[body] = {"mass": mass, "inertia": mass * (length**2 + 0.04**2) / 12, "x_cg": x + length / 2 + random.uniform(-4e-3, 4e-3)}
        near, middle, far = (str(3 * place + k) for k in (1, 2, 3))
        points |= {near: (body, x), middle: (body, x + length * random.uniform(0.55, 0.75)), far: (body, x + length)}
        if place:
            last = str(3 * place)
            k11, centre = 10 ** random.uniform(5.6, 6.7), (x - points[last][1]) * random.uniform(-0.6, -0.4)
            about = k11 * (x - points[last][1]) ** 2 / 12 * random.uniform(0.8, 3)
            joints[f"J{place}"] = (last, near, k11 * np.array([[1, centre], [centre, centre**2]]) + np.diag([0, about]), random.uniform(5e-6, 3e-5))
        x += length + random.uniform(0.04, 0.08)
    spreads = lambda of: {key: share * abs(of[key]) for key, share in zip(("mass", "inertia"), DEFAULTS)} | {"x_cg": DEFAULTS[2]}
    true = {name: {key: value + spreads(of)[key] * random.standard_normal() for key, value in of.items()} for name, of in bodies.items()}
    places = {name: (body, at + DEFAULTS[3] * random.standard_normal()) for name, (body, at) in points.items()}
    first = {name: 2 * place for place, name in enumerate(bodies)}

    def row(point, rotation=False):
        body, at = places[point]
        row = np.zeros(2 * blocks)
        row[first[body] + 1] = 1.0 if rotation else at - true[body]["x_cg"]
        row[first[body]] = 0.0 if rotation else 1.0
        return row

    s = 2j * np.pi * LINES[:, None, None]
    stiffness = s**2 * np.diag([true[name][key] for name in true for key in ("mass", "inertia")])
    for near, far, matrix, loss in joints.values():
        length = places[far][1] - places[near][1]
        across = np.array([[-1, -length, 1, 0], [0, -1, 0, 1]]) @ np.array([row(near), row(near, True), row(far), row(far, True)])
        stiffness = stiffness + across.T @ (matrix * (1 + loss * s)) @ across
    receptances = np.linalg.inv(stiffness)
    struck = ["1", *(str(3 * place + 2) for place in range(1, blocks))]
    felt = [point for point in points if int(point) % 3 != 2]
    frfs = {(response, reference): s[:, 0, 0] ** 2 * (receptances @ row(reference) @ row(response)) for reference in struck for response in felt}
    quantity = lambda value, std: {"value": float(value), "std": std}
    guessed = {}
    for name, (near, far, matrix, _) in joints.items():
        guess = matrix * random.uniform(0.6, 1.6)
        guessed[name] = {"from": near, "to": far, "stiffness": [[quantity(value, "unknown") for value in row] for row in guess]}
    stated = {
        "bodies": {name: {key: quantity(value, spreads(of)[key]) for key, value in of.items()} for name, of in bodies.items()},
        "points": {name: {"body": body, "x": quantity(at, DEFAULTS[3])} for name, (body, at) in points.items()},
        "joints": guessed,
    }
    (folder / "fixture.json").write_text(json.dumps(stated))
    (folder / "test.uff").unlink(missing_ok=True)
    written(folder / "test.uff", frfs, random, noise)
    answer, refusal = asked(program, ["decompose", "fixture.json", "test.uff"], folder)
    if refusal:
        print(f"chain of {blocks}, {number}: {refusal}", flush=True)
        return None
    deviation = dict(zip(answer["covariance"]["elements"], np.sqrt(np.diag(answer["covariance"]["matrix"]))))
    each = [(joint["name"], joint.get("joint", joint)["stiffness"]) for joint in answer["joints"]]
    return [(found[i][j] - joints[name][2][i, j]) / deviation[f"{name}/k{i + 1}{j + 1}"] for name, found in each for i, j in ((0, 0), (0, 1), (1, 1))]


def run(program, scenario, seed, number, folder):
    """Scores of the six numbers, the law's name and χ² per degree of freedom."""
    tolerances, noise, law, mass, _ = SCENARIOS[scenario]
    random = np.random.default_rng([seed, list(SCENARIOS).index(scenario), number])
    (folder / "fixture.json").write_text(json.dumps(fixture(tolerances)))
    (folder / "test.uff").unlink(missing_ok=True)
    written(folder / "test.uff", accelerances(drawn(tolerances, random), law, mass), random, noise)
    answer = subprocess.run(
        [program, "decompose", "fixture.json", "test.uff", "--json"], cwd=folder, capture_output=True, text=True, env={**os.environ, "RAYON_NUM_THREADS": "1"}
    )
    if answer.returncode:
        sys.exit(f"{scenario} {number}: {answer.stderr}")
    joint = json.loads(answer.stdout)["joint"]
    if "failed" in joint:
        return None, joint["failed"], np.nan
    omega = 2 * np.pi * joint["follows"]["frequency"]
    true = law(1j * omega)
    six = lambda stiffness, damping: np.array([matrix[i][j] for matrix in (stiffness, damping) for i, j in ((0, 0), (0, 1), (1, 1))])
    off = six(joint["stiffness"], joint["damping"]) - six(true.real, true.imag / omega)
    return off / np.sqrt(np.diag(joint["covariance"])), joint["law"], joint["chi2_per_dof"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=lambda path: str(pathlib.Path(path).resolve()))
    parser.add_argument("--runs", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", nargs="*", default=list(SCENARIOS))
    parser.add_argument("--twice", type=float)
    parser.add_argument("--chain", type=int)
    given = parser.parse_args()
    is_right = True
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        if given.chain:
            began = time.time()
            runs = [chain(given.program, given.chain, given.seed, number, folder) for number in range(given.runs)]
            scores = np.array([score for run in runs if run for score in run])
            beyond = sum(run is None or np.max(np.abs(run)) > 4 for run in runs)
            print(f"chain of {given.chain}: refused or a score beyond 4 in {beyond} of {given.runs}, rms of scores {np.sqrt((scores**2).mean()):.2f}, {(time.time() - began) / given.runs:.1f} s a run")
            sys.exit(0 if beyond == 0 else 1)
        if given.twice:
            for scenario in given.only:
                tests = [twice(given.program, scenario, given.twice, given.seed, number, folder) for number in range(given.runs)]
                p = np.array([test["p_value"] for test in tests])
                print(f"{scenario}, twice, {given.twice} times as stiff: p below 0.05 in {(p < 0.05).sum()} of {given.runs}, smallest {p.min():.2g}, median bend {np.median([test.get('bend', np.nan) for test in tests]):.1f}", flush=True)
            sys.exit(0)
    for scenario in given.only:
        began = time.time()
        with tempfile.TemporaryDirectory() as folder:
            runs = [run(given.program, scenario, given.seed, number, pathlib.Path(folder)) for number in range(given.runs)]
        scores = np.array([scores for scores, *_ in runs if scores is not None])
        laws = [law for _, law, _ in runs]
        named = sum(law in SCENARIOS[scenario][4] for law in laws)
        chi2 = float(np.mean([chi2 for *_, chi2 in runs]))
        squares, held = np.sqrt((scores**2).mean(0)), (np.abs(scores) < 1.96).mean(0)
        is_right &= bool((squares[:3] < 1.5).all() and named >= 0.75 * given.runs and chi2 < 1.1)
        print(f"{scenario}: scores {np.round(squares, 2)}, 95 % intervals hold {np.round(100 * held[:3])} %, law right {named} of {given.runs}, χ² {chi2:.3f}, {(time.time() - began) / given.runs:.2f} s a run", flush=True)
    sys.exit(0 if is_right else 1)


if __name__ == "__main__":
    main()
