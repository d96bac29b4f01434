#!/usr/bin/env python3
"""Joints with a cubic spring, friction or a gap, struck at several strengths, by NumPy: whether `diagnose` names the law, and what else is wrong.

    python3 docs/development/checks/laws_with_numpy.py PROGRAM [--draws 1] [--seed 1] [--only null law beside scatter] [--keep DIR]

Two free blocks and a strip without mass; each of two points is struck twice with 50, 170 and 600 N. The linear part is propagated exactly at twelve times the sampling rate, forces being
parabolas between steps; one filter of linear phase stands before all channels. Nothing of the program's mechanics is used. The fixture has its numbers off by their deviations.

null     nothing hidden: `consistent`.
law      one law in translation or rotation that shifts the first bending mode by 2 %: it alone, `explained`.
beside   the same beside 30 g on a block, or a joint 5 or 10 % stiffer than stated: it alone, `partly_explained`, and the number that holds the rest told.
scatter  nothing hidden, and blows that land a millimetre beside each other: no name but the offset of a struck point, which is where the mean of its blows is.

Ends with status 1 where one is not right. Sizes in their 95 % intervals are counted beside.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import zlib

import numpy as np
import pyuff
from scipy import signal
from scipy.linalg import eigh, expm

RATE, SAMPLES, ONSET, OVER = 8192, 8192, 128, 12
LEVELS, REPEATS = (50.0, 170.0, 600.0), 2
TRUE = dict(mA=1.48, mB=1.93, jA=1.62e-3, jB=2.55e-3, xA=-0.038, xB=0.113, p1=-0.070, p2=0.0, p3=0.070, p4=0.155, E=2.07e11, I=2.9e-10)
STD = dict(mA=0.0015, mB=0.0019, jA=6e-6, jB=1e-5, xA=1e-4, xB=1e-4, p1=1e-4, p2=1e-4, p3=1e-4, p4=1e-4, E=1.0e9, I=1.45e-12)
RATIOS, RATIO_STD = (0.008, 0.006), 0.001
KINDS, COMPONENTS = ("cubic_stiffness", "friction", "gap"), ("translation", "rotation")


def motion(body, x):
    """What (y, θ) of the blocks' centres of gravity move a place by."""
    return np.array([1, x - TRUE["xA"], 0, 0.0]) if body == "A" else np.array([0, 0, 1, x - TRUE["xB"]])


class Structure:
    def __init__(self, stiffer=1.0, added=0.0):
        t, length = TRUE, TRUE["p3"] - TRUE["p2"]
        mass = np.diag([t["mA"], t["jA"], t["mB"], t["jB"]])
        near, far = motion("A", t["p2"]), motion("B", t["p3"])
        turn = np.array([0, 1.0, 0, 0])
        self.across = np.vstack([far - near - length * turn, np.array([0, -1.0, 0, 1.0])])
        bending = t["E"] * t["I"] * stiffer
        joint = bending * np.array([[12 / length**3, -6 / length**2], [-6 / length**2, 4 / length]])
        self.stiffness = self.across.T @ joint @ self.across
        squared, shapes = eigh(self.stiffness, mass)
        self.omega, self.shape = np.sqrt(squared[2]), shapes[:, 2]
        modes = zip((2, 3), RATIOS)
        self.damping = sum(2 * z * np.sqrt(squared[i]) * np.outer(mass @ shapes[:, i], mass @ shapes[:, i]) for i, z in modes)
        on = motion("A", -0.065)
        self.mass = mass + added * np.outer(on, on)
        places = {"1": ("A", "p1"), "2": ("A", "p2"), "3": ("B", "p3"), "4": ("B", "p4")}
        self.points = {name: motion(body, t[place]) for name, (body, place) in places.items()}


def restoring(kind, size, d, slider):
    """The law's force, and where its slider then stands."""
    if kind == "cubic_stiffness":
        return size["stiffness3"] * d**3, slider
    if kind == "gap":
        return size["stiffness"] * np.maximum(d - size["clearance"], 0), slider
    force = np.clip(size["stiffness"] * (d - slider), -size["slip_force"], size["slip_force"])
    return force, d - force / size["stiffness"]


