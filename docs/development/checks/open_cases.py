#!/usr/bin/env python3
"""Runs `jointscope decompose` over a folder of cases and sets what it finds against their truth.

    python3 docs/development/checks/open_cases.py PROGRAM CASES [--true]

PROGRAM is the built binary. CASES holds one folder a case with fixture.json, frf.uff or hits.uff, and truth.json. Prints a table
in Markdown. k is that of the maximum-likelihood fit, its uncertainty noise and tolerances together. The truth of k is the fixture's
joint at its true quantities: where an effect sits in the joint itself, the joint is meant to come out as another one. The truth of c is
that of the assembly's proportional damping. With --true the program is given the fixture at its true quantities, as exact. Needs numpy.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

ELEMENTS = [(0, 0), (0, 1), (1, 1)]


def number(entry):
    return entry["value"] if isinstance(entry, dict) else entry


def true_fixture(case):
    """The fixture with every quantity as it really was, standard deviations dropped."""
    fixture = json.loads((case / "fixture.json").read_text())
    truth = json.loads((case / "truth.json").read_text())

    def plain(entry):
        if isinstance(entry, dict):
            return entry["value"] if "value" in entry else {key: plain(value) for key, value in entry.items()}
        return [plain(value) for value in entry] if isinstance(entry, list) else entry

    fixture = plain(fixture)
    for path, quantity in truth["true_quantities"].items():
        *folders, last = path.split("/")
        place = fixture
        for key in folders:
            place = place[int(key)] if isinstance(place, list) else place[key]
        if isinstance(place, list):
            place[int(last)] = quantity["true"]
        else:
            place[last] = quantity["true"]
    return fixture, truth


def joint_stiffness(fixture, name):
    joint = fixture["joints"][name]
    if "stiffness" in joint:
        return np.array(joint["stiffness"])
    length = fixture["points"][joint["to"]]["x"] - fixture["points"][joint["from"]]["x"]
    bending = joint["beam"]["youngs_modulus"] * joint["beam"]["second_moment"]
    return bending / length**3 * np.array([[12, -6 * length], [-6 * length, 4 * length**2]])


def joint_damping(fixture, name):
    """The 2x2 dashpot of the only joint of two free rigid blocks with modal ratios; None elsewhere."""
    ratios = fixture["damping"].get("modal_ratios")
    bodies = list(fixture["bodies"].values())
    if ratios is None or len(bodies) != 2 or "supports" in fixture or not all(b.get("rotates", True) for b in bodies):
        return None
    joint = fixture["joints"][name]
    ends = [fixture["points"][joint[end]]["x"] for end in ("from", "to")]
    mass, length = np.zeros((4, 4)), ends[1] - ends[0]
    for i, (body, x) in enumerate(zip(bodies, ends)):
        arm = body["x_cg"] - x
        mass[2 * i:2 * i + 2, 2 * i:2 * i + 2] = [
            [body["mass"], body["mass"] * arm], [body["mass"] * arm, body["inertia"] + body["mass"] * arm**2]]
    across = np.hstack([-np.array([[1, length], [0, 1]]), np.eye(2)])
    stiffness = across.T @ joint_stiffness(fixture, name) @ across
    factor = np.linalg.inv(np.linalg.cholesky(mass))
    eigenvalues, shapes = np.linalg.eigh(factor @ stiffness @ factor.T)
    weighted = mass @ factor.T @ shapes[:, 2:]
    zeta = [ratios[min(i, len(ratios) - 1)] for i in range(2)]
    damping = weighted @ np.diag(2 * np.array(zeta) * np.sqrt(eigenvalues[2:])) @ weighted.T
    return damping[2:, 2:]


def text(value, std):
    """Value and uncertainty with as many digits as the uncertainty deserves."""
    if not np.isfinite(std) or std <= 0:
        return f"{value:.4g}"
    digits = max(0, int(np.floor(np.log10(max(abs(value), std)))) - int(np.floor(np.log10(std))) + 1)
    return f"{value:.{digits}e} ± {std:.1e}"


def run(program, case, joint, scores, at_truth):
    fixture, truth = true_fixture(case)
    recording = case / "frf.uff" if (case / "frf.uff").exists() else case / "hits.uff"
    effects = ", ".join(f"{e['kind']} {e.get('place', '')}".strip() for e in truth["effects"]) or "none"
    with tempfile.TemporaryDirectory() as folder:
        chosen = ["--joint", joint] if joint else []
        believed = case / "fixture.json"
        if at_truth:
            believed = pathlib.Path(folder) / "true.json"
            believed.write_text(json.dumps(fixture))
            chosen.append("--exact")
        done = subprocess.run([program, "decompose", believed, recording, *chosen, "-o", folder],
                              capture_output=True, text=True)
        name = f"{case.name}{' ' + joint if joint else ''}"
        if done.returncode:
            says = done.stderr.strip().replace(str(case) + "/", "").replace(folder + "/", "").removeprefix("jointscope: ")
            print(f"| {name} | {effects} | {done.returncode} | – | {says} | | | |")
            return sorted(fixture["joints"]) if "--joint" in says else []
        result = json.loads((pathlib.Path(folder) / "stiffness.json").read_text())
    fit = result["maximum_likelihood"]
    solved = f"{len(result['lines'])}/{len(result['lines']) + len(result['masked'])}"
    if "failed" in fit:
        print(f"| {name} | {effects} | 0 | {solved} | {fit['failed']} | | | |")
        return []
    joint = result["joint"]
    scalar = not any(b.get("rotates", True) for b in fixture["bodies"].values())
    cells, truths = [], {"stiffness": joint_stiffness(fixture, joint), "damping": joint_damping(fixture, joint)}
    for i, j in ELEMENTS[:1] if scalar else ELEMENTS:
        for part in ("stiffness", "damping"):
            parts = ("std", "std_fixture", "std_model")
            std = float(np.linalg.norm([fit[name][part][i][j] for name in parts]))
            value = fit[part][i][j]
            if part == "stiffness":
                cells.append(f"{text(value, std)} ({truths[part][i, j]:.4g})")
            if truth["role"] == "null" and truths[part] is not None:
                z = (value - truths[part][i, j]) / std
                scores.append((name, f"{'k' if part == 'stiffness' else 'c'}{i + 1}{j + 1}", value, truths[part][i, j], std, z))
    cells += ["–"] * (3 - len(cells))
    print(f"| {name} | {effects} | 0 | {solved} | {' | '.join(cells)} | {fit['chi2_per_dof']:.4g} |")
    return []


def main():
    program, cases, at_truth = sys.argv[1], pathlib.Path(sys.argv[2]), "--true" in sys.argv[3:]
    print("| case | hidden effects | exit | lines solved | k11 (true), N/m | k12, N/rad | k22, N m/rad | chi2/dof |")
    print("|---|---|---|---|---|---|---|---|")
    scores = []
    for case in sorted(p for p in cases.iterdir() if p.is_dir()):
        for joint in run(program, case, None, scores, at_truth):
            run(program, case, joint, scores, at_truth)
    print("\nWithout hidden effects, against the truth:\n")
    print("| case | element | found | true | std | z |\n|---|---|---|---|---|---|")
    for name, element, value, true, std, z in scores:
        print(f"| {name} | {element} | {value:.5g} | {true:.5g} | {std:.2g} | {z:+.2f} |")
    inside = sum(abs(score[-1]) <= 1.96 for score in scores)
    print(f"\n{inside} of {len(scores)} within 1.96 standard deviations.")


if __name__ == "__main__":
    main()
