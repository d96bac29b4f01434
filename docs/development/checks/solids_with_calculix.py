#!/usr/bin/env python3
"""Draws solid structures, has CalculiX find their modes, hides things in them, and asks the program what was hidden.

    python3 docs/development/checks/solids_with_calculix.py PROGRAM [--more | --rarer | --frames] [--noise 1] [--cases 25] [--seed 1] [--only family/hidden|N …] [--keep DIR]

Nothing of the program's own mechanics is used: 20-node bricks, solved by `ccx`, FRFs by the superposition of its modes, one damping ratio a mode, 0.25 % noise with the coherence of
eight hits. The fixture is an honest analyst's: masses and lengths within their scatter, strips as Timoshenko beams with their mass, what a face yields under a strip within 8 % of
what the solid without anything hidden shows. Families: `pair` (two blocks, one strip), `wide` (the strip as wide as the blocks), `chain` (three blocks, two strips), `clamped` (a pair on a wall), `beam` (one bar),
`frame` (storeys on columns).
Right: every hidden thing has a finding of its kind at its place. Untrue: a finding that is neither that nor true of any such solid (shear, what faces yield). A case without an
answer counts as missed, an unnamed null may still be called unexplained: the verdict stands in its line.
"""
import argparse
import json
import os
import pathlib
import re
import resource
import shutil
import subprocess
import sys
import tempfile

import numpy as np
import pyuff

STEEL, ALUMINIUM, EPOXY = (207e9, 0.3, 7850.0), (71e9, 0.33, 2700.0), (3e9, 0.36, 1200.0)
MODES, AVERAGES, SCATTER = 36, 8, 0.007
NEIGHBOUR = 1.5e-3  # least distance of grid lines, m


# --- the solid -------------------------------------------------------------------------------------------------------------------------------------------------------

def grid(stops, longest):
    """Grid lines through all stops, cells no longer than given."""
    stops = sorted(stops)
    kept = [stops[0]]
    for stop in stops[1:]:
        if stop - kept[-1] > 1e-6:
            kept.append(stop)
    lines = [kept[0]]
    for low, high in zip(kept, kept[1:]):
        count = max(1, int(np.ceil((high - low) / longest - 1e-9)))
        lines += [low + (high - low) * (k + 1) / count for k in range(count)]
    return lines