def simulated(structure, law, blows):
    """Forces, accelerations of points 3 and 4 by blow, and the largest motion of the law's component."""
    step, count, n = 1 / (RATE * OVER), SAMPLES * OVER, len(blows)
    t = np.arange(count + 1) * step
    begins, widths = ONSET / RATE, [1.0e-3 - 0.02e-3 * np.log(peak) for _, peak in blows]
    forces = np.stack([np.where((t >= begins) & (t <= begins + w), peak * np.sin(np.pi * (t - begins) / w), 0.0) for (_, peak), w in zip(blows, widths)])
    last = int((begins + max(widths)) / step) + 2
    inverse, at = np.linalg.inv(structure.mass), np.stack([where for where, _ in blows], 1)
    # x' = A x + B u, u a parabola through the steps before, now and next
    a = np.block([[np.zeros((4, 4)), np.eye(4)], [-inverse @ structure.stiffness, -inverse @ structure.damping]])
    b = np.vstack([np.zeros((4, 4)), inverse])
    big = np.zeros((20, 20))
    big[:8, :8], big[:8, 8:12], big[8:12, 12:16], big[12:16, 16:20] = a * step, b * step, np.eye(4), np.eye(4)
    whole = expm(big)
    ahead, g1, g2, g3 = whole[:8, :8], whole[:8, 8:12], whole[:8, 12:16], whole[:8, 16:20]
    before, now, after = -g2 / 2 + g3, g1 - 2 * g3, g2 / 2 + g3
    read = np.stack([structure.points["3"], structure.points["4"]])
    by_state, by_force = read @ inverse @ np.hstack([-structure.stiffness, -structure.damping]), read @ inverse
    row = structure.across[COMPONENTS.index(law[1]) if law else 0]
    x, slider, g, g_before = np.zeros((8, n)), np.zeros(n), np.zeros(n), np.zeros(n)
    accelerations, most = np.zeros((count + 1, 2, n)), 0.0
    pairs = [-(matrix @ row)[:, None] for matrix in (before, now, after)]
    for k in range(count):
        y = ahead @ x
        if k < last:
            y += now @ at * forces[:, k] + after @ at * forces[:, k + 1] + (before @ at * forces[:, k - 1] if k else 0)
        if law:
            y += pairs[0] * g_before + pairs[1] * g
            g_before, g = g, g
            for _ in range(2):
                g, moved = restoring(law[0], law[2], row @ (y + pairs[2] * g)[:4], slider)
            slider, y = moved, y + pairs[2] * g
        x = y
        most = max(most, np.abs(row @ x[:4]).max())
        accelerations[k + 1] = by_state @ x - (by_force @ row)[:, None] * g
        if k < last:
            accelerations[k + 1] += by_force @ at * forces[:, k + 1]
    taps = signal.firwin(40 * OVER + 1, 0.44 * RATE, fs=RATE * OVER, window=("kaiser", 9))
    sampled = lambda values: signal.fftconvolve(values, taps, mode="same")[:count:OVER]
    return [sampled(f) for f in forces], [[sampled(accelerations[:, o, i]) for o in range(2)] for i in range(n)], most


def law_of(kind, component):
    """One that shifts the first bending mode by 2 % at 0.7 of the largest motion without it, by its first harmonic there."""
    structure = Structure()
    reach = 0.7 * simulated(structure, ("gap", component, {"clearance": 1.0, "stiffness": 1e-9}), [(structure.points["1"], 600.0)])[2]
    row = structure.across[COMPONENTS.index(component)]
    stiffer = 0.04 * structure.omega**2 / (row @ structure.shape) ** 2
    if kind == "cubic_stiffness":
        return {"stiffness3": stiffer / (0.75 * reach**2)}
    if kind == "friction":
        return {"slip_force": 0.15 * stiffer * reach, "stiffness": stiffer}
    cos = np.cos(np.linspace(0, 2 * np.pi, 4000, endpoint=False))
    clearance = 0.25 * reach
    return {"clearance": clearance, "stiffness": stiffer / (2 * np.mean(np.maximum(reach * cos - clearance, 0) * cos) / reach)}


def fixture(random):
    off = {key: TRUE[key] + STD[key] * random.standard_normal() for key in TRUE}
    known = lambda key: {"value": off[key], "std": STD[key]}
    body = lambda b: {"mass": known("m" + b), "inertia": known("j" + b), "x_cg": known("x" + b)}
    points = {n: {"body": b, "x": known("p" + n)} for n, b in (("1", "A"), ("2", "A"), ("3", "B"), ("4", "B"))}
    joints = {"J": {"from": "2", "to": "3", "beam": {"youngs_modulus": known("E"), "second_moment": known("I")}}}
    ratios = [{"value": z + 0.7 * RATIO_STD * random.standard_normal(), "std": RATIO_STD} for z in RATIOS]
    return {"name": "two blocks", "bodies": {b: body(b) for b in "AB"}, "points": points, "joints": joints, "damping": {"modal_ratios": ratios}}


