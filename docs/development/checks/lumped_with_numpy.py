#!/usr/bin/env python3
"""Draws lumped structures, hides physics in them, measures them, and asks the program what was hidden.

    python3 docs/development/checks/lumped_with_numpy.py PROGRAM [--cases 30] [--seed 1] [--only KIND|FAMILY|N …] [--keep DIR]

Nothing of the program's own mechanics is used: the dynamic stiffness is written here from what the effects mean, with NumPy; non-linear motion is integrated over time. Two blocks and a strip, three blocks and
two strips, or a frame of storeys; what is stated lies within its deviations of what is; 3 to 9 FRFs on 400 lines, H1 and coherence of 5 to 20 hits with 0.25 to 2 % noise, or hits over time. A hidden
effect is drawn until it shows: by three times the Δχ² of 50 that limits.md calls the least, to first order and past what the tolerances (and the other effect) imitate.
Right: every hidden effect has a finding of its kind, place and dof, or what was found, refitted here from where the program left it, is within 9 in χ² of the truth refitted alike, as the shared cases have it.
Wrong: a finding that is neither. Told apart from a miss, where nothing false is said. Sizes: stated 95 % intervals of right findings that hold what was drawn. Seconds are processor time, one thread.
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
import warnings

import numpy as np
import pyuff
from scipy.optimize import least_squares
from scipy.signal import butter, sosfiltfilt

LINES = 2.5 * np.arange(1, 401)
SHOWS = 50.0  # Δχ² from which an effect shows (docs/guide/limits.md)
ALIKE = 9.0  # Δχ² within which two names are each other's
ELEMENTS = 8  # of a joint with mass
# First free-free bending mode of a uniform bar: cosh(b)·cos(b) = 1.
BENDING = 4.730040744862704


# --- mechanics -------------------------------------------------------------------------------------------------------------------------------------------------------

def number(given):
    return given["value"] if isinstance(given, dict) else given


def bar_shape(x, centre, length):
    """Deflection and slope of a free-free bar's first bending mode, of unit mean square; past its ends along the tangent."""
    ratio = (np.cosh(BENDING) - np.cos(BENDING)) / (np.sinh(BENDING) - np.sin(BENDING))
    inside = min(max((x - centre) / length + 0.5, 0.0), 1.0)
    z = BENDING * inside
    deflection = np.cosh(z) + np.cos(z) - ratio * (np.sinh(z) + np.sin(z))
    slope = BENDING / length * (np.sinh(z) - np.sin(z) - ratio * (np.cosh(z) + np.cos(z)))
    return deflection + slope * (x - centre - (inside - 0.5) * length), slope


def strip_matrix(bending, length, shear=np.inf):
    """4×4 stiffness of a strip on (y, θ) of both ends, Timoshenko where it has a shear stiffness."""
    phi = 12 * bending / (shear * length**2)
    a, l = bending / (length**3 * (1 + phi)), length
    near, far = (4 + phi) * l * l, (2 - phi) * l * l
    return a * np.array([[12, 6 * l, -12, 6 * l], [6 * l, near, -6 * l, far], [-12, -6 * l, 12, -6 * l], [6 * l, far, -6 * l, near]])


def strip_mass(mass, length):
    l = length
    rows = [[156, 22 * l, 54, -13 * l], [22 * l, 4 * l * l, 13 * l, -3 * l * l], [54, 13 * l, 156, -22 * l], [-13 * l, -3 * l * l, -22 * l, 4 * l * l]]
    return mass / 420 * np.array(rows)


