#!/usr/bin/env python3
"""Checks what `jointscope export --to calculix` writes: CalculiX's FRFs of it against those of `jointscope synthesize`.

    python3 docs/development/checks/export_with_calculix.py PROGRAM

(a) a joint with K and C of different centres, decomposed from synthesized FRFs, exported, put between two rigid blocks; (b) a repaired fixture with
an added mass, a support, a resonator, a spring past the joint, a yielding interface and a softer joint. The blocks are made here, of point masses and *RIGID BODY. Largest relative deviation of
the complex receptances on lines from 60 to 1000 Hz. PROGRAM is the built binary, `ccx` must be on the path. CalculiX prints seven digits, so
5e-7 is what can be seen. Ends with status 1 if a deviation is above 1e-6.
"""
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
LIMIT = 1e-6
FIRST, LAST, STEP = 60.0, 1000.0, 23.5
LENGTH, EI = 0.065, 76.0
BLOCKS = {
    "A": {"mass": 1.10, "inertia": 9.5e-4, "x_cg": -0.030},
    "B": {"mass": 1.30, "inertia": 1.2e-3, "x_cg": 0.095},
}
POINTS = {
    "1": {"body": "A", "x": -0.060},
    "2": {"body": "A", "x": 0.0},
    "3": {"body": "B", "x": LENGTH},
    "4": {"body": "B", "x": 0.125},
}
K = [[1.4 * 12 * EI / LENGTH**3, -1.1 * 6 * EI / LENGTH**2], [-1.1 * 6 * EI / LENGTH**2, 4.3 * EI / LENGTH]]
C = [[30.0, -0.7], [-0.7, 0.03]]
failures = []