class Solid:
    """Boxes of materials, symmetric about y = 0 and z = 0, of which the half y > 0 is meshed; of a box that is `hollow` (y, z) the four corners beyond these. `lines`: places along x
    where a node must be."""

    def __init__(self, boxes, lines, walls=()):
        self.boxes, self.walls = boxes, walls
        rims = lambda axis: [rim for box in boxes if "hollow" in box for rim in [box["hollow"][axis]]]
        tops = sorted({box["height"] / 2 for box in boxes} | set(rims(1)) | {(box["hollow"][1] + box["height"] / 2) / 2 for box in boxes if "hollow" in box})
        xs = grid([x for box in boxes for x in box["x"]] + list(lines), 8e-3)
        ys = grid([0.0] + [box["width"] / 2 for box in boxes] + rims(0), 11e-3)
        zs = grid([s * top for top in tops for s in (-1, 1)] + [0.0], 9e-3)
        self.nodes, self.elements = {}, {}
        for i, (x0, x1) in enumerate(zip(xs, xs[1:])):
            for j, (y0, y1) in enumerate(zip(ys, ys[1:])):
                for k, (z0, z1) in enumerate(zip(zs, zs[1:])):
                    centre = ((x0 + x1) / 2, (y0 + y1) / 2, (z0 + z1) / 2)
                    along = lambda b: b["x"][0] < centre[0] < b["x"][1]
                    across = lambda b: b.get("hollow", (0, 0))[0] < centre[1] < b["width"] / 2
                    deep = lambda b: b.get("hollow", (0, 0))[1] <= abs(centre[2]) < b["height"] / 2
                    box = next((b for b in boxes if along(b) and across(b) and deep(b)), None)
                    if box:
                        self.elements.setdefault(box["name"], []).append(self.brick(i, j, k))
        half = lambda values: [v for pair in zip(values, [(a + b) / 2 for a, b in zip(values, values[1:])]) for v in pair] + [values[-1]]
        self.x, self.y, self.z = half(xs), half(ys), half(zs)
        self.where = {number: self.tapered(self.x[a], self.y[b], self.z[c]) for (a, b, c), number in self.nodes.items()}

    def tapered(self, x, y, z):
        """A point of the grid where it comes to lie in a box that is lower at its start than at its end."""
        for box in self.boxes:
            (start, end), taper = box["x"], box.get("taper", 0.0)
            if taper and start - 1e-9 <= x <= end + 1e-9 and abs(z) <= box["height"] / 2 + 1e-9:
                return x, y, z * (1 + taper * (2 * (x - start) / (end - start) - 1))
        return x, y, z

    def node(self, a, b, c):
        return self.nodes.setdefault((a, b, c), len(self.nodes) + 1)

    def brick(self, i, j, k):
        corner = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
        middle = lambda p, q: tuple((u + v) // 2 for u, v in zip(corner[p], corner[q]))
        edges = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
        return [self.node(2 * i + a, 2 * j + b, 2 * k + c) for a, b, c in corner + [middle(*e) for e in edges]]

    def at(self, x, z="top"):
        """The node in the plane of symmetry at x, on top or in the middle."""
        some = [(n, w) for n, w in self.where.items() if w[1] == 0.0 and abs(w[0] - x) < 1e-6]
        return max(some, key=lambda s: s[1][2] if z == "top" else -abs(s[1][2]))[0]

    def modes(self, folder, springs, lumps, points):
        """Natural frequencies in Hz and the transverse shapes at the points, of unit modal mass of the whole; springs and lumps: (x, N/m or kg, 'top' or 'middle')."""
        out = ["*NODE, NSET=ALL"] + [f"{n}, {x:.9e}, {y:.9e}, {z:.9e}" for n, (x, y, z) in self.where.items()]
        number = 0
        for name, bricks in self.elements.items():
            out.append(f"*ELEMENT, TYPE=C3D20, ELSET={name}")
            for brick in bricks:
                number += 1
                out += [", ".join(map(str, [number, *brick[:10]])) + ",", ", ".join(map(str, brick[10:]))]
        for box in self.boxes:
            modulus, ratio, density = box["material"]
            name = box["name"]
            out += [f"*MATERIAL, NAME=M{name}", "*ELASTIC", f"{modulus:.6e}, {ratio}", "*DENSITY", f"{density:.6e}"]
            out += [f"*SOLID SECTION, ELSET={name}, MATERIAL=M{name}"]
        extra = [(x, k, 3, z) for x, k, z in springs]
        if not self.walls:
            extra.append((self.boxes[0]["x"][0], 50.0, 1, "middle"))
        for index, (x, stiffness, direction, z) in enumerate(extra):
            number += 1
            out += [f"*ELEMENT, TYPE=SPRING1, ELSET=S{index}", f"{number}, {self.at(x, z)}"]
            out += [f"*SPRING, ELSET=S{index}", f"{direction}", f"{stiffness / 2:.6e}"]
        for index, (x, mass, z) in enumerate(lumps):
            number += 1
            out += [f"*ELEMENT, TYPE=MASS, ELSET=L{index}", f"{number}, {self.at(x, z)}"]
            out += [f"*MASS, ELSET=L{index}", f"{mass / 2:.6e}"]
        measured = [self.at(x) for x in points]
        plane = [n for n, w in self.where.items() if w[1] == 0.0]
        wall = [n for n, w in self.where.items() if any(abs(w[0] - x) < 1e-9 for x in self.walls)]
        numbers = lambda some: [", ".join(map(str, some[i : i + 8])) for i in range(0, len(some), 8)]
        out += ["*NSET, NSET=PLANE", *numbers(plane), "*NSET, NSET=MEASURED", *numbers(sorted(set(measured)))]
        out += ["*NSET, NSET=WALL", *numbers(wall)] if wall else []
        out += ["*BOUNDARY", "PLANE, 2, 2"] + (["WALL, 1, 3"] if wall else [])
        out += ["*STEP", "*FREQUENCY", str(MODES), "*NODE PRINT, NSET=MEASURED", "U", "*END STEP"]
        (folder / "deck.inp").write_text("\n".join(out) + "\n")
        alone = {**os.environ, "OMP_NUM_THREADS": "1"}
        done = subprocess.run(["ccx", "deck"], cwd=folder, capture_output=True, text=True, env=alone)
        text = (folder / "deck.dat").read_text()
        table = text[text.index("E I G E N V A L U E   O U T P U T") :]
        number, rest = r"[-+.\dE]+", r"\s+[-+.\dE]+"
        row = rf"^\s+\d+\s+{number}\s+({number}){rest}{rest}\s*$"
        hz = [float(f) / (2 * np.pi) for f in re.findall(row, table.split("P A R T")[0], re.M)]
        shapes = []
        for block in re.split(r"displacements \(vx,vy,vz\)", text)[1:]:
            rows = [row.split() for row in block.splitlines()]
            rows = {int(row[0]): float(row[3]) for row in rows if len(row) == 4 and row[0].isdigit()}
            shapes.append([rows[n] for n in measured])
        if done.returncode or len(shapes) < 8 or len(hz) < len(shapes):
            raise RuntimeError(done.stdout[-600:])
        return np.array(hz[: len(shapes)]), np.array(shapes) / np.sqrt(2)


def accelerances(hz, natural, shapes, ratios, out, into):
    """By the superposition of modes."""
    w, wn = 2 * np.pi * hz[:, None], 2 * np.pi * natural[None, :]
    return ((-(w**2)) * shapes[:, out] * shapes[:, into] / (wn**2 - w**2 + 2j * ratios * wn * w)).sum(axis=1)


# --- the analyst's lumped model, for what a face yields ---------------------------------------------------------------------------------------------------------------

def lumped_frequency(bodies, strips, clamped):
    """First elastic frequency, Hz: rigid bodies (mass, inertia, x_cg, from, to) joined by Timoshenko strips (from, to, E·I, k·G·A, mass) with the same spring at each end."""

    def of(footing):
        count = 20
        size = 2 * len(bodies) + sum(2 * (count + 1) for _ in strips)
        mass, stiffness = np.zeros((size, size)), np.zeros((size, size))
        for i, (m, inertia, *_) in enumerate(bodies):
            mass[2 * i, 2 * i], mass[2 * i + 1, 2 * i + 1] = m, inertia
        for s, (left, right, bending, shear, weight) in enumerate(strips):
            first, length = 2 * len(bodies) + s * 2 * (count + 1), (right - left) / count
            phi = 12 * bending / (shear * length**2)
            a = bending / (length**3 * (1 + phi))
            l6, near, far = 6 * length, (4 + phi) * length**2, (2 - phi) * length**2
            k = a * np.array([[12, l6, -12, l6], [l6, near, -l6, far], [-12, -l6, 12, -l6], [l6, far, -l6, near]])
            for e in range(count):
                at = first + 2 * e + np.arange(4)
                stiffness[np.ix_(at, at)] += k
                for n in (at[0], at[2]):
                    mass[n, n] += weight / count / 2
                    mass[n + 1, n + 1] += weight / count / 2 * length**2 / 12
            for body, x, node in ((s, left, first), (s + 1, right, first + 2 * count)):
                arm = x - bodies[body][2]
                move, turn = np.zeros(size), np.zeros(size)
                move[node], move[2 * body], move[2 * body + 1] = 1, -1, -arm
                turn[node + 1], turn[2 * body + 1] = 1, -1
                stiffness[:] += 1e11 * np.outer(move, move) + footing * np.outer(turn, turn)
        keep = np.arange(size) if not clamped else np.arange(2, size)
        values = np.linalg.eigvals(np.linalg.solve(mass[np.ix_(keep, keep)], stiffness[np.ix_(keep, keep)])).real
        return np.sqrt(np.sort(np.abs(values))[0 if clamped else 2]) / (2 * np.pi)

    return of


def footing_that_gives(of, wanted, low=1e2, high=1e8):
    for _ in range(60):
        middle = np.sqrt(low * high)
        low, high = (middle, high) if of(middle) < wanted else (low, middle)
    return np.sqrt(low * high)


# --- cases -----------------------------------------------------------------------------------------------------------------------------------------------------------

class Case:
    """A structure of a family, its fixture and what is hidden in it."""

    def __init__(self, random, family, hidden, noise=1.0):
        self.random, self.family, self.hidden, self.scatter = random, family, hidden, SCATTER * noise
        self.right, self.size = [], {}
        getattr(self, {"beam": "beam_", "frame": "frame_"}.get(family, "blocks_"))()

    def about(self, value, std):
        return {"value": value + float(self.random.normal()) * std, "std": std}

    def known_to(self, share, value):
        return self.about(value, share * value)

    def beam_(self):
        r, material = self.random, STEEL if self.random.random() < 0.6 else ALUMINIUM
        modulus, ratio, density = material
        length, width, height = r.uniform(0.3, 0.55), r.uniform(18e-3, 40e-3), r.uniform(8e-3, 14e-3)
        self.boxes = [dict(name="A", x=(0.0, length), width=width, height=height, material=material)]
        at = [0.02, r.uniform(0.3, 0.4), r.uniform(0.6, 0.7), 0.98] if r.random() < 0.5 else [0.03, 0.25, 0.5, 0.72, 0.97]
        self.points = {str(n + 1): ("A", length * x) for n, x in enumerate(at)}
        self.unseen = {"91": ("A", 0.2 * length), "92": ("A", 0.83 * length)}
        self.hung = [(0.18 * length, 400.0, "A"), (0.8 * length, 420.0, "A")]
        area, second = width * height, width * height**3 / 12
        self.mass = {"A": density * area * length}
        self.fixture = {
            "bodies": {
                "A": {
                    "beam": {
                        "from": 0.0,
                        "to": length,
                        "youngs_modulus": self.known_to(0.01, modulus),
                        "second_moment": self.known_to(0.008, second),
                        "mass_per_length": self.known_to(0.002, density * area),
                    }
                }
            },
            "joints": {},
            "physics": [
                {
                    "kind": "shear_deformation",
                    "place": "A",
                    "shear_stiffness": self.known_to(0.05, modulus / 2 / (1 + ratio) * area * 5 / 6),
                    "rotary_inertia": self.known_to(0.02, density * second),
                }
            ],
        }
        self.elastic = 3
        self.joints, self.clamped, self.footing = {}, False, None

    def frame_(self):
        """Storeys on four columns each, x upwards, z the motion; stated as a shear building."""
        r, material = self.random, STEEL if self.random.random() < 0.3 else ALUMINIUM
        modulus, ratio, density = material
        count, side, deep = int(r.integers(3, 5)), r.uniform(0.14, 0.2), r.uniform(0.22, 0.3)
        thick, span, across, slim = r.uniform(20e-3, 28e-3), r.uniform(120e-3, 170e-3), r.uniform(15e-3, 22e-3), r.uniform(4e-3, 6e-3)
        plate, columns = density * thick * side * deep, 4 * density * span * across * slim
        stiffness = 4 * 12 * modulus * across * slim**3 / 12 / span**3
        self.boxes, self.points, self.joints, self.mass, self.hung = [], {}, {}, {}, []
        self.fixture, self.storeys, x = {"bodies": {}, "joints": {}, "physics": []}, [], 0.0
        of_columns = [[self.known_to(0.06, stiffness), 0.0], [0.0, 0.0]]
        for n in range(1, count + 1):
            corners = dict(width=side, height=deep, hollow=(side / 2 - across, deep / 2 - slim))
            storey, joint = f"F{n}", f"C{n}"
            self.boxes.append(dict(name=joint, x=(x, x + span), material=material, **corners))
            self.boxes.append(dict(name=storey, x=(x + span, x + span + thick), material=material, width=side, height=deep))
            self.mass[storey] = plate + columns * (1.0 if n < count else 0.5)
            self.fixture["bodies"][storey] = {"mass": self.known_to(0.003, self.mass[storey]), "rotates": False}
            x += span + thick
            self.points[str(n)] = (storey, x - thick / 2)
            if n > 1:
                self.fixture["joints"][joint] = {"from": str(n - 1), "to": str(n), "stiffness": of_columns}
                self.joints[joint] = (str(n - 1), str(n))
            self.storeys.append((joint, ("stiffness_change", joint) if n > 1 else ("quantity_error", "supports/ground/stiffness")))
        self.ground = {"ground": {"point": "1", "stiffness": of_columns[0][0]}}
        self.unseen = {"91": ("F1", self.points["1"][1]), "92": ("F2", self.points["2"][1])}
        self.elastic, self.clamped, self.footing = count, True, None

    def blocks_(self):
        r, chain = self.random, self.family == "chain"
        count, x = (3 if chain else 2), 0.0
        steel = r.random() < 0.65
        material = STEEL if steel else ALUMINIUM
        modulus, ratio, density = material
        width = r.uniform(30e-3, 50e-3)
        self.boxes, bodies, strips, self.fixture = [], [], [], {"bodies": {}, "joints": {}, "physics": []}
        self.points, self.joints, self.mass, self.hung, point = {}, {}, {}, [], 1
        self.clamped = self.family == "clamped"
        for n in range(count):
            name, length, height = "ABC"[n], r.uniform(45e-3, 75e-3), r.uniform(30e-3, 45e-3)
            if n == 1 and self.hidden == "flexible":  # a plate in place of a block
                length, height = r.uniform(105e-3, 135e-3), r.uniform(9e-3, 11e-3)
            mass = density * length * width * height
            inertia = mass * (length**2 + height**2) / 12
            self.boxes.append(dict(name=name, x=(x, x + length), width=width, height=height, material=material))
            self.mass[name] = mass
            own = {"mass": self.known_to(0.002, mass), "inertia": self.known_to(0.005, inertia)}
            self.fixture["bodies"][name] = {**own, "x_cg": self.about(x + length / 2, 2e-4)}
            places = [0.12, 0.85] if r.random() < 0.6 or self.clamped else [0.08, 0.45, 0.9]
            for share in places:
                self.points[str(point)] = (name, x + share * length)
                point += 1
            bodies.append((mass, inertia, x + length / 2))
            self.hung.append((x + length / 2, 300.0, name))
            x += length
            if n + 1 < count:
                span, depth = r.uniform(30e-3, 60e-3), r.uniform(4e-3, 6.5e-3)
                across = width if self.family == "wide" else r.uniform(10e-3, 18e-3)
                joint = "JK"[n]
                self.boxes.append(dict(name=joint, x=(x, x + span), width=across, height=depth, material=material))
                area, second = across * depth, across * depth**3 / 12
                ends = self.joints[joint] = (str(10 + 2 * n), str(11 + 2 * n))
                self.points[ends[0]], self.points[ends[1]] = (name, x), ("ABC"[n + 1], x + span)
                shear, weight = modulus / 2 / (1 + ratio) * area * 5 / 6, density * area * span
                plate = 1 / (1 - 0.5 * ratio**2) if self.family == "wide" else 1.0
                strip = {"youngs_modulus": self.known_to(0.03 if plate > 1 else 0.01, modulus), "second_moment": self.known_to(0.01, second)}
                self.fixture["joints"][joint] = {"from": ends[0], "to": ends[1], "beam": strip}
                self.fixture["physics"] += [
                    {"kind": "joint_mass", "place": joint, "mass": self.known_to(0.01, weight)},
                    {"kind": "shear_deformation", "place": joint, "shear_stiffness": self.known_to(0.05, shear)},
                ]
                strips.append((x, x + span, modulus * second * plate, shear, weight))
                x += span
        first, last = self.boxes[0], self.boxes[-1]
        self.unseen = {"91": ("A", first["x"][0] + 0.4 * (first["x"][1] - first["x"][0])), "92": ("ABC"[count - 1], last["x"][0] + 0.6 * (last["x"][1] - last["x"][0]))}
        self.elastic = 4 if chain else 2
        self.of_footing = lumped_frequency(bodies, strips, self.clamped)
        self.footing = True

    def hide(self):
        """Puts the hidden things into the solid; the springs and lumps to be solved with."""
        self.springs, self.lumps = ([] if self.clamped else [(x, k, "middle") for x, k, _ in self.hung]), []
        self.extra, self.said = [], []
        for kind in self.hidden.replace("two", "lump").split("+"):
            self.hide_one(kind)
        self.said = "; ".join(self.said)
        return self.springs, self.lumps

    def stiffen(self, name, factor):
        for box in self.boxes:
            if box["name"] == name:
                modulus, ratio, density = box["material"]
                box["material"] = (factor * modulus, ratio, density)

    def hide_one(self, kind):
        r = self.random
        body = str(r.choice([b for b in self.mass if not (self.clamped and b == "A")]))
        box = next(b for b in self.boxes if b["name"] == body)
        inside = lambda: box["x"][0] + (box["x"][1] - box["x"][0]) * float(r.uniform(0.15, 0.85))
        if kind == "lump":
            x, mass = inside(), float(r.uniform(0.03, 0.08)) * self.mass[body]
            z = "middle" if r.random() < 0.5 else "top"
            self.lumps.append((x, mass, z))
            self.extra.append(x)
            # Near the centre of gravity nothing tells a lump from a wrong mass.
            self.right.append([("added_mass", body), ("quantity_error", f"bodies/{body}/mass")])
            self.size["added_mass"] = ("mass", mass)
            self.said.append(f"{1e3 * mass:.1f} g on {body} at {1e3 * x:.0f} mm, {z}")
        elif kind == "ground":
            x, stiffness = inside(), float(np.exp(r.uniform(np.log(5e4), np.log(4e5))))
            self.springs.append((x, stiffness, "middle"))
            self.extra.append(x)
            self.right.append([("support", body)])
            self.size["support"] = ("stiffness", stiffness)
            self.said.append(f"{stiffness / 1e3:.0f} kN/m under {body} at {1e3 * x:.0f} mm")
        elif kind == "glue":
            joint = str(r.choice([j for j in self.joints if all(b.get("glued") != j for b in self.boxes)]))
            strip = next(b for b in self.boxes if b["name"] == joint)
            at_end, thick = int(r.integers(2)), float(r.uniform(0.15e-3, 0.4e-3))
            low, high = strip["x"]
            layer = (high - thick, high) if at_end else (low, low + thick)
            self.boxes.insert(0, {**strip, "name": f"G{joint}", "glued": joint, "x": layer, "material": EPOXY})
            self.right.append([("interface_compliance", self.joints[joint][at_end])])
            self.said.append(f"{1e3 * thick:.2f} mm of epoxy at {self.joints[joint][at_end]}")
        elif kind == "flexible":
            self.right.append([("body_flexibility", "B")])
            self.said.append("B is a plate that bends")
        elif kind == "columns":
            joint, name = self.storeys[int(r.integers(len(self.storeys)))]
            factor = float(r.choice([0.75, 0.85, 1.15]))
            self.stiffen(joint, factor)
            self.right.append([name])
            self.said.append(f"modulus of columns {joint} times {factor}")
        elif kind == "modulus":
            joint = str(r.choice(list(self.joints)))
            factor = float(r.choice([0.8, 0.85, 0.9, 1.15]))
            self.stiffen(joint, factor)
            self.right.append([("stiffness_change", joint)])
            self.size["stiffness_change"] = ("factor", factor)
            self.said.append(f"modulus of {joint} times {factor}")
        elif kind == "taper":  # no effect describes it
            joint = str(r.choice(list(self.joints)))
            taper = float(r.choice([-1, 1]) * r.uniform(0.1, 0.2))
            for b in self.boxes:
                if b["name"] == joint:
                    b["taper"] = taper
                    self.said.append(f"{joint} from {1e3 * b['height'] * (1 - taper):.1f} to {1e3 * b['height'] * (1 + taper):.1f} mm")
        elif kind == "rubber":  # under the block on its wall
            thick = float(r.uniform(0.3e-3, 1e-3))
            self.boxes.insert(0, {**self.boxes[0], "name": "R", "x": (-thick, 0.0), "material": EPOXY})
            # A block that moves on its wall moves what is fixed to it as if its own end of the strip gave way.
            ends = [("interface_compliance", self.joints["J"][0])]
            self.right.append(WALL_YIELDS + ends)
            self.said.append(f"{1e3 * thick:.2f} mm of epoxy between A and the wall")
        else:
            self.said.append(kind)

    def recorded(self, folder):
        """Writes fixture and recordings into the folder."""
        r = self.random
        shown = {n: p for n, p in self.points.items() if int(n) < 10}
        everything = {**self.points, **self.unseen}
        places = [x for _, x in everything.values()] + [x for x, *_ in self.hung]
        walls = [self.boxes[0]["x"][0]] if self.clamped else []
        if self.footing:
            plain = Solid(self.boxes, places, walls)
            hz, _ = plain.modes(folder, [] if self.clamped else [(x, k, "middle") for x, k, _ in self.hung], [], [self.unseen["91"][1]])
            elastic = hz[hz > 60.0] if not self.clamped else hz
            value = footing_that_gives(self.of_footing, elastic[0])
            for ends in self.joints.values():
                for end in ends:
                    yields = {"kind": "interface_compliance", "place": end, "dof": "rotation"}
                    self.fixture["physics"].append({**yields, "stiffness": self.known_to(0.08, value)})
        if self.hidden == "plain":  # an analyst who takes strips for massless Euler beams on rigid blocks
            self.fixture["physics"] = []
        springs, lumps = self.hide()
        wall = min(b["x"][0] for b in self.boxes)
        solid = Solid(self.boxes, places + self.extra, [wall] if self.clamped else [])
        names = list(shown) + list(self.unseen)
        natural, shapes = solid.modes(folder, springs, lumps, [everything[n][1] for n in names])
        ratios = np.exp(r.uniform(np.log(0.0015), np.log(0.008), len(natural)))
        if not self.clamped:
            ratios[natural < 60.0] = 0.01
        elastic = natural > 60.0
        # lines to about the last elastic mode that is meant to be seen
        seen = self.elastic if self.family == "frame" else 2
        top = 1.25 * natural[elastic][self.elastic - 1] if not self.clamped else 1.25 * natural[seen - 1]
        step = max(0.5, np.round(top / 480 * 2) / 2)
        hz = np.arange(20.0 if self.family != "frame" else max(step, 0.2 * natural[0]), top, step)
        inputs = [n for n in shown if shown[n][0] == "A"][:2] if not self.clamped else [n for n in shown if shown[n][0] == "B"]
        if self.family == "beam":
            inputs = list(shown)[:2]
        if self.family == "frame":
            inputs = [list(shown)[0], list(shown)[-1]]
        outputs = list(shown) if self.family in ("chain", "beam", "frame") else [n for n in shown if shown[n][0] != "A"]
        kinds = self.hidden.split("+")
        late = next((late for kind, late in (("delay", 8e-6), ("two", 10e-6)) if kind in kinds), None)
        if late or "gain" in kinds:
            channel = str(r.choice(outputs))
            self.right.append([("channel_delay" if late else "channel_gain", f"response {channel}")])
            self.said += f"; response {channel} " + ("late" if late else "8 % high")
        sets, unseen = [], []
        of = lambda out, into: accelerances(hz, natural, shapes, ratios, names.index(out), names.index(into))
        for into in inputs:
            for out in outputs:
                h = of(out, into)
                if late and out == channel:
                    h = h * np.exp(-2j * np.pi * hz * late)
                if "gain" in kinds and out == channel:
                    h = h * 1.08
                normal = lambda: r.normal(size=(AVERAGES, len(hz)))
                draws = h + (normal() + 1j * normal()) * self.scatter / np.sqrt(2) * np.abs(h)
                mean = draws.mean(axis=0)
                coherence = np.abs(mean) ** 2 / (np.abs(draws) ** 2).mean(axis=0)
                sets += [(mean, out, into, 4), (coherence.astype(complex), out, into, 6)]
        for out, into in (("92", "91"), ("92", inputs[0]), (outputs[-1], "91")):
            unseen.append((of(out, into), out, into, 4))
        write(folder / "frfs.uff", hz, sets)
        write(folder / "unseen.uff", hz, unseen)
        known = lambda n: 1e-4 if int(n) >= 10 else 2e-4
        self.fixture["points"] = {n: {"body": b, "x": self.about(x, known(n))} for n, (b, x) in self.points.items()}
        seen = ratios[elastic if not self.clamped else slice(None)][: self.elastic]
        self.fixture["damping"] = {"modal_ratios": [self.about(float(z), 0.25 * float(z)) for z in seen]}
        self.fixture["name"] = f"{self.family}-{self.hidden}"
        if self.family == "frame":
            self.fixture["supports"] = self.ground
        elif self.clamped:
            x = walls[0]
            wall = {"stiffness": {"value": 1e10, "std": 3e9}, "rotational_stiffness": {"value": 1e7, "std": 3e6}}
            self.fixture["supports"] = {"wall": {"body": "A", "x": x, **wall}}
        else:
            total = sum(self.mass.values())
            damping = 2 * 0.01 * np.sqrt(sum(k for _, k, _ in self.hung) * total) / len(self.hung)
            dashpot = {"value": damping, "std": damping / 2}
            hung = lambda x, k, b: {"body": b, "x": x, "stiffness": self.known_to(0.1, k), "damping": dashpot}
            self.fixture["supports"] = {f"S{i + 1}": hung(*each) for i, each in enumerate(self.hung)}
        (folder / "fixture.json").write_text(json.dumps(self.fixture, indent=1))
        right = [[{"kind": k, "place": [p]} for k, p in names] for names in self.right]
        truth = {"hidden": self.said, "right": right, "sizes": self.size, "natural": natural[:12].tolist()}
        (folder / "truth.json").write_text(json.dumps(truth, indent=1))


def write(path, hz, sets):
    path.unlink(missing_ok=True)
    data = []
    for values, out, into, function in sets:
        is_frf = function == 4
        of = dict(
            type=58,
            func_type=function,
            rsp_node=int(out),
            rsp_dir=2,
            ref_node=int(into),
            ref_dir=2,
            data=values,
            x=hz,
            binary=1,
            id1="simulated hammer test",
            id5=f"averages {AVERAGES}",
            abscissa_spacing=1,
            abscissa_spec_data_type=18,
            ordinate_spec_data_type=12 if is_frf else 0,
            orddenom_spec_data_type=13 if is_frf else 0,
            ordinate_axis_units_lab="m/s^2" if is_frf else "NONE",
            orddenom_axis_units_lab="N" if is_frf else "NONE",
        )
        data.append(of)
    pyuff.UFF(str(path)).write_sets(data)  # "overwrite" loses the first binary dataset


# --- asking ----------------------------------------------------------------------------------------------------------------------------------------------------------

def asked(program, folder):
    used = lambda: sum(resource.getrusage(resource.RUSAGE_CHILDREN)[:2])
    before = used()
    words = [str(program), "diagnose", "fixture.json", "frfs.uff", "-o", "out"]
    alone = {**os.environ, "RAYON_NUM_THREADS": "1"}
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, env=alone)
    if done.returncode:
        return None, used() - before, done.stderr
    return json.loads((folder / "out" / "diagnosis.json").read_text()), used() - before, ""