class Structure:
    """A fixture's assembly with its effects: coordinates are those of the bodies and whatever the effects release."""

    def __init__(self, fixture, effects):
        self.fixture, self.effects = fixture, effects
        self.bodies, self.size = {}, 0
        for name, body in fixture["bodies"].items():
            self.bodies[name] = {k: number(v) for k, v in body.items()}
            turns = body.get("rotates", True)
            self.bodies[name].update(y=self.new(), turn=self.new() if turns else None, bends=None)
        self.points = {n: (p["body"], number(p["x"])) for n, p in fixture["points"].items()}
        self.rigid = self.size
        for e in self.of("body_flexibility"):
            self.bodies[e["place"]]["bends"] = self.new()
        # `slips`: by point, coordinates that a joint's end moves by against its body; `parts`: (matrix, what multiplies it at s, with the sign of i)
        self.slips, released = {}, []
        for e in self.of("interface_compliance"):
            released.append((e["place"], e["dof"], e["stiffness"], e["damping"], e.get("spread", 0.0)))
        for e in self.of("footing"):
            joint = fixture["joints"][e["place"]]
            released += [(joint[end], "rotation", e["stiffness"], e["damping"], 0.0) for end in ("from", "to")]
        for place, dof, stiffness, dashpot, spread in released:
            self.slips.setdefault(place, []).append((self.new(), dof, stiffness, dashpot, spread))
        self.inner = {}
        for e in self.of("joint_mass"):
            if "beam" in fixture["joints"][e["place"]]:
                self.inner[e["place"]] = [(self.new(), self.new()) for _ in range(ELEMENTS - 1)]
        self.hung = [(e, self.new()) for e in self.of("attached_resonator")]
        self.parts = []
        self.inertia, self.viscous, self.stiff = (np.zeros((self.size, self.size)) for _ in range(3))
        self.build()

    def new(self):
        self.size += 1
        return self.size - 1

    def of(self, kind, place=None):
        return [e for e in self.effects if e["kind"] == kind and place in (None, e["place"])]

    def at(self, body, x):
        """Rows that read y and θ of a body at x."""
        own = self.bodies[body]
        y, turn = np.zeros(self.size), np.zeros(self.size)
        y[own["y"]] = 1.0
        if own["turn"] is not None:
            y[own["turn"]], turn[own["turn"]] = x - own["x_cg"], 1.0
        if own["bends"] is not None:
            length = np.sqrt(12 * own["inertia"] / own["mass"])
            y[own["bends"]], turn[own["bends"]] = bar_shape(x, own["x_cg"], length)
        return y, turn

    def end(self, point, inward, bending):
        """Motion of a joint's end at a point; `inward`: which way its body lies."""
        y, turn = self.at(*self.points[point])
        for index, dof, stiffness, _, spread in self.slips.get(point, []):
            if dof == "translation":
                y[index] += 1.0
            else:
                turn[index] += 1.0
                y[index] -= inward * spread * bending / (2 * stiffness)
        return y, turn

    def add(self, matrix, law):
        self.parts.append((matrix, law))

    def build(self):
        fixture, one = self.fixture, np.outer
        for name, own in self.bodies.items():
            self.inertia[own["y"], own["y"]] = own["mass"]
            if own["turn"] is not None:
                self.inertia[own["turn"], own["turn"]] = own["inertia"]
        for e in self.of("body_flexibility"):
            own, w = self.bodies[e["place"]], 2 * np.pi * e["frequency"]
            q, m = own["bends"], own["mass"]
            self.inertia[q, q], self.viscous[q, q], self.stiff[q, q] = m, 2 * e["damping_ratio"] * w * m, m * w * w
        for some in self.slips.values():
            for index, _, stiffness, dashpot, _ in some:
                self.stiff[index, index], self.viscous[index, index] = stiffness, dashpot
        for e in self.of("added_mass"):
            y, _ = self.at(e["place"], e["x"])
            self.inertia += e["mass"] * one(y, y)
        for e, index in self.hung:
            y, _ = self.at(e["place"], e["x"])
            w = 2 * np.pi * e["frequency"]
            self.inertia[index, index] += e["mass"]
            y[index] -= 1.0
            self.stiff += e["mass"] * w * w * one(y, y)
            self.viscous += 2 * e["damping_ratio"] * w * e["mass"] * one(y, y)
        for e in self.of("support"):
            reads = self.at(e["place"], e.get("x", 0.0))[1 if e.get("dof") == "rotation" else 0]
            self.stiff += e["stiffness"] * one(reads, reads)
            self.viscous += e["damping"] * one(reads, reads)
        for e in self.of("bypass"):
            first, second = e["place"].split("/")
            d = self.at(second, e["x_to"])[0] - self.at(first, e["x_from"])[0]
            self.stiff += e["stiffness"] * one(d, d)
            self.viscous += e["damping"] * one(d, d)
        for support in fixture.get("supports", {}).values():
            where = self.points[support["point"]] if "point" in support else (support["body"], number(support["x"]))
            y, _ = self.at(*where)
            self.stiff += number(support["stiffness"]) * one(y, y)
            self.viscous += number(support.get("damping", 0.0)) * one(y, y)
        stated = fixture.get("damping", {})
        eta = number(stated.get("loss_factor", 0.0))
        for name, joint in fixture["joints"].items():
            self.joint(name, joint, eta)
        if "modal_ratios" in stated or "rayleigh" in stated:
            self.viscous[: self.rigid, : self.rigid] += self.proportional(stated)

    def joint(self, name, joint, eta):
        one = np.outer
        of = lambda kind: self.of(kind, name)
        x_from, x_to = (self.points[joint[end]][1] for end in ("from", "to"))
        length = x_to - x_from + sum(e["dx"] for e in of("joint_length"))
        bending = number(joint["beam"]["youngs_modulus"]) * number(joint["beam"]["second_moment"]) if "beam" in joint else 0.0
        (y1, t1), (y2, t2) = self.end(joint["from"], -1.0, bending), self.end(joint["to"], 1.0, bending)
        d = {"translation": y2 - y1 - length * t1, "rotation": t2 - t1}
        factor = np.prod([e["factor"] for e in of("stiffness_change")])
        eta = eta + sum(e["loss_factor"] for e in of("loss_factor"))

        def law(s, sign):
            k = factor * (1 + 1j * eta * sign)
            for e in of("relaxation"):
                k = k * (1 + e["ratio"] * s * e["time"] / (1 + s * e["time"]))
            return k

        mass = sum(e["mass"] for e in of("joint_mass"))
        shear = 1 / sum(1 / e["shear_stiffness"] for e in of("shear_deformation")) if of("shear_deformation") else np.inf
        if "beam" in joint:
            nodes = [(y1, t1)]
            for pair in self.inner.get(name, []):
                nodes.append(tuple(np.eye(self.size)[i] for i in pair))
            nodes.append((y2, t2))
            step = length / (len(nodes) - 1)
            whole = np.zeros((self.size, self.size))
            for (a, b), (c, e) in zip(nodes, nodes[1:]):
                rows = np.array([a, b, c, e])
                whole += rows.T @ strip_matrix(bending, step, shear) @ rows
                self.inertia += rows.T @ strip_mass(mass / (len(nodes) - 1), step) @ rows
        else:
            rows = np.array([d["translation"], d["rotation"]])
            whole = rows.T @ np.array([[number(v) for v in row] for row in joint["stiffness"]]) @ rows
            self.inertia += mass / 2 * (one(y1, y1) + one(y2, y2))
        self.add(whole, law)
        for e in of("parallel_stiffness"):
            reads = d[e["dof"]]
            self.stiff += e["stiffness"] * one(reads, reads)
            self.viscous += e["damping"] * one(reads, reads)
        for e in of("springpot"):
            self.add(e["stiffness"] * one(d[e["dof"]], d[e["dof"]]), lambda s, sign, a=e["exponent"]: s**a)
        self.motion = d

    def proportional(self, stated):
        """Viscous matrix of the assembly without its effects, on the bodies' own coordinates."""
        plain = self if not self.effects else Structure({**self.fixture, "damping": {}}, [])
        mass, stiffness = plain.inertia, plain.stiff + sum(np.real(law(0.0, 0.0)) * m for m, law in plain.parts)
        if "rayleigh" in stated:
            joints = stiffness - plain.stiff
            return number(stated["rayleigh"]["mass"]) * mass + number(stated["rayleigh"]["stiffness"]) * joints
        ratios = [number(z) for z in stated["modal_ratios"]]
        root = np.linalg.cholesky(mass)
        values, shapes = np.linalg.eigh(np.linalg.solve(root, np.linalg.solve(root, stiffness).T))
        shapes = np.linalg.solve(root.T, shapes)
        damping, elastic = np.zeros_like(mass), values > 1e-6 * values[-1]
        for n, (value, shape) in enumerate((v, shapes[:, i]) for i, v in enumerate(values) if elastic[i]):
            moved = mass @ shape
            damping += 2 * ratios[min(n, len(ratios) - 1)] * np.sqrt(value) * np.outer(moved, moved)
        return damping

    def natural(self):
        """Frequencies of the elastic modes, Hz, without damping."""
        stiffness = self.stiff + sum(np.real(law(0.0, 0.0)) * m for m, law in self.parts)
        values = np.linalg.eigvals(np.linalg.solve(self.inertia, stiffness)).real
        return np.sqrt(np.sort(values[values > 1e-6 * values.max()])) / (2 * np.pi)

    def chain(self, place, hz):
        """What a channel makes of its signal."""
        channel = np.ones(len(hz), complex)
        for e in self.of("channel_gain", place):
            channel = channel * e["factor"]
        for e in self.of("channel_delay", place):
            channel = channel * np.exp(-2j * np.pi * hz * e["seconds"])
        for e in self.of("channel_highpass", place):
            channel = channel * 1j * hz / (1j * hz + e["corner"])
        for e in self.of("channel_resonance", place):
            f = e["frequency"]
            channel = channel * f**2 / (f**2 - hz**2 + 2j * e["damping_ratio"] * f * hz)
        return channel

    def frfs(self, pairs, hz, signals=False):
        """Accelerances as measured, pairs × lines; with `signals` without what only the force's channel and the window do."""
        of, w = self.of, 2 * np.pi * hz
        s = 1j * w + (0.0 if signals else sum(e["decay"] for e in of("exponential_window")))
        z = s[:, None, None] ** 2 * self.inertia + s[:, None, None] * self.viscous + self.stiff
        for matrix, law in self.parts:
            z = z + np.broadcast_to(law(s, 1.0), s.shape)[:, None, None] * matrix
        row = lambda n: self.at(self.points[n][0], self.points[n][1] + sum(e["dx"] for e in of("point_offset", n)))[0]
        inputs = sorted({i for _, i in pairs})
        solved = lambda z: dict(zip(inputs, np.moveaxis(np.linalg.solve(z, np.array([row(i) for i in inputs]).T.astype(complex)[None].repeat(len(s), 0)), 2, 0)))
        bare, loaded, result = solved(z), {}, []
        for e in of("sensor_mass"):
            node = e["place"].split()[1]
            reads = row(node)
            loaded[node] = solved(z + s[:, None, None] ** 2 * e["mass"] * np.outer(reads, reads))

        for out, into in pairs:
            h = s**2 * (loaded.get(out, bare)[into] @ row(out))
            h = h * self.chain(f"response {out}", hz)
            result.append(h if signals else h / self.chain(f"reference {into}", hz) / self.chain("force", hz))
        return np.array(result)