def recorded(folder, structure, law, random, scatter=0.0):
    blows, struck = [], []
    for point in "12":
        for peak in [peak for peak in LEVELS for _ in range(REPEATS)]:
            where = motion("A", TRUE["p" + point] + scatter * random.standard_normal())
            blows.append((where, peak * random.uniform(0.92, 1.08)))
            struck.append(point)
    forces, accelerations, _ = simulated(structure, law, blows)
    noisy = lambda values, floor: values + random.standard_normal(len(values)) * np.hypot(floor, 5e-4 * np.abs(values).max())
    sets = []

    def add(node, values, quantity, unit, hit):
        time_axis = dict(abscissa_spacing=1, abscissa_min=0.0, abscissa_inc=1 / RATE, abscissa_spec_data_type=17, abscissa_axis_units_lab="s")
        ordinate = dict(ordinate_spec_data_type=quantity, ordinate_axis_units_lab=unit, orddenom_spec_data_type=0)
        channel = dict(rsp_node=int(node), rsp_dir=2, ref_node=0, ref_dir=0, ver_num=hit)
        sets.append(dict(type=58, func_type=1, binary=1, x=np.arange(len(values)) / RATE, data=values, **channel, **time_axis, **ordinate))

    for hit, point in enumerate(struck):
        add(point, noisy(forces[hit], 0.03), 13, "N", hit + 1)
        for node, values in zip("34", accelerations[hit]):
            add(node, noisy(values, 0.05), 12, "m/s^2", hit + 1)
    (folder / "hits.uff").unlink(missing_ok=True)
    pyuff.UFF(str(folder / "hits.uff")).write_sets(sets)
    (folder / "fixture.json").write_text(json.dumps(fixture(random), indent=1))


def asked(program, folder):
    words = [str(program), "diagnose", "fixture.json", "hits.uff", "-o", "out"]
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, env={**os.environ, "RAYON_NUM_THREADS": "1"})
    return json.loads((folder / "out" / "diagnosis.json").read_text()) if done.returncode == 0 else done.stderr


def cases(only, draws):
    for draw in range(draws):
        if "null" in only:
            yield "null", draw, None, {}
        if "scatter" in only:
            yield "scatter", draw, None, {"scatter": 1e-3}
        for kind in KINDS:
            for component in COMPONENTS:
                if "law" in only:
                    yield "law", draw, (kind, component), {}
                if "beside" in only:
                    for fault in ({"added": 0.03}, {"stiffer": 1.05}, {"stiffer": 1.10}):
                        yield "beside", draw, (kind, component), fault


def is_right(family, law, answer):
    found = [(f["kind"], f.get("dof")) for f in answer["findings"]]
    if law is None:
        if family == "scatter":
            return all(kind == "point_offset" for kind, _ in found)
        return not found and answer["verdict"] == "consistent"
    departed = bool(answer.get("departures"))
    as_stated = (answer["verdict"], departed) == ("explained", False)
    in_part = (answer["verdict"], departed) == ("partly_explained", True)
    return found == [law] and (as_stated if family == "law" else in_part)


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("program", type=pathlib.Path)
    arguments.add_argument("--draws", type=int, default=1)
    arguments.add_argument("--seed", type=int, default=1)
    arguments.add_argument("--only", nargs="*", default=["null", "law", "beside", "scatter"])
    arguments.add_argument("--keep", type=pathlib.Path)
    given = arguments.parse_args()
    keep, program = given.keep or pathlib.Path(tempfile.mkdtemp()), given.program.resolve()
    sizes = {(kind, component): law_of(kind, component) for kind in KINDS for component in COMPONENTS}
    rows, held, of = {}, 0, 0
    for family, draw, law, fault in cases(given.only, given.draws):
        name = "-".join([family, str(draw), *(law or ()), *(f"{key}{value}" for key, value in fault.items())])
        random = np.random.default_rng([given.seed, zlib.crc32(name.encode())])
        folder = keep / name
        folder.mkdir(parents=True, exist_ok=True)
        linear = {key: value for key, value in fault.items() if key != "scatter"}
        recorded(folder, Structure(**linear), (*law, sizes[law]) if law else None, random, fault.get("scatter", 0.0))
        begun = time.time()
        answer = asked(program, folder)
        right = not isinstance(answer, str) and is_right(family, law, answer)
        rows.setdefault(family, []).append(right)
        if isinstance(answer, str):
            print(f"{name:48} no answer: {answer.strip()[-150:]}", flush=True)
            continue
        for finding in answer["findings"] if right and law else []:
            for parameter, size in sizes[law].items():
                low, high = finding["parameters"][parameter]["ci95"]
                held, of = held + (low <= size <= high), of + 1
        told = " ".join(f"{f['kind']}/{f.get('dof')}:{f['probability']:.2f}" for f in answer["findings"])
        departed = " ".join(f"{d['path']}:{d['deviations']:+.0f}" for d in answer.get("departures", [])[:2])
        print(f"{name:48} {'right' if right else 'WRONG':6} {answer['verdict']:17} {told} {departed} {time.time() - begun:.1f} s", flush=True)
    for family, all_of in rows.items():
        print(f"{family}: {sum(all_of)} of {len(all_of)}")
    print(f"sizes in their 95 % intervals: {held} of {of}")
    sys.exit(0 if all(all(all_of) for all_of in rows.values()) else 1)


if __name__ == "__main__":
    main()