FAMILIES = {
    "pair": ["null", "lump", "ground", "delay", "modulus", "gain", "two"],
    "wide": ["null", "lump", "ground"],
    "chain": ["null", "lump", "ground", "modulus", "gain"],
    "clamped": ["null", "lump", "modulus", "ground"],
    "beam": ["null", "lump", "ground", "delay", "gain", "two"],
}


# Asked for by --more: what the lists above do not have.
MORE = {
    "pair": ["glue", "flexible", "plain"],
    "chain": ["glue", "plain"],
    "clamped": ["glue", "gain"],
    "wide": ["plain", "two"],
}
# Asked for by --rarer: several things at once, and what no effect describes or only a quantity does.
RARER = {
    "pair": ["lump+ground", "glue+lump", "modulus+gain", "taper", "ground+delay"],
    "chain": ["glue+glue", "lump+modulus", "taper", "lump+lump"],
    "clamped": ["rubber", "lump+gain"],
    "wide": ["lump+ground", "taper"],
    "beam": ["lump+ground", "lump+gain"],
}
# Asked for by --frames.
FRAMES = {"frame": ["null", "lump", "columns", "gain", "ground", "lump+columns", "delay"]}
# Names of a wall that yields.
WALL_YIELDS = [("quantity_error", f"supports/wall/{quantity}") for quantity in ("stiffness", "rotational_stiffness")]
# What is true of every solid that states footings and shear, and of one that states nothing of its strips.
TRUE = ["shear_deformation", "interface_compliance"]
TRUE_OF_PLAIN = TRUE + ["joint_mass", "joint_length", "stiffness_change", "footing"]


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("program")
    arguments.add_argument("--cases", type=int, default=len(sum(FAMILIES.values(), [])))
    arguments.add_argument("--more", action="store_true", help="glue, plates in place of blocks, strips of which nothing is stated")
    arguments.add_argument("--rarer", action="store_true", help="several things at once, strips that taper, walls that yield")
    arguments.add_argument("--frames", action="store_true", help="storeys on columns, stated as shear buildings")
    arguments.add_argument("--noise", type=float, default=1.0, help="times the usual 0.25 %%")
    arguments.add_argument("--seed", type=int, default=1)
    arguments.add_argument("--only", nargs="*")
    arguments.add_argument("--keep", type=pathlib.Path)
    given = arguments.parse_args()
    program = pathlib.Path(shutil.which(given.program) or given.program).resolve()
    families = MORE if given.more else RARER if given.rarer else FRAMES if given.frames else FAMILIES
    kinds = [(family, hidden) for family, some in families.items() for hidden in some]
    told = clean = hidden = nulls = named = sure = held = sized = 0
    for n in range(given.cases):
        family, what = kinds[n % len(kinds)]
        if given.only and f"{family}/{what}" not in given.only and str(n) not in given.only:
            continue
        random = np.random.default_rng([given.seed, n])
        with tempfile.TemporaryDirectory() as scratch:
            folder = given.keep / f"{n:03d}-{family}-{what}" if given.keep else pathlib.Path(scratch)
            folder.mkdir(parents=True, exist_ok=True)
            if not (folder / "truth.json").exists():
                Case(random, family, what, given.noise).recorded(folder)
            truth = json.loads((folder / "truth.json").read_text())
            answer, seconds, why = asked(program, folder)
        if answer is None:
            hidden, nulls = hidden + bool(truth["right"]), nulls + (not truth["right"])
            print(f"{n:3d} {family}/{what}: {why.strip()[:150]}", flush=True)
            continue
        findings, taken = answer["findings"], set()
        for names in truth["right"]:
            is_right = lambda f: any(f["kind"] == name["kind"] and f["place"] in name["place"] for name in names)
            taken |= {next((i for i, f in enumerate(findings) if i not in taken and is_right(f)), None)}
        found = None not in taken
        true = TRUE_OF_PLAIN if what == "plain" else TRUE
        untrue = [f for i, f in enumerate(findings) if i not in taken and f["kind"] not in true]
        for kind, (parameter, value) in truth["sizes"].items():
            for f in (findings[i] for i in taken - {None}):
                if f["kind"] == kind and "ci95" in f["parameters"][parameter]:
                    low, high = f["parameters"][parameter]["ci95"]
                    sized, held = sized + 1, held + (low <= value <= high)
        if truth["right"]:
            hidden, told, clean = hidden + 1, told + found, clean + (found and not untrue)
        else:
            nulls, named = nulls + 1, named + bool(untrue)
        sure += any(f["probability"] >= 0.9 for f in untrue)
        line = " ".join(f"{f['kind']}@{f['place']}:{f['probability']:.2f}" for f in findings)
        score = ("right" if found else "MISSED") if truth["right"] else "null"
        score += " + untrue" if untrue else ""
        print(f"{n:3d} {family + '/' + what:15s} {truth['hidden'][:46]:46s}", end=" ")
        print(f"{answer['verdict']:16s} {score:14s} {seconds:5.1f} s  {line}", flush=True)
    print(f"right {told} of {hidden}, nothing untrue beside {clean}; nulls named {named} of {nulls}; intervals {held} of {sized}; untrue with 0.9 or more {sure}")


if __name__ == "__main__":
    sys.exit(main())