# --- quantities ------------------------------------------------------------------------------------------------------------------------------------------------------

def stated(tree, path=()):
    """(path, value, std) of every quantity with a deviation."""
    if isinstance(tree, dict) and "std" in tree:
        return [(path, tree["value"], tree["std"])]
    pairs = tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else []
    return [q for key, value in pairs if key not in ("physics", "model_error") for q in stated(value, path + (key,))]


def with_values(fixture, values):
    copy = json.loads(json.dumps(fixture))
    for path, value in values.items():
        node = copy
        for key in path:
            node = node[key]
        node["value"] = float(value)
    return copy


def step_of(effect, key):
    """One per cent; of abscissae a tenth of a millimetre."""
    return 1e-4 if key in ("x", "x_from", "x_to", "dx") else 0.01 * abs(effect[key])


def slopes(of, x, step=1e-3):
    """Central differences; unknowns count in deviations, or per cents."""
    return np.array([(of(x + dx) - of(x - dx)) / (2 * step) for dx in step * np.eye(len(x))]).T


FREE = ("kind", "place", "dof", "spread")


class Test:
    """What was measured, for fits: a fixture as stated, pairs, FRFs and their variances."""

    def __init__(self, fixture, pairs, measured, variance):
        self.fixture, self.pairs, self.measured, self.variance = fixture, pairs, measured, variance
        self.quantities = stated(fixture)

    def residuals(self, values, effects):
        paths = {"/".join(map(str, path)): path for path, _, _ in self.quantities}
        free = {paths[e["place"]]: e for e in effects if e["kind"] == "quantity_error"}
        values = {**values, **{path: e["value"] for path, e in free.items()}}
        h = Structure(with_values(self.fixture, values), [e for e in effects if e["kind"] != "quantity_error"]).frfs(self.pairs, LINES)
        off = ((h - self.measured) / np.sqrt(self.variance / 2)).ravel()
        priors = [(values[path] - value) / std for path, value, std in self.quantities if path not in free]
        return np.concatenate([off.real, off.imag, priors])

    def refitted(self, values, effects):
        """χ² at the best fit near the given start."""
        knobs = [(n, key) for n, e in enumerate(effects) for key in e if key not in FREE and isinstance(e[key], float)]
        count = len(self.quantities)

        def of(x):
            moved = [dict(e) for e in effects]
            for (n, key), dx in zip(knobs, x[count:]):
                moved[n][key] += dx * step_of(effects[n], key)
            return self.residuals({path: values[path] + dx * std for (path, _, std), dx in zip(self.quantities, x)}, moved)

        start = np.zeros(count + len(knobs))
        best = least_squares(of, start, jac=lambda x: slopes(of, x), method="lm", max_nfev=40)
        return 2 * best.cost

    def shown(self, values, effects, without):
        """What leaving out one effect costs in χ² to first order, past what the quantities and the other effect imitate."""
        rest = [e for n, e in enumerate(effects) if n != without]
        base = self.residuals(values, effects)
        gap = self.residuals(values, rest) - base
        columns = [(self.residuals({**values, path: values[path] + 0.05 * std}, effects) - base) / 0.05 for path, _, std in self.quantities]
        for n, e in enumerate(rest):
            for key in (k for k in e if k not in FREE and isinstance(e[k], float)):
                moved = [dict(x) for x in rest]
                moved[n][key] += 0.1 * step_of(e, key)
                columns.append((self.residuals(values, moved) - self.residuals(values, rest)) / 0.1)
        a = np.array([c for c in columns if c.any()]).T
        a = a / np.linalg.norm(a, axis=0)
        left = gap - a @ np.linalg.lstsq(a, gap, rcond=1e-12)[0]
        return float(left @ left)