def run(folder, *arguments):
    done = subprocess.run([str(word) for word in arguments], cwd=folder, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{arguments}: {done.stdout[-500:]} {done.stderr[-500:]}")
    return done.stdout


def receptances(path):
    """{(response, reference): {Hz: value}} of accelerances in ASCII dataset 58."""
    found = {}
    for block in re.findall(r"^    -1\n    58 *\n(.*?)^    -1$", path.read_text(), re.S | re.M):
        lines = block.splitlines()
        fields = lines[5].split()
        numbers = [field for field in fields if re.fullmatch(r"-?\d+", field)]
        response, reference = numbers[4], numbers[6]
        count, start, step = int(lines[6].split()[1]), float(lines[6].split()[3]), float(lines[6].split()[4])
        values = [float(word) for line in lines[11:] for word in line.split()]
        pairs = zip(values[::2], values[1::2])
        curve = {}
        for index, (real, imaginary) in zip(range(count), pairs):
            hz = start + index * step
            curve[hz] = -complex(real, imaginary) / (2 * math.pi * hz) ** 2
        found[response, reference] = curve
    return found


def deck(exported, nodes, rotations, load):
    """The blocks around the exported file: rigid bodies with two point masses each, the load's y, and lines one by one."""
    out = []
    add = out.append
    add("*NODE")
    for node in exported["nodes"]:
        add(f"{node['number']}, {node['x']:.12e}, 0., 0.")
    for node in rotations.values():
        add(f"{node}, 0., 0., 0.")
    outputs = []
    element = 1
    for index, (name, block) in enumerate(BLOCKS.items()):
        radius = math.sqrt(block["inertia"] / block["mass"])
        reference = 800001 + 100 * index
        masses = [reference + 1, reference + 2]
        own = [node for node, (body, _) in nodes.items() if body == name]
        defined = {node["number"] for node in exported["nodes"]}
        add("*NODE")
        add(f"{reference}, {block['x_cg']:.12e}, 0., 0.")
        for node, x in zip(masses, (block["x_cg"] - radius, block["x_cg"] + radius)):
            add(f"{node}, {x:.12e}, 0., 0.")
        for number, point in POINTS.items():
            if point["body"] == name and int(number) not in defined:
                add(f"{number}, {point['x']:.12e}, 0., 0.")
                own.append(int(number))
        turning = [rotation for node, rotation in rotations.items() if node in own]
        add(f"*NSET, NSET=BLOCK{name}")
        out.extend(str(node) for node in sorted(own + masses))
        add(f"*RIGID BODY, NSET=BLOCK{name}, REF NODE={reference}, ROT NODE={turning[0]}")
        add(f"*ELEMENT, TYPE=MASS, ELSET=MASS{name}")
        for node in masses:
            add(f"{element}, {node}")
            element += 1
        add(f"*MASS, ELSET=MASS{name}")
        add(f"{block['mass'] / 2:.12e}")
        add(f"*BOUNDARY\n{reference}, 1, 1\n{reference}, 3, 3\n{turning[0]}, 1, 2")
        outputs += [node for node in own if node < 100]
    # After the rigid bodies: CalculiX takes equations that come before them wrongly.
    add("*INCLUDE, INPUT=joint.inp")
    # ARPACK wants more degrees of freedom than modes: masses far above the band, connected with nothing.
    add("*NODE\n810000, 0., 0., 0.")
    spares = range(810001, 810061)
    out.extend(f"{node}, {node - 810000}., 0., 0." for node in spares)
    add("*ELEMENT, TYPE=MASS, ELSET=SPAREM")
    out.extend(f"{node}, {node}" for node in spares)
    add("*MASS, ELSET=SPAREM\n1.E-3\n*ELEMENT, TYPE=SPRINGA, ELSET=SPARES")
    out.extend(f"{node + 100}, 810000, {node}" for node in spares)
    add("*SPRING, ELSET=SPARES\n1.E9\n*BOUNDARY\n810000, 1, 3")
    out.extend(f"{node}, 2, 3" for node in spares)
    add("*NSET, NSET=OUT\n" + ", ".join(str(node) for node in sorted(outputs)))
    add("*STEP\n*FREQUENCY, STORAGE=YES\n8\n*END STEP")
    hz = FIRST
    while hz < LAST:
        add(f"*STEP\n*STEADY STATE DYNAMICS\n{hz}, {hz + STEP}, 2\n*CLOAD\n{load}, 2, 1.\n*NODE PRINT, NSET=OUT\nU\n*END STEP")
        hz += STEP
    return "\n".join(out) + "\n"


def calculix(folder):
    """{(node, Hz): displacement}."""
    run(folder, "ccx", "deck")
    text = (folder / "deck.dat").read_text()
    found = {}
    for part in text.split("F R E Q U E N C Y  ")[1:]:
        hz = float(part.split()[0])
        tables = re.findall(r"displacements.*?\n\n((?:\s+\d+(?:\s+\S+){3}\n)+)", part)
        if len(tables) != 2:
            continue
        real, imaginary = ({row.split()[0]: float(row.split()[2]) for row in table.splitlines() if row.strip()} for table in tables)
        for node in real:
            found[node, hz] = complex(real[node], imaginary[node])
    return found


def compare(what, folder, answer, fixture):
    print(what)
    exported = run(folder, PROGRAM, "export", answer, "--to", "calculix", "-o", "joint.inp")
    text = (folder / "joint.inp").read_text()
    run(folder, PROGRAM, "export", answer, "--to", "json", "-o", "joint.json")
    exported = json.loads((folder / "joint.json").read_text())
    nodes = {}
    for node in exported["nodes"]:
        body = re.search(r"body (\w+)", node["says"])
        if body:
            nodes[node["number"]] = (body.group(1), node["x"])
    comment = re.sub(r"\n\*\*\s+", " ", text.split("*NODE")[0])
    rotations = {int(node): int(own) for own, node in re.findall(r"node (\d+) holds the rotation at node (\d+)", comment)}
    pairs = ["1/1", "2/1", "3/1", "4/1"]
    run(folder, PROGRAM, "synthesize", fixture, "--ascii", "--lines", f"{FIRST}:{LAST}:{STEP}", "--frf", *pairs, "-o", "ours.uff")
    ours = receptances(folder / "ours.uff")
    (folder / "deck.inp").write_text(deck(exported, nodes, rotations, 1))
    theirs = calculix(folder)
    worst, compared = 0.0, 0
    for (response, _), curve in ours.items():
        for hz, value in curve.items():
            near = [other for (node, at), other in theirs.items() if node == response and abs(at / hz - 1) < 1e-9]
            if near:
                worst = max(worst, abs(near[0] / value - 1))
                compared += 1
    print(f"  {compared} values of {len(ours)} FRFs, largest relative deviation {worst:.2e}  {'ok' if worst <= LIMIT and compared > 100 else 'TOO LARGE'}")
    if worst > LIMIT or compared <= 100:
        failures.append(what)


def joint_of_a_decomposition(folder):
    fixture = {"bodies": BLOCKS, "points": POINTS, "joints": {"J": {"from": "2", "to": "3", "stiffness": K, "damping": C}}}
    (folder / "fixture.json").write_text(json.dumps(fixture))
    run(folder, PROGRAM, "synthesize", "fixture.json", "--lines", "10:1000:5", "-o", "frf.uff")
    run(folder, PROGRAM, "decompose", "fixture.json", "frf.uff", "-o", "answer")
    compare("(a) a joint of a decomposition, K and C about different centres", folder, "answer", "fixture.json")


def repaired_fixture(folder):
    physics = [
        {"kind": "added_mass", "place": "B", "x": 0.11, "mass": 0.07},
        {"kind": "support", "place": "A", "x": -0.02, "stiffness": 2.5e5, "damping": 12.0},
        {"kind": "attached_resonator", "place": "A", "x": -0.06, "mass": 0.02, "frequency": 300.0, "damping_ratio": 0.02},
        {"kind": "bypass", "place": "A/B", "x_from": -0.03, "x_to": 0.1, "stiffness": 3e4, "damping": 1.0},
        {"kind": "interface_compliance", "place": "3", "dof": "rotation", "stiffness": 9000.0, "damping": 0.0},
        {"kind": "stiffness_change", "place": "J", "factor": 0.9},
    ]
    beam = {"youngs_modulus": 2.0e11, "second_moment": EI / 2.0e11}
    fixture = {"bodies": BLOCKS, "points": POINTS, "joints": {"J": {"from": "2", "to": "3", "beam": beam}}, "physics": physics}
    answer = folder / "answer"
    answer.mkdir()
    (answer / "repaired.json").write_text(json.dumps(fixture))
    (answer / "diagnosis.json").write_text(json.dumps({"verdict": "explained", "findings": [], "recording": {"from": 10, "to": 1000}}))
    compare("(b) a repaired fixture: mass, support, resonator, bypass, interface, softer joint", folder, "answer", "answer/repaired.json")


for case in (joint_of_a_decomposition, repaired_fixture):
    with tempfile.TemporaryDirectory() as directory:
        case(pathlib.Path(directory))
sys.exit(1 if failures else 0)
