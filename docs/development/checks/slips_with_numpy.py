#!/usr/bin/env python3
"""Makes slips of a test on two blocks and a strip, measures them, and asks the program what is wrong.

    python3 docs/development/checks/slips_with_numpy.py PROGRAM [--cases 7] [--seed 1] [--only KIND …] [--keep DIR]

Nothing of the program's own mechanics is used: two rigid blocks and a massless strip, modal or structural damping, written here with NumPy. What is stated lies within its deviations of what is; 2.5 to 1200 Hz,
H1 and coherence of ten blows with 0.3 % noise, or hits over time. Kinds:

    null    nothing: `consistent`
    hammer  the hammer strikes 2 to 6 mm beside the sensor at its point: an offset of that reference, with 0.9
    sensor  the sensor sits 2 to 6 mm beside the impacts, or feels 5 % of a direction across, 20 mm above the axis: an offset of that response, with 0.9
    losses  damping is structural, of 0.8 to 1.2 %, and the ratios stated are half of that: a loss factor of the joint, with 0.9, within a tenth
    record  one record in g, turned round, or a fifth too small: not `consistent`, and that record named
    joint   structural damping of 1 or 2 %, four FRFs: (k - true)/stated deviation of k11, k12, k22
    hits    hits of two strengths whose amplifiers rest elsewhere before each: no change with amplitude
    window  such hits under an exponential window of 4 to 8 1/s: that window, with 0.8, within a twentieth
    column  a frame of three storeys one of whose columns is softer by a quarter to a half, ratios read with it: its stiffness, with 0.9, within a hundredth
    second  the far end of the strip turns on the block, and two FRFs do not tell; a second test with 200 g on A, its damping 5 % higher: `plan` says that end, with 0.9, or has nothing left to separate
    moved   natural frequencies off by 0.3 %, shapes by 1 %; a sensor of 5 to 15 g that goes from response to response, or sits at one: its mass within a tenth, with 0.8
    changed such errors in both of two states, and a channel that is turned round or off by a tenth to a fifth in the second: that gain within half a per cent, with 0.9
    bench   natural frequencies off by 0.3 %, shapes of elastic modes by 1 %, structural damping, sensors 0.7 mm and impacts 1 mm beside their points: nothing, by itself `consistent`; the same since a baseline with other places; or 80 to 150 g on A: that alone, its mass within its interval
    roved   the same as `bench`, with a sensor of 4 to 12 g that goes from response to response and is stated to 2 %
    ended   records of 0.4 s whose end comes while 3 to 20 % of a mode still rings, blows 10 ms after their begin and 0.5 to 1.1 ms long by point, FRFs of them: nothing, by itself `consistent`; the same since a baseline that began otherwise; or 20 to 60 g on A: that alone, with 0.9, its mass within its interval
    cut     the same as `ended`, but for errors as in `bench`, and 80 to 150 g: nothing, and that mass within its interval, with nothing else of 0.5
    warm    the same as `cut`, but for natural frequencies up to 0.03 % higher or lower, by reference, as the structure warms up and cools down
    foam    a free fixture, and a spring with a dashpot under either block: both supports, within a tenth, with 0.8

Ends with status 1 where one is not right, or where scores of `joint` have a root mean square above 1.6.
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

LINES = 2.5 * np.arange(1, 481)
ACROSS = [("4", "1"), ("3", "1"), ("4", "2"), ("3", "2")]
ALL = [*ACROSS, ("1", "1"), ("1", "4")]
GRAVITY = 9.80665


def stated(random):
    """A fixture file of two blocks."""
    quantity = lambda value, std: {"value": float(value), "std": float(std)}
    masses, lengths, gap = random.uniform(0.9, 2.5, 2), random.uniform([0.05, 0.06], [0.08, 0.1]), random.uniform(0.05, 0.08)
    inertias = masses * (lengths**2 + random.uniform(0.03, 0.06) ** 2) / 12
    second = random.uniform(2.5e-10, 4.5e-10)
    body = lambda at, x: {"mass": quantity(masses[at], 1e-3 * masses[at]), "inertia": quantity(inertias[at], 5e-3 * inertias[at]), "x_cg": quantity(x, 1e-4)}
    point = lambda own, x, std: {"body": own, "x": quantity(x, std)}
    return {
        "bodies": {"A": body(0, -lengths[0] / 2), "B": body(1, gap + lengths[1] / 2)},
        "points": {"1": point("A", -0.93 * lengths[0], 2e-4), "2": point("A", 0, 1e-4), "3": point("B", gap, 1e-4), "4": point("B", gap + 0.94 * lengths[1], 2e-4)},
        "joints": {"J": {"from": "2", "to": "3", "beam": {"youngs_modulus": quantity(2.07e11, 2e9), "second_moment": quantity(second, 0.01 * second)}}},
        "damping": {"modal_ratios": [quantity(0.004, 1e-3), quantity(0.005, 1e-3)]},
    }


def drawn(fixture, random):
    """The same with every quantity drawn, by 0.7 of its deviation."""
    if isinstance(fixture, dict) and "std" in fixture:
        return fixture["value"] + 0.7 * fixture["std"] * random.standard_normal()
    if isinstance(fixture, dict):
        return {key: drawn(value, random) for key, value in fixture.items()}
    return [drawn(value, random) for value in fixture] if isinstance(fixture, list) else fixture


class Structure:
    def __init__(self, truth, turns=np.inf, added=0.0):
        """`turns` is the rotational stiffness between strip and block at point 3, `added` a mass on A at x = 0."""
        self.truth = truth
        a, b = truth["bodies"]["A"], truth["bodies"]["B"]
        self.mass = np.diag([a["mass"], a["inertia"], b["mass"], b["inertia"]])
        start, end = self.row("2"), self.row("3")
        length = truth["points"]["3"]["x"] - truth["points"]["2"]["x"]
        beam = truth["joints"]["J"]["beam"]
        bending = beam["youngs_modulus"] * beam["second_moment"]
        self.joint = bending / length**3 * np.array([[12, -6 * length], [-6 * length, 4 * length**2]])
        compliance = np.linalg.inv(self.joint)
        compliance[1, 1] += 1 / turns
        self.joint = np.linalg.inv(compliance)
        at_zero = np.array([1, -a["x_cg"], 0, 0])
        self.mass += added * np.outer(at_zero, at_zero)
        rotation = np.array([[0, 1, 0, 0], [0, 0, 0, 1]])
        across = np.array([end - start - length * rotation[0], rotation[1] - rotation[0]])
        self.stiffness = across.T @ self.joint @ across
        root = np.linalg.inv(np.linalg.cholesky(self.mass)).T
        squares, shapes = np.linalg.eigh(root.T @ self.stiffness @ root)
        self.frequencies, self.shapes = np.sqrt(np.abs(squares)), root @ shapes
        self.ratios = np.array([0, 0, *truth["damping"]["modal_ratios"]]) if "modal_ratios" in truth["damping"] else np.zeros(4)

    def row(self, name, beside=0.0):
        point = self.truth["points"][name]
        arm = point["x"] + beside - self.truth["bodies"][point["body"]]["x_cg"]
        return np.array([1, arm, 0, 0]) if point["body"] == "A" else np.array([0, 0, 1, arm])

    def accelerances(self, pairs, loss=0.0, beside=None):
        """`beside` is a point with how far its sensor and its impacts are from where it is stated."""
        s = 2j * np.pi * LINES
        modes = self.frequencies**2 * (1 + 1j * loss) * (self.frequencies > 60)
        values = {}
        for response, reference in pairs:
            [read, struck] = [self.row(name, dx if beside and name == beside[0] else 0.0) for name, dx in zip((response, reference), beside[1] if beside else (0.0, 0.0))]
            residues = (read @ self.shapes) * (struck @ self.shapes)
            values[response, reference] = s**2 * sum(r / (s**2 + 2 * z * w * s + m) for r, z, w, m in zip(residues, self.ratios, self.frequencies, modes))
        return values

    def erring(self, random):
        """Natural frequencies are off by 0.3 %, shapes at each point by 1 %, whatever the fixture says."""
        self.frequencies = self.frequencies * (1 + 0.003 * random.standard_normal(4) * (self.frequencies > 60))
        self.off = {name: 1 + 0.01 * random.standard_normal(4) for name in self.truth["points"]}
        plain = self.row
        self.row = lambda name, beside=0.0: plain(name, beside) @ self.shapes @ np.diag(self.off[name]) @ np.linalg.inv(self.shapes)
        return self

    def held(self, pairs, springs):
        """On springs with dashpots, each a (row, N/m, N·s/m)."""
        modal = np.linalg.inv(self.shapes)
        damping = modal.T @ np.diag(2 * self.ratios * self.frequencies) @ modal
        stiffness = self.stiffness.copy()
        for row, spring, dashpot in springs:
            stiffness, damping = stiffness + spring * np.outer(row, row), damping + dashpot * np.outer(row, row)
        s = 2j * np.pi * LINES
        receptances = np.linalg.inv(s[:, None, None] ** 2 * self.mass + s[:, None, None] * damping + stiffness)
        return {(o, i): s**2 * (receptances @ self.row(i) @ self.row(o)) for o, i in pairs}


def measured(exact, random, blows=10, noise=0.003):
    frfs, coherences = {}, {}
    for pair, values in exact.items():
        deviation = noise * np.sqrt(blows / 2 * np.mean(abs(values) ** 2))
        each = values + deviation * (random.standard_normal((blows, len(values))) + 1j * random.standard_normal((blows, len(values))))
        frfs[pair] = each.mean(0)
        coherences[pair] = abs(frfs[pair]) ** 2 / (abs(each) ** 2).mean(0)
    return frfs, coherences


def dataset(kind, pair, abscissa, values, what):
    response, reference = pair
    is_time, is_complex = kind == 1, np.iscomplexobj(values)
    unit = {4: (12, 13, "m/s^2", "N"), 6: (0, 0, "NONE", "NONE"), 1: (12 if what == "response" else 13, 0, "m/s^2" if what == "response" else "N", "NONE")}[kind]
    return {
        "type": 58, "func_type": kind, "rsp_node": int(response), "rsp_dir": 2, "ref_node": int(reference), "ref_dir": 2, "data": values, "x": abscissa, "id1": what, "id2": "NONE",
        "id3": "NONE", "id4": "NONE", "id5": "averages 10" if kind in (4, 6) else "NONE", "ver_num": 0, "load_case_id": 0, "rsp_ent_name": "NONE", "ref_ent_name": "NONE",
        "abscissa_spacing": 1, "abscissa_min": abscissa[0], "abscissa_inc": abscissa[1] - abscissa[0], "num_pts": len(values), "z_axis_value": 0,
        "abscissa_spec_data_type": 17 if is_time else 18, "abscissa_len_unit_exp": 0, "abscissa_force_unit_exp": 0, "abscissa_temp_unit_exp": 0,
        "ordinate_spec_data_type": unit[0], "orddenom_spec_data_type": unit[1], "ord_data_type": 6 if is_complex else 4, "abscissa_axis_lab": "x", "abscissa_axis_units_lab": "s" if is_time else "Hz",
        "ordinate_axis_lab": "y", "ordinate_axis_units_lab": unit[2], "orddenom_axis_lab": "y", "orddenom_axis_units_lab": unit[3], "binary": 1,
    }


def write(path, datasets):
    path.unlink(missing_ok=True)
    file = pyuff.UFF(str(path))
    for each in datasets:
        file.write_sets(each, "add")


def write_frfs(path, exact, random):
    frfs, coherences = measured(exact, random)
    write(path, [dataset(kind, pair, LINES, all[pair], "x") for pair in frfs for kind, all in ((4, frfs), (6, coherences))])


def run(program, folder, *words):
    ran = subprocess.run([program, *words, "--json", "-o", str(folder / "out")], cwd=folder, capture_output=True, text=True, env=dict(os.environ, RAYON_NUM_THREADS="1"))
    if ran.returncode:
        sys.exit(f"{folder}: {ran.stderr.strip()}")
    return json.loads(ran.stdout)


def case(kind, number, seed, program, folder):
    """One line of what came of it, and whether that is right (`joint`: the three scores)."""
    random = np.random.default_rng([seed, number, sum(map(ord, kind))])
    fixture = stated(random)
    if kind == "joint":
        fixture["damping"] = {"loss_factor": {"value": float(random.choice([0.01, 0.02])), "std": 0.003}}
    (folder / "fixture.json").write_text(json.dumps(fixture))
    structure = Structure(drawn(fixture, random))
    if kind == "joint":
        write_frfs(folder / "test.uff", structure.accelerances(ACROSS, loss=structure.truth["damping"]["loss_factor"]), random)
        joint = run(program, folder, "decompose", "fixture.json", "test.uff")["joint"]
        places = [(0, 0), (0, 1), (1, 1)]
        scores = np.array([(joint["stiffness"][i][j] - structure.joint[i, j]) / joint["std"]["stiffness"][i][j] for i, j in places])
        return f"{joint['law']}, {np.round(scores, 2)}", scores
    if kind == "column":
        return column(random, program, folder)
    if kind == "second":
        return second(fixture, structure.truth, random, program, folder)
    if kind in ("bench", "roved", "ended", "cut", "warm"):
        way = {"bench": bench, "roved": functools.partial(bench, roves=True), "ended": ended, "cut": functools.partial(ended, errs=True), "warm": functools.partial(ended, errs=True, drifts=True)}[kind]
        return way(fixture, structure.truth, number, random, program, folder)
    if kind in ("moved", "changed", "foam"):
        return {"moved": moved, "changed": changed, "foam": foam}[kind](structure, number, random, program, folder)
    decay = float(random.uniform(4, 8)) if kind == "window" else 0.0
    if kind in ("hits", "window"):
        write(folder / "test.uff", hits(structure, random, decay))
    else:
        dx = float(random.choice([-1, 1]) * (0.001 if kind == "sensor" and number % 2 else random.uniform(0.002, 0.006)))
        beside = {"hammer": ("1", (0.0, dx)), "sensor": ("1", (dx, 0.0))}.get(kind)
        loss = float(random.uniform(0.008, 0.012)) if kind == "losses" else 0.0
        if loss:
            structure.ratios = 0 * structure.ratios
        exact = structure.accelerances(ALL, loss, beside)
        odd = ALL[number % len(ALL)]
        if kind == "record":
            exact[odd] = exact[odd] * [1 / GRAVITY, -1.0, 0.8][number % 3]
        write_frfs(folder / "test.uff", exact, random)
    answer = run(program, folder, "diagnose", "fixture.json", "test.uff")
    names = [(f["kind"], f["place"], round(f["probability"], 2)) for f in answer["findings"]]
    said = f"{answer['verdict']} {names}"
    if kind in ("null", "hits"):
        return said, answer["verdict"] == "consistent"
    if kind == "window":
        value = answer["findings"][0]["parameters"]["decay"]["value"] if [name[0] for name in names] == ["exponential_window"] else np.nan
        return f"{said}, {value / decay:.3f} of what it is", abs(value / decay - 1) < 0.05 and names[0][2] >= 0.8
    missed = answer["fit"]["nrmse"]
    said += f", misses {missed['refitted']:.3f} refitted, {missed['repaired']:.3f} repaired"
    if kind in ("hammer", "sensor", "losses"):
        wanted = {"hammer": ("point_offset", "reference 1"), "sensor": ("point_offset", "response 1"), "losses": ("loss_factor", "J")}[kind]
        size = next(iter(answer["findings"][0]["parameters"].values()))["value"] if names else np.nan
        is_named = len(names) == 1 and names[0][:2] == wanted and names[0][2] >= 0.9
        return said, is_named and (not loss or abs(size / loss - 1) < 0.1)
    named = f"FRF {odd[0]}/{odd[1]} is" in answer["says"] and "times what the fixture makes of it" in answer["says"]
    # A record that is its reference's only one is that reference; one among several is named by itself.
    alone = any(kind == "channel_gain" and p > 0.9 for kind, _, p in names)
    return said + (", record named" if named else ""), answer["verdict"] != "consistent" and (named or alone)


def found_by(answer, size):
    return [(f["kind"], f["place"], round(f["probability"], 2), float(f"{f['parameters'][size]['value']:.5g}") if size in f["parameters"] else None) for f in answer["findings"]]


def moved(structure, number, random, program, folder):
    structure, mass, only = structure.erring(random), float(random.uniform(0.005, 0.015)), [None, "3", "4"][number % 3]
    pairs = [("1", "1"), ("3", "1"), ("4", "1"), ("3", "2"), ("4", "2")]
    exact = structure.accelerances(pairs)
    for response, reference in pairs:
        if only in (None, response):
            exact[response, reference] = exact[response, reference] / (1 + mass * structure.accelerances([(response, response)])[response, response])
    write_frfs(folder / "test.uff", exact, random)
    answer = run(program, folder, "diagnose", "fixture.json", "test.uff")
    found, place = found_by(answer, "mass"), f"response {only}" if only else "responses"
    is_right = len(found) == 1 and found[0][:2] == ("sensor_mass", place) and found[0][2] >= 0.8 and abs(found[0][3] / mass - 1) < 0.1
    return f"{answer['verdict']} {found}, {1000 * mass:.2f} g at {place}", is_right


def changed(structure, number, random, program, folder):
    structure, factor = structure.erring(random), -1.0 if number % 2 else float(1 + random.choice([-1, 1]) * random.uniform(0.1, 0.2))
    exact = structure.accelerances(ALL)
    write_frfs(folder / "healthy.uff", exact, random)
    write_frfs(folder / "test.uff", {pair: values * (factor if pair[0] == "4" else 1.0) for pair, values in exact.items()}, random)
    answer = run(program, folder, "diagnose", "fixture.json", "--baseline", "healthy.uff", "test.uff")
    found = found_by(answer, "factor")
    is_right = len(found) == 1 and found[0][:2] == ("channel_gain", "response 4") and found[0][2] >= 0.9 and abs(found[0][3] / factor - 1) < 0.005
    return f"{answer['verdict']} {found}, factor {factor:.4f}", is_right


def bench(fixture, truth, number, random, program, folder, roves=False):
    """Blocks as real ones are, struck as real ones are: nothing, nothing since a baseline, and a lump in turn. Where it `roves`, with a sensor that loads them where it is."""
    for point in fixture["points"].values():
        point["x"] = point["x"]["value"]
    sensor = float(random.uniform(0.004, 0.012)) if roves else 0.0
    if roves:
        fixture["physics"] = [{"kind": "sensor_mass", "place": "responses", "mass": {"value": sensor * (1 + 0.02 * float(random.standard_normal())), "std": 0.02 * sensor}}]
    (folder / "fixture.json").write_text(json.dumps(fixture))
    mass = float(random.uniform(0.08, 0.15)) if number % 3 == 2 else 0.0
    structure = Structure(truth, added=mass).erring(random)
    for off in structure.off.values():
        off[structure.frequencies < 60] = 1.0
    names = {"baseline.uff": number % 3 == 1, "test.uff": True}
    for name in [name for name, is_made in names.items() if is_made]:
        sensors, impacts = ({point: 1e-3 * far * random.standard_normal() for point in truth["points"]} for far in (0.7, 1.0))
        s, exact = 2j * np.pi * LINES, {}
        squares = structure.frequencies**2 * (1 + 2j * structure.ratios) * (structure.frequencies > 60)
        for response, reference in ALL:
            read, struck = structure.row(response, sensors[response]) @ structure.shapes, structure.row(reference, impacts[reference]) @ structure.shapes
            driven, own = (s**2 * sum(r / (s**2 + m) for r, m in zip(read * other, squares)) for other in (struck, read))
            exact[response, reference] = driven / (1 + sensor * own)
        write_frfs(folder / name, exact, random)
    baseline = ["--baseline", "baseline.uff"] if names["baseline.uff"] else []
    answer = run(program, folder, "diagnose", "fixture.json", *baseline, "test.uff")
    found = found_by(answer, "mass")
    named = [finding for finding in found if finding[2] >= 0.5]
    intervals = [f["parameters"]["mass"]["ci95"] for f in answer["findings"] if f["kind"] == "added_mass"]
    holds = bool(intervals) and intervals[0][0] <= mass <= intervals[0][1]
    is_mass = len(named) == 1 and named[0][:2] == ("added_mass", "A") and holds
    return f"{answer['verdict']} {found} {np.round(intervals, 4)}, {mass:.4f} kg", is_mass if mass else answer["verdict"] == "consistent"


def foam(structure, number, random, program, folder):
    stiffness, dashpots = 10 ** random.uniform(4, 5, 2), random.uniform(30, 80, 2)
    rows = [np.array([1, random.uniform(-0.01, 0.01), 0, 0]), np.array([0, 0, 1, random.uniform(-0.01, 0.01)])]
    write_frfs(folder / "test.uff", structure.held(ALL, list(zip(rows, stiffness, dashpots))), random)
    answer = run(program, folder, "diagnose", "fixture.json", "test.uff")
    found = found_by(answer, "stiffness")
    by_body = {f[1]: f for f in found if f[0] == "support"}
    is_right = len(found) == 2 and sorted(by_body) == ["A", "B"] and all(by_body[b][2] >= 0.8 and abs(by_body[b][3] / k - 1) < 0.1 for b, k in zip("AB", stiffness))
    return f"{answer['verdict']} {found}, {stiffness.round()} N/m", is_right


def ended(fixture, truth, number, random, program, folder, errs=False, drifts=False):
    """FRFs as an analyser makes them of records that end too early: spectra of time signals that were cut off. Where it `errs`, of a bench as benches are; where it `drifts`, of a structure that is stiffer or softer by reference."""
    longest = random.uniform(1.6, 3.5)
    mass = float(random.uniform(*(0.08, 0.15) if errs else (0.02, 0.06))) if number % 3 == 2 else 0.0
    structure = Structure(truth, added=mass)
    elastic = structure.frequencies > 60
    if errs:
        structure.erring(random)
        for off in structure.off.values():
            off[~elastic] = 1.0
        for point in fixture["points"].values():
            point["x"] = point["x"]["value"]
    least = structure.frequencies[elastic].min()
    # Of the mode that rings longest e^(-longest) is left.
    structure.ratios = elastic * longest / (0.4 * least) * np.where(structure.frequencies > least, random.uniform(0.6, 1.4), 1.0)
    for ratio, value in zip(fixture["damping"]["modal_ratios"], structure.ratios[elastic]):
        ratio["value"] = float(value * (1 + 0.2 * random.standard_normal()))
        ratio["std"] = 0.25 * ratio["value"]
    (folder / "fixture.json").write_text(json.dumps(fixture))
    for name, begin in [("baseline.uff", 0.006), ("test.uff", 0.01)][0 if number % 3 == 1 else 1 :]:
        blows = dict(zip("124", random.uniform(6e-4, 1e-3) * random.uniform(0.9, 1.1, 3)))
        beside = [{point: far * random.standard_normal() if errs else 0.0 for point in truth["points"]} for far in (7e-4, 1e-3)]
        warmer = dict(zip("124", 1 + 3e-4 * random.uniform(-1, 1, 3))) if drifts else {}
        write_frfs(folder / name, cut_off(structure, begin, blows, beside, warmer), random)
    baseline = ["--baseline", "baseline.uff"] if number % 3 == 1 else []
    answer = run(program, folder, "diagnose", "fixture.json", *baseline, "test.uff")
    found = [name for name in found_by(answer, "mass") if name[2] >= 0.5 or not errs]
    holds = [low <= mass <= high for low, high in (f["parameters"]["mass"]["ci95"] for f in answer["findings"] if f["kind"] == "added_mass")]
    is_mass = len(found) == 1 and found[0][:2] == ("added_mass", "A") and found[0][2] >= 0.9 - 0.4 * errs and holds[0]
    return f"{answer['verdict']} {found}, {1000 * mass:.1f} g, {np.exp(-longest):.3f} left", is_mass if mass else answer["verdict"] == "consistent"


def cut_off(structure, begin, blows, beside, warmer, rate=5120.0, samples=2048):
    """Accelerances by records of `samples`, blows beginning at `begin` that last for so long by reference, sensors and impacts so far `beside` their points, natural frequencies so many times what they are by reference where it is `warmer`; the motion itself is that of a record 64 times as long."""
    length = 64 * samples
    s, time = 2j * np.pi * np.fft.rfftfreq(length, 1 / rate), np.arange(length) / rate
    exact = {}
    for response, reference in ALL:
        force = np.where((time > begin) & (time < begin + blows[reference]), np.sin(np.pi * (time - begin) / blows[reference]) ** 2, 0.0)
        spectrum = np.fft.rfft(force)
        residues = (structure.row(response, beside[0][response]) @ structure.shapes) * (structure.row(reference, beside[1][reference]) @ structure.shapes)
        frequencies = warmer.get(reference, 1.0) * structure.frequencies
        modes = [s**2 / (s**2 + 2 * z * w * s + w * w) if w > 60 else np.ones_like(s) for z, w in zip(structure.ratios, frequencies)]
        signal = np.fft.irfft(sum(r * mode for r, mode in zip(residues, modes)) * spectrum, length)[:samples]
        exact[response, reference] = (np.fft.rfft(signal) / np.fft.rfft(force[:samples]))[1 : len(LINES) + 1]
    return exact


def column(random, program, folder):
    """A frame of three storeys on columns, and what is said of the one that is softer."""
    masses, stiffness, factor = random.uniform(3, 4, 3), random.uniform(4e4, 8e4), random.uniform(0.5, 0.75)
    ratios, soft = [0.010, 0.012, 0.015], int(random.integers(2))
    quantity = lambda value, std: {"value": float(value), "std": float(std)}
    columns = lambda a, b: {"from": a, "to": b, "stiffness": [[quantity(stiffness, 0.05 * stiffness), 0.0], [0.0, 0.0]]}
    fixture = {
        "bodies": {f"F{at + 1}": {"mass": quantity(mass, 2e-3 * mass), "rotates": False} for at, mass in enumerate(masses)},
        "points": {str(at): {"body": f"F{at}", "x": quantity(0.3 * at, 1e-4)} for at in (1, 2, 3)},
        "joints": {"J12": columns("1", "2"), "J23": columns("2", "3")},
        "supports": {"ground": {"point": "1", "stiffness": quantity(stiffness, 0.05 * stiffness)}},
        "damping": {"modal_ratios": [quantity(ratio, 0.25 * ratio) for ratio in ratios]},
    }
    (folder / "fixture.json").write_text(json.dumps(fixture))
    truth = drawn(fixture, random)
    true = [truth["supports"]["ground"]["stiffness"], *(truth["joints"][name]["stiffness"][0][0] for name in ("J12", "J23"))]
    true[1 + soft] *= factor
    ground, first, second = true
    matrix = np.array([[ground + first, -first, 0], [-first, first + second, -second], [0, -second, second]])
    root = np.diag([truth["bodies"][f"F{at}"]["mass"] ** -0.5 for at in (1, 2, 3)])
    squares, shapes = np.linalg.eigh(root @ matrix @ root)
    shapes, s, all = root @ shapes, 2j * np.pi * 0.1 * np.arange(20, 480), {}
    for response, reference in [("1", "1"), ("2", "1"), ("3", "1"), ("3", "3")]:
        residues = shapes[int(response) - 1] * shapes[int(reference) - 1]
        all[response, reference] = sum(r * s**2 / (s**2 + 2 * z * np.sqrt(m) * s + m) for r, z, m in zip(residues, truth["damping"]["modal_ratios"], squares))
    frfs, coherences = measured(all, random)
    write(folder / "test.uff", [dataset(kind, pair, s.imag / 2 / np.pi, of[pair], "x") for pair in frfs for kind, of in ((4, frfs), (6, coherences))])
    answer = run(program, folder, "diagnose", "fixture.json", "test.uff")
    joint = ("J12", "J23")[soft]
    found = [(f["kind"], f["place"], round(f["probability"], 2), next(iter(f["parameters"].values()))["value"]) for f in answer["findings"]]
    stated = {"quantity_error": 1.0, "stiffness_change": stiffness}
    is_right = len(found) == 1 and joint in found[0][1] and found[0][2] >= 0.9 and abs(found[0][3] * stated.get(found[0][0], np.nan) / true[1 + soft] - 1) < 0.01
    return f"{answer['verdict']} {found}, {joint} is {true[1 + soft]:.0f} N/m", is_right


def second(fixture, truth, random, program, folder):
    """What `plan` says of two tests together, the second with a mass and with damping of its own."""
    turns, pairs = float(random.uniform(1.5e4, 4e4)), [("3", "1"), ("4", "1")]
    other = fixture | {"physics": [{"kind": "added_mass", "place": "A", "x": {"value": 0.0, "std": 2e-4}, "mass": {"value": 0.2, "std": 1e-4}}]}
    (folder / "with-mass.json").write_text(json.dumps(other))
    write_frfs(folder / "test.uff", Structure(truth, turns).accelerances(pairs), random)
    structure = Structure(truth, turns, 0.2)
    structure.ratios = 1.05 * structure.ratios
    write_frfs(folder / "mass-test.uff", structure.accelerances(pairs), random)
    words = ["plan", "fixture.json", "test.uff", "--second-test", "with-mass.json", "mass-test.uff", "--json"]
    ran = subprocess.run([program, *words], cwd=folder, capture_output=True, text=True, env=dict(os.environ, RAYON_NUM_THREADS="1"))
    if ran.returncode:
        why = ran.stderr.strip().splitlines()[-1]
        return why, "nothing to separate" in why and "point 3 in rotation" in why
    answer = json.loads(ran.stdout)
    names = [(name["kind"], name["place"], name.get("dof"), round(name["probability"], 2), round(name["before"], 2)) for name in answer["names"][:2]]
    return f"{names}, chi2 per degree of freedom {answer['chi2_per_dof']:.2f}", names[0][:3] == ("interface_compliance", "3", "rotation") and names[0][3] >= 0.9


def hits(structure, random, decay=0.0, rate=5120.0, samples=8192):
    """Five blows at points 1 and 2 each, two sensors (under a window a third at point 1), offsets of half a m/s² that differ from hit to hit, or none under an exponential window; datasets. Spectra of a record 32 times as long, in which all rings out."""
    length, datasets = 32 * samples, []
    s = 2j * np.pi * np.fft.rfftfreq(length, 1 / rate)
    time = np.arange(length) / rate
    elastic = structure.frequencies * (structure.frequencies > 60)
    with np.errstate(invalid="ignore", divide="ignore"):
        modes = [np.where(s == 0, 0, s**2 / (s**2 + 2 * z * w * s + w * w)) if w else np.ones_like(s) for z, w in zip(structure.ratios, elastic)]
    for at, reference in enumerate("12"):
        for blow in range(5):
            peak, begin = random.uniform(80, 160), (50 + random.uniform()) / rate
            force = peak * np.where((time > begin) & (time < begin + 8e-4), np.sin(np.pi * (time - begin) / 8e-4) ** 2, 0.0)
            spectrum = np.fft.rfft(force)
            signals = {"force": force[:samples] + 2e-4 * peak * random.standard_normal(samples)}
            for response in "341" if decay else "34":
                residues = (structure.row(response) @ structure.shapes) * (structure.row(reference) @ structure.shapes)
                signal = np.fft.irfft(sum(r * mode for r, mode in zip(residues, modes)) * spectrum, length)[:samples]
                offset = 0.0 if decay else 0.5 * random.standard_normal()
                signals[response] = signal + 2e-3 * np.sqrt(np.mean(signal**2)) * random.standard_normal(samples) + offset
            for name, signal in signals.items():
                signal = signal * np.exp(-decay * time[:samples])
                pair = (reference if name == "force" else name, reference)
                each = dataset(1, pair, time[:samples], signal, "force" if name == "force" else "response")
                datasets.append(each | {"ver_num": 5 * at + blow + 1})
    return datasets


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=lambda path: str(pathlib.Path(path).resolve()))
    parser.add_argument("--cases", type=int, default=7)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", nargs="*", default=["null", "hammer", "sensor", "losses", "record", "joint", "hits", "window", "column", "second", "moved", "changed", "bench", "roved", "ended", "cut", "warm", "foam"])
    parser.add_argument("--keep", type=pathlib.Path)
    arguments = parser.parse_args()
    is_right = True
    for kind in arguments.only:
        results = []
        for number in range(arguments.cases):
            with tempfile.TemporaryDirectory() as temporary:
                folder = (arguments.keep or pathlib.Path(temporary)) / f"{kind}-{number:02}"
                folder.mkdir(parents=True, exist_ok=True)
                said, result = case(kind, number, arguments.seed, arguments.program, folder)
            results.append(result)
            print(f"{kind}-{number:02}: {said}", flush=True)
        if kind == "joint":
            scores = np.array(results)
            squares = np.sqrt((scores**2).mean(0))
            is_right &= bool((squares < 1.6).all())
            print(f"{kind}: root mean square of (k - true)/deviation {np.round(squares, 2)}, largest {np.abs(scores).max():.2f}")
        else:
            is_right &= all(results)
            print(f"{kind}: {sum(results)} of {len(results)} right")
    sys.exit(0 if is_right else 1)


if __name__ == "__main__":
    main()