# --- drawing ---------------------------------------------------------------------------------------------------------------------------------------------------------

class Case:
    """A structure, what is hidden in it, and its recording."""

    def __init__(self, random):
        self.random = random
        role = random.choice(["null", "single", "double", "hits", "nonlinear"], p=[0.2, 0.46, 0.14, 0.1, 0.1])
        self.role = str(role)
        self.timed = role in ("hits", "nonlinear") or (role == "null" and random.random() < 0.2)
        family = "pair" if role == "nonlinear" else str(random.choice(["pair", "chain", "frame"], p=[0.6, 0.22, 0.18]))
        while True:
            self.family = family
            self.structure(family)
            self.measurement()
            self.effects = self.hidden()
            if self.effects is not None:
                break
        self.name = self.family + "-" + (self.role if not self.effects else "+".join(e["kind"] for e in self.effects)) + ("-hits" if self.role == "hits" else "")

    def between(self, low, high):
        return float(np.exp(self.random.uniform(np.log(low), np.log(high))))

    def sign(self):
        return float(self.random.choice([-1.0, 1.0]))

    def near(self, value, std):
        return {"value": float(value), "std": float(f"{std:.3g}")}

    def structure(self, family):
        """`self.fixture` with true values and their deviations; what is stated is drawn about them at the end."""
        r = self.random
        self.fixture = f = {"bodies": {}, "points": {}, "joints": {}}
        if family == "frame":
            count = int(r.integers(3, 5))
            k = self.between(1e6, 8e6)
            for n in range(count):
                f["bodies"][f"F{n + 1}"] = {"mass": self.near(m := r.uniform(4, 8), 0.002 * m), "rotates": False}
                f["points"][str(n + 1)] = {"body": f"F{n + 1}", "x": self.near(0.18 * n, 1e-3)}
            for n in range(count - 1):
                stiffness = k * r.uniform(0.8, 1.5)
                f["joints"][f"C{n + 1}"] = {"from": str(n + 1), "to": str(n + 2), "stiffness": [[self.near(stiffness, 0.008 * stiffness), 0.0], [0.0, 0.0]]}
            self.at = {f"F{n + 1}": (0.18 * n, 0.18 * n) for n in range(count)}
        else:
            count, x, point, self.at = (3 if family == "chain" else 2), 0.0, 1, {}
            density, area = 7850.0, r.uniform(25e-3, 55e-3) ** 2
            for n in range(count):
                name, length = "ABC"[n], r.uniform(0.05, 0.13)
                mass = density * area * length * r.uniform(0.8, 1.2)
                inertia = mass * (length**2 + area) / 12
                f["bodies"][name] = {"mass": self.near(mass, 0.001 * mass), "inertia": self.near(inertia, 0.004 * inertia), "x_cg": self.near(x + length / 2, 1e-4)}
                self.at[name] = (x, x + length)
                places = [length * r.uniform(0.05, 0.3), length] if n == 0 else [0.0, length * r.uniform(0.7, 0.95)]
                if 0 < n < count - 1:
                    places = [0.0, length * r.uniform(0.6, 0.85), length]
                for place in places:
                    f["points"][str(point)] = {"body": name, "x": self.near(x + place, 1e-4)}
                    point += 1
                x += length
                if n + 1 < count:
                    f["joints"]["J" if count == 2 else f"J{n + 1}"] = {"from": str(point - 1), "to": str(point), "beam": {"youngs_modulus": self.near(207e9, 1.04e9), "second_moment": self.near(1e-10 * r.uniform(0.8, 1.3), 0.0)}}
                    x += r.uniform(0.02, 0.065)
            # the first elastic mode where it is wanted
            factor = (r.uniform(130, 380) / Structure(f, []).natural()[0]) ** 2
            for joint in f["joints"].values():
                second = joint["beam"]["second_moment"]["value"] * factor
                joint["beam"]["second_moment"] = self.near(second, 0.005 * second)
        kind = "ratios" if self.timed or r.random() < 0.65 else str(r.choice(["rayleigh", "loss", "supports"]))
        elastic = {"frame": count - 1}.get(family, 2 * (count - 1))
        if kind == "ratios":
            z = r.uniform(0.007, 0.012, elastic) if self.timed else r.uniform(0.002, 0.01, elastic)
            f["damping"] = {"modal_ratios": [self.near(v, 0.25 * v) for v in z]}
        elif kind == "rayleigh":
            beta = r.uniform(0.002, 0.008) / (np.pi * Structure(f, []).natural()[0])
            f["damping"] = {"rayleigh": {"mass": 0.0, "stiffness": self.near(beta, 0.2 * beta)}}
        else:
            f["damping"] = {"loss_factor": self.near(r.uniform(0.004, 0.012), 0.0012)}
            if kind == "supports" and family != "frame":
                for point in ("1", str(len(f["points"]))):
                    k = self.between(150, 800)
                    f["supports"] = {**f.get("supports", {}), "S" + point: {"point": point, "stiffness": self.near(k, 0.1 * k), "damping": self.near(0.5, 0.1)}}
        self.values = {path: value for path, value, _ in stated(f)}
        self.stated = with_values(f, {path: value + r.normal() * std for path, value, std in stated(f)})
        self.stated["name"] = "drawn"

    def measurement(self):
        r, points = self.random, list(self.fixture["points"])
        last = points[-1]
        inner = [n for n in points[1:-1] if n != "2"]
        if self.family == "frame":
            inputs = ["1"] if r.random() < 0.6 else ["1", last]
            outputs = points if len(inputs) == 1 or r.random() < 0.4 else points[1:]
        else:
            inputs = ["1", "2"] if r.random() < 0.8 else ["1"]
            outputs = inner + [last]
            if len(inputs) == 1 or r.random() < 0.3:
                outputs = ["2"] + outputs
            outputs = outputs if len(outputs) * len(inputs) <= 9 else [str(n) for n in sorted(r.choice(outputs, 4, replace=False))]
        if self.role == "nonlinear":
            inputs, outputs = ["1", "2"], ["3", "4"]
        self.pairs = [(o, i) for i in inputs for o in outputs][:9]
        self.noise = self.between(0.0025, 0.02)
        self.force_noise = r.uniform(0.0005, 0.003)
        self.averages = int(r.choice([5, 8, 10, 16, 20]))
        self.corner, self.spread, self.roving = r.uniform(700, 1200), 0.25, r.random() < 0.6
        self.numerator = int(r.choice([12, 12, 12, 11, 8]))
        self.reversed = str(r.choice(outputs)) if r.random() < 0.15 else None

    def variances(self, h):
        """What H1 of so many hits scatters by, complex; force of unit level."""
        force = self.averages * (1 + self.spread**2) / (1 + (LINES / self.corner) ** 2) ** 2
        shape = 1 / (1 + (LINES / self.corner) ** 2)
        rms = lambda x: np.sqrt(np.mean(np.abs(x) ** 2, axis=-1))
        return ((self.noise * rms(h * shape))[:, None] ** 2 + np.abs(h) ** 2 * (self.force_noise * rms(shape)) ** 2) / force

    def kinds(self):
        beams = self.family != "frame"
        kinds = ["added_mass", "support", "attached_resonator", "stiffness_change", "loss_factor", "relaxation", "channel_gain", "channel_delay", "sensor_mass", "exponential_window"]
        kinds += ["parallel_stiffness", "bypass", "springpot", "channel_highpass", "channel_resonance", "quantity_error", "joint_mass"]
        if beams:
            kinds += ["body_flexibility", "interface_compliance", "interface_compliance", "shear_deformation", "point_offset", "joint_length", "footing"]
        return kinds

    def effect(self, kind):
        """An effect of a drawn place and size."""
        r, f, pick = self.random, self.fixture, lambda some: str(self.random.choice(list(some)))
        body, joint = pick(f["bodies"]), pick(f["joints"])
        mass = number(f["bodies"][body]["mass"])
        inside = lambda b: float(r.uniform(*self.at[b]))
        own = f["joints"][joint]
        length = number(f["points"][own["to"]]["x"]) - number(f["points"][own["from"]]["x"])
        if "beam" in own:
            bending = number(own["beam"]["youngs_modulus"]) * number(own["beam"]["second_moment"])
            soft = {"translation": 12 * bending / length**3, "rotation": bending / length}
        else:
            soft = {"translation": number(own["stiffness"][0][0]), "rotation": 0.0}
        dof = pick(["translation", "rotation"]) if "beam" in own else "translation"
        lost = lambda k: float(r.uniform(0.002, 0.03)) * k / (2 * np.pi * 200)
        out, into = pick({o for o, _ in self.pairs}), pick({i for _, i in self.pairs})
        channel = pick(sorted({f"response {o}" for o, _ in self.pairs}) + sorted({f"reference {i}" for _, i in self.pairs}))
        e = {"kind": kind}
        if kind == "added_mass":
            e.update(place=body, x=inside(body), mass=mass * self.between(0.01, 0.12))
        elif kind == "support":
            k = mass * (2 * np.pi * self.between(5, 60)) ** 2
            e.update(place=body, x=inside(body), stiffness=k, damping=self.between(0.02, 0.2) * np.sqrt(k * mass))
        elif kind == "attached_resonator":
            e.update(place=body, x=inside(body), mass=mass * self.between(0.004, 0.04), frequency=self.between(60, 850), damping_ratio=self.between(0.004, 0.05))
        elif kind == "body_flexibility":
            e.update(place=body, frequency=self.between(850, 3500), damping_ratio=self.between(0.002, 0.01))
        elif kind == "interface_compliance":
            point = pick(n for n in (own["from"], own["to"]))
            e.update(place=point, dof=dof, stiffness=(k := soft[dof] * self.between(3, 60)), damping=lost(k))
        elif kind == "footing":
            e.update(place=joint, stiffness=(k := soft["rotation"] * self.between(4, 60)), damping=lost(k))
        elif kind == "shear_deformation":
            e.update(place=joint, shear_stiffness=soft["translation"] * length * self.between(2, 40))
        elif kind == "joint_mass":
            e.update(place=joint, mass=mass * self.between(0.01, 0.12))
        elif kind == "stiffness_change":
            e.update(place=joint, factor=1 + self.sign() * self.between(0.06, 0.5))
        elif kind == "loss_factor":
            e.update(place=joint, loss_factor=self.between(0.004, 0.07))
        elif kind == "relaxation":
            e.update(place=joint, ratio=self.between(0.03, 0.7), time=1 / (2 * np.pi * self.between(40, 2500)))
        elif kind == "point_offset":
            e.update(place=pick({n for pair in self.pairs for n in pair}), dx=self.sign() * self.between(1e-3, 10e-3))
        elif kind == "joint_length":
            e.update(place=joint, dx=self.sign() * self.between(0.5e-3, 4e-3))
        elif kind == "channel_gain":
            e.update(place=channel, factor=-1.0 if r.random() < 0.2 else 1 + self.sign() * self.between(0.02, 0.4))
        elif kind == "channel_delay":
            e.update(place=channel, seconds=self.sign() * self.between(1e-6, 6e-5))
        elif kind == "sensor_mass":
            e.update(place=f"response {out}", mass=self.between(0.002, 0.02) * mass)
        elif kind == "exponential_window":
            e.update(place="all", decay=self.between(0.8, 15))
        elif kind == "parallel_stiffness":
            e.update(place=joint, dof=dof, stiffness=(k := soft[dof] * self.between(0.04, 0.6)), damping=lost(k))
        elif kind == "springpot":
            exponent = float(r.uniform(0.2, 0.7))
            e.update(place=joint, dof=dof, stiffness=soft[dof] * self.between(0.01, 0.15) / 1200**exponent, exponent=exponent)
        elif kind == "bypass":
            first = list(f["bodies"]).index(pick(list(f["bodies"])[:-1]))
            a, b = list(f["bodies"])[first : first + 2]
            k = mass * (2 * np.pi * self.between(10, 90)) ** 2
            e.update(place=f"{a}/{b}", x_from=inside(a), x_to=inside(b), stiffness=k, damping=lost(k))
        elif kind == "channel_highpass":
            e.update(place=channel, corner=self.between(0.5, 15))
        elif kind == "channel_resonance":
            e.update(place=channel, frequency=self.between(1500, 15000), damping_ratio=self.between(0.01, 0.5))
        elif kind == "quantity_error":
            paths = [(path, std) for path, _, std in stated(f) if path[0] != "damping" and path[0] != "supports" and std > 0 and not (path[0] == "points" and self.family == "frame")]
            path, std = paths[int(r.integers(len(paths)))]
            e.update(place="/".join(map(str, path)), value=self.values[path])
            self.wrong = (path, self.values[path] + self.sign() * self.between(6, 60) * std)
        return {k: float(v) if isinstance(v, (int, float, np.floating)) else v for k, v in e.items()}

    def test(self, effects):
        """Noise-free, at the truth."""
        plain = [e for e in effects if e["kind"] != "quantity_error"]
        h = Structure(with_values(self.fixture, self.values), plain).frfs(self.pairs, LINES)
        return Test(self.stated, self.pairs, h, self.variances(h))

    def hidden(self):
        if self.role == "null":
            return []
        if self.role == "nonlinear":
            return [{"kind": str(self.random.choice(["cubic_stiffness", "friction", "gap"])), "place": "J", "dof": "translation"}]
        kinds = self.random.choice(self.kinds(), 2 if self.role == "double" else 1, replace=False)
        for _ in range(12):
            clean, self.wrong = json.loads(json.dumps(self.stated)), None
            effects = [self.effect(str(kind)) for kind in kinds]
            if len(effects) == 2 and (effects[0]["place"] == effects[1]["place"] or effects[0]["kind"] == effects[1]["kind"]):
                continue
            if self.wrong:
                self.stated = with_values(self.stated, dict([self.wrong]))
            test = self.test(effects)
            # a wrong quantity's effect is what its stated value does
            costs = []
            for n, e in enumerate(effects):
                if e["kind"] == "quantity_error":
                    others = [x for x in effects if x is not e]
                    costs.append(self.cost_of_quantity(test, others, self.wrong))
                else:
                    costs.append(test.shown(self.values, effects, n))
            # to first order first, which costs little, then by refits without each
            if min(costs) >= 9 * SHOWS and (costs := self.costs_refitted(test, effects)) and min(costs) >= 9 * SHOWS:
                self.costs = costs
                return effects
            self.stated = clean
        return None

    def costs_refitted(self, test, effects):
        least, costs = test.refitted(self.values, effects), []
        for e in effects:
            others = [x for x in effects if x is not e]
            start = {**self.values, self.wrong[0]: self.wrong[1]} if e["kind"] == "quantity_error" else self.values
            costs.append(test.refitted(start, others) - least)
        return costs

    def cost_of_quantity(self, test, others, wrong):
        path, value = wrong
        base = test.residuals(self.values, others)
        std = next(q[2] for q in test.quantities if q[0] == path)
        columns = [(test.residuals({**self.values, p: self.values[p] + 0.05 * s}, others) - base) / 0.05 for p, _, s in test.quantities]
        best = base - np.array(columns).T @ np.linalg.lstsq(np.array(columns).T, base, rcond=1e-12)[0]
        return float(best @ best) - len(test.quantities)

    # --- recording

    def recorded(self, folder):
        plain = [e for e in self.effects if e["kind"] != "quantity_error"]
        truth = {"role": self.role, "effects": self.effects, "values": {"/".join(map(str, p)): v for p, v in self.values.items()}, "pairs": self.pairs}
        if self.timed:
            sets = self.histories(plain)
            truth["effects"] = self.effects
        else:
            sets = self.frfs(plain)
        truth["costs"] = getattr(self, "costs", [])
        truth["measurement"] = {"noise": self.noise, "force_noise": self.force_noise, "averages": self.averages, "numerator": self.numerator, "roving": bool(self.roving)}
        path = folder / ("hits.uff" if self.timed else "frf.uff")
        path.unlink(missing_ok=True)
        pyuff.UFF(str(path)).write_sets(sets)
        (folder / "fixture.json").write_text(json.dumps(self.stated, indent=1))
        (folder / "truth.json").write_text(json.dumps(truth, indent=1))
        h = Structure(with_values(self.fixture, self.values), plain if self.role != "nonlinear" else []).frfs(self.pairs, LINES)
        measured = self.measured if not self.timed else h
        np.savez(folder / "measured.npz", measured=measured, variance=self.variances(h))

    def frfs(self, effects):
        r = self.random
        h = Structure(with_values(self.fixture, self.values), effects).frfs(self.pairs, LINES)
        shape = 1 / (1 + (LINES / self.corner) ** 2)
        rms = lambda x: np.sqrt(np.mean(np.abs(x) ** 2))
        normal = lambda *size: (r.normal(size=size) + 1j * r.normal(size=size)) / np.sqrt(2)
        hits = lambda: ((1 + self.spread * r.normal(size=(self.averages, 1))) * shape, self.force_noise * rms(shape) * normal(self.averages, len(LINES)))
        shared = {i: hits() for _, i in self.pairs}
        sets, self.measured = [], []
        per = (2j * np.pi * LINES) ** {12: 0, 11: 1, 8: 2}[self.numerator]
        for n, (out, into) in enumerate(self.pairs):
            force, off = hits() if self.roving else shared[into]
            response = h[n] * force + self.noise * rms(h[n] * shape) * normal(self.averages, len(LINES))
            felt = force + off
            auto, cross = (np.abs(felt) ** 2).sum(0), (response * felt.conj()).sum(0)
            mean, coherence = cross / auto, np.abs(cross) ** 2 / auto / (np.abs(response) ** 2).sum(0)
            self.measured.append(mean)
            sign = -1.0 if out == self.reversed else 1.0
            sets += [self.dataset(sign * mean / per, out, into, 4, sign), self.dataset(coherence.astype(complex), out, into, 6, sign)]
        self.measured = np.array(self.measured)
        return sets

    def dataset(self, values, out, into, function, sign):
        unit = {12: "m/s^2", 11: "m/s", 8: "m"}[self.numerator]
        frf = function == 4
        return dict(type=58, func_type=function, rsp_node=int(out), rsp_dir=int(2 * sign), ref_node=int(into), ref_dir=2, data=values, x=LINES, binary=1, id1="drawn", id5=f"averages {self.averages}",
                    abscissa_spacing=1, abscissa_spec_data_type=18, ordinate_spec_data_type=self.numerator if frf else 0, orddenom_spec_data_type=13 if frf else 0,
                    ordinate_axis_units_lab=unit if frf else "NONE", orddenom_axis_units_lab="N" if frf else "NONE")  # fmt: skip

    def histories(self, effects):
        r, rate, count, finer = self.random, 6400, 8192, 8
        levels = [self.between(25, 60), self.between(80, 150), self.between(250, 600)]
        inputs = sorted({i for _, i in self.pairs})
        struck = [(i, level * (1 + 0.1 * r.normal())) for i in inputs for level in levels for _ in range(3)]
        time = np.arange(count * finer) / (rate * finer)
        pulse, begin = 1e-3 * r.uniform(0.8, 1.2), 0.01
        half = np.where((time > begin) & (time < begin + pulse), np.sin(np.pi * (time - begin) / pulse) ** 2, 0.0)
        forces = np.array([level * half for _, level in struck])
        if self.role == "nonlinear":
            answers = self.integrated(struck, forces, 1 / (rate * finer))
        else:
            longer = 16 * count * finer
            hz = np.fft.rfftfreq(longer, 1 / (rate * finer))
            band = np.flatnonzero(hz < rate)
            answers, structure = {}, Structure(with_values(self.fixture, self.values), effects)
            faded = np.exp(-sum(e["decay"] for e in structure.of("exponential_window")) * (time - begin))
            for into in inputs:
                outs = [o for o, i in self.pairs if i == into]
                base = np.fft.rfft(half, longer)
                pieces = np.array_split(np.where(band == 0, 1e-3, hz[band]), 200)
                h = np.concatenate([structure.frfs([(o, into) for o in outs], piece, True) for piece in pieces], axis=1)
                for o, row in zip(outs, h):
                    spectrum = np.zeros(len(hz), complex)
                    spectrum[band] = row * base[band]
                    unit = np.fft.irfft(spectrum, longer)[: count * finer] * faded
                    for n, (i, level) in enumerate(struck):
                        if i == into:
                            answers[n, o] = level * unit
                felt = np.fft.irfft(base * structure.chain(f"reference {into}", hz) * structure.chain("force", hz), longer)[: count * finer]
                for n, (i, level) in enumerate(struck):
                    if i == into:
                        forces[n] = level * felt
        sets, x = [], np.arange(count) / rate
        # both channels alike, as an analyser does before it samples
        against_aliases = butter(6, 2600.0, fs=rate * finer, output="sos")
        for n, (into, _) in enumerate(struck):
            signals = [(into, forces[n], 13)] + [(o, answers[n, o], 12) for o, i in self.pairs if i == into]
            for node, signal, what in signals:
                kept = sosfiltfilt(against_aliases, signal)[::finer]
                share = self.force_noise if what == 13 else self.noise
                kept = kept + share * np.sqrt(np.mean(kept**2)) * r.normal(size=count)
                sets.append(dict(type=58, func_type=1, ver_num=n + 1, rsp_node=int(node), rsp_dir=2, ref_node=int(into), ref_dir=2, data=kept, x=x, binary=1, id1="drawn", abscissa_spacing=1,
                                 abscissa_spec_data_type=17, ordinate_spec_data_type=what, ordinate_axis_units_lab="N" if what == 13 else "m/s^2", orddenom_spec_data_type=0))  # fmt: skip
        return sets

    def integrated(self, struck, forces, dt):
        """Runge-Kutta on the modes of all hits at once; the law's size is drawn from how far the linear joint moves."""
        r, e = self.random, self.effects[0]
        s = Structure(with_values(self.fixture, self.values), [])
        stiffness = s.stiff + sum(m for m, _ in s.parts)
        push = np.array([s.at(*s.points[i])[0] for i, _ in struck]).T
        inverse, d = np.linalg.inv(s.inertia), s.motion[e["dof"]]

        def run(law, settle):
            u, v, out = np.zeros((s.size, len(struck))), np.zeros((s.size, len(struck))), []
            slider, moved = np.zeros(len(struck)), []
            acceleration = lambda u, v, f: inverse @ (push * f - s.viscous @ v - stiffness @ u - np.outer(d, law(d @ u, slider)))
            for n in range(forces.shape[1]):
                f0, f1 = forces[:, n], forces[:, min(n + 1, forces.shape[1] - 1)]
                middle = (f0 + f1) / 2
                a1 = acceleration(u, v, f0)
                out.append(a1)
                moved.append(d @ u)
                v2 = v + dt / 2 * a1
                a2 = acceleration(u + dt / 2 * v, v2, middle)
                v3 = v + dt / 2 * a2
                a3 = acceleration(u + dt / 2 * v2, v3, middle)
                v4 = v + dt * a3
                a4 = acceleration(u + dt * v3, v4, f1)
                u, v = u + dt / 6 * (v + 2 * v2 + 2 * v3 + v4), v + dt / 6 * (a1 + 2 * a2 + 2 * a3 + a4)
                slider = settle(d @ u, slider)
            return np.array(out), np.array(moved)

        still = lambda d, slider: slider
        saved, forces = forces, forces[:, : len(forces[0]) // 8]
        _, moved = run(lambda d, slider: 0.0 * d, still)
        forces, most = saved, np.sort(np.abs(moved).max(axis=0))
        most, least = most[-1], most[0]
        own = number(self.fixture["joints"]["J"]["beam"]["youngs_modulus"]) * number(self.fixture["joints"]["J"]["beam"]["second_moment"])
        x1, x2 = s.points["2"][1], s.points["3"][1]
        k = 3 * own / (x2 - x1) ** 3
        if e["kind"] == "cubic_stiffness":
            e["stiffness3"] = float(k / most**2 * self.between(0.1, 1.0))
            law, settle = lambda d, slider: e["stiffness3"] * d**3, still
        elif e["kind"] == "gap":
            e["clearance"], e["stiffness"] = float(most * self.between(0.08, 0.4)), float(k * self.between(0.05, 0.6))
            law, settle = lambda d, slider: e["stiffness"] * np.maximum(d - e["clearance"], 0.0), still
        else:
            e["stiffness"] = float(k * self.between(0.05, 0.4))
            e["slip_force"] = float(e["stiffness"] * most * self.between(0.08, 0.4))
            reach = e["slip_force"] / e["stiffness"]
            law = lambda d, slider: e["stiffness"] * np.clip(d - slider, -reach, reach)
            settle = lambda d, slider: np.clip(slider, d - reach, d + reach)
        motion, _ = run(law, settle)
        return {(n, o): motion[:, :, n] @ s.at(*s.points[o])[0] for n, (i, _) in enumerate(struck) for o, j in self.pairs if i == j}


# --- asking ----------------------------------------------------------------------------------------------------------------------------------------------------------

def asked(program, folder):
    used = lambda: sum(resource.getrusage(resource.RUSAGE_CHILDREN)[:2])
    before = used()
    recording = "hits.uff" if (folder / "hits.uff").exists() else "frf.uff"
    alone = {**os.environ, "RAYON_NUM_THREADS": "1"}
    done = subprocess.run([str(program), "diagnose", "fixture.json", recording, "-o", "out"], cwd=folder, capture_output=True, text=True, env=alone)
    if done.returncode:
        return None, used() - before, done.stderr
    return json.loads((folder / "out" / "diagnosis.json").read_text()), used() - before, ""


def same(finding, effect):
    return finding["kind"] == effect["kind"] and finding["place"] == effect["place"] and finding.get("dof") == effect.get("dof", finding.get("dof"))


def judged_alike(folder, truth):
    """By how much what was found fits worse than the truth, both refitted."""
    fixture, repaired = (json.loads((folder / name).read_text()) for name in ("fixture.json", "out/repaired.json"))
    saved = np.load(folder / "measured.npz")
    test = Test(fixture, [tuple(p) for p in truth["pairs"]], saved["measured"], saved["variance"])
    values = {path: truth["values"]["/".join(map(str, path))] for path, _, _ in test.quantities}
    at = {path: number_at(repaired, path) for path in values}
    floats = lambda effects: [{k: float(number(v)) if k not in FREE[:3] else v for k, v in e.items() if k != "unit"} for e in effects]
    return test.refitted(at, floats(repaired.get("physics", []))) - test.refitted(values, truth["effects"])


def number_at(tree, path):
    for key in path:
        tree = tree[key]
    return number(tree)


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("program")
    arguments.add_argument("--cases", type=int, default=30)
    arguments.add_argument("--seed", type=int, default=1)
    arguments.add_argument("--only", nargs="*")
    arguments.add_argument("--keep", type=pathlib.Path)
    given = arguments.parse_args()
    warnings.filterwarnings("ignore")
    program = pathlib.Path(shutil.which(given.program) or given.program).resolve()
    hidden = right = alike = nulls = named = sized = held = missed = failed = 0
    wrong, seconds = [], []
    for n in range(given.cases):
        random = np.random.default_rng([given.seed, n])
        with tempfile.TemporaryDirectory() as scratch:
            case = None
            folder = given.keep / f"{given.seed}-{n:03d}" if given.keep else pathlib.Path(scratch)
            folder.mkdir(parents=True, exist_ok=True)
            if given.only and str(n) not in given.only:
                if not any(word.isalpha() or "_" in word for word in given.only):
                    continue
            if not (folder / "truth.json").exists():
                case = Case(random)
                if given.only and str(n) not in given.only and not any(word in case.name for word in given.only):
                    continue
                case.recorded(folder)
                truth = json.loads((folder / "truth.json").read_text())
                truth["name"] = case.name
                (folder / "truth.json").write_text(json.dumps(truth, indent=1))
            truth = json.loads((folder / "truth.json").read_text())
            if given.only and str(n) not in given.only and not any(word in truth["name"] for word in given.only):
                continue
            answer, used, why = asked(program, folder)
            seconds.append(used)
            if answer is None:
                failed += 1
                print(f"{n:3d} {truth['name']:42s} no answer: {why.strip()[-150:]}", flush=True)
                continue
            findings, effects = answer["findings"], truth["effects"]
            taken = {}
            for k, e in enumerate(effects):
                i = next((i for i, f in enumerate(findings) if i not in taken.values() and same(f, e)), None)
                if i is not None:
                    taken[k] = i
            others = [f for i, f in enumerate(findings) if i not in taken.values()]
            note, score = "", "right"
            if effects and (len(taken) < len(effects) or others):
                score = "wrong" if others else "missed"
                if findings and truth["role"] != "nonlinear":
                    worse = judged_alike(folder, truth)
                    note = f" [{worse:+.1f} in chi2]"
                    if worse <= ALIKE and len(findings) <= len(effects):
                        score = "alike"
            elif not effects:
                score = "null" if not findings else "NAMED"
        if effects:
            hidden, right, alike, missed = hidden + 1, right + (score == "right"), alike + (score == "alike"), missed + (score == "missed")
        else:
            nulls, named = nulls + 1, named + bool(findings)
        wrong += [f["probability"] for f in others] if score in ("wrong", "NAMED") else []
        off = ""
        for k, i in taken.items():
            for key, drawn in effects[k].items():
                told = findings[i]["parameters"].get(key)
                if key not in FREE and told and told.get("ci95"):
                    inside = told["ci95"][0] <= drawn <= told["ci95"][1]
                    sized, held = sized + 1, held + inside
                    off += "" if inside else f" {key} {drawn:.4g} not in {told['ci95'][0]:.4g}..{told['ci95'][1]:.4g}"
        said = " ".join(f"{f['kind']}@{f['place']}{'/' + f['dof'] if f.get('dof') else ''}:{f['probability']:.2f}" for f in findings)
        places = " ".join(e["place"] + ("/" + e["dof"] if "dof" in e else "") for e in effects)
        print(f"{n:3d} {truth['name']:42s} {places[:26]:26s} {answer['verdict']:16s} {score:6s} {used:5.1f} s  {said}{note}{off}", flush=True)
    print(f"\nright {right} and alike {alike} of {hidden}, missed {missed}, wrong names with probability 0.9 or more {sum(p >= 0.9 for p in wrong)}, 0.5 or more {sum(p >= 0.5 for p in wrong)}, any {len(wrong)}")
    print(f"nulls with a name {named} of {nulls}; without an answer {failed}; sizes in their 95 % interval {held} of {sized}; seconds median {np.median(seconds):.1f}, most {max(seconds):.1f}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
