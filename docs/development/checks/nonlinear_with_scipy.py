"""Accelerations that `jointscope simulate` computes of joints with a cubic spring, friction or a gap, against SciPy.

    python3 docs/development/checks/nonlinear_with_scipy.py PROGRAM

M, C and K of two blocks and a beam are made here from the fixture's JSON; scipy.integrate.solve_ivp (DOP853) follows them, piece by piece between the
events at which a slider sticks or slips and a gap opens or closes. The force is a Gaussian blow, in the file its samples, here the function itself.
Only the files are shared with the program; pyuff writes and reads them.
"""

import json
import os
import subprocess
import sys
import tempfile

import numpy as np
import pyuff
import scipy.integrate
import scipy.linalg

PROGRAM = sys.argv[1]
FOLDER = tempfile.mkdtemp()
RATE, SAMPLES, ONSET, WIDTH, PEAK = 6400.0, 1024, 60 / 6400.0, 2.4 / 6400.0, 300.0
FIXTURE = {
    "name": "two blocks and a beam",
    "bodies": {"A": {"mass": 1.10, "inertia": 9.5e-4, "x_cg": -0.030}, "B": {"mass": 1.10, "inertia": 9.5e-4, "x_cg": 0.095}},
    "points": {"1": {"body": "A", "x": -0.060}, "2": {"body": "A", "x": 0.0}, "3": {"body": "B", "x": 0.065}, "4": {"body": "B", "x": 0.125}},
    "joints": {"J": {"from": "2", "to": "3", "beam": {"youngs_modulus": 2.07e11, "second_moment": 3.67e-10}}},
    "damping": {"modal_ratios": [0.02, 0.01]},
}
LAWS = {
    "linear": None,
    "cubic_stiffness, translation": {"kind": "cubic_stiffness", "dof": "translation", "stiffness3": 4e13},
    "friction, translation": {"kind": "friction", "dof": "translation", "slip_force": 20.0, "stiffness": 1e6},
    "friction, rotation": {"kind": "friction", "dof": "rotation", "slip_force": 0.5, "stiffness": 1500.0},
    "gap, translation": {"kind": "gap", "dof": "translation", "clearance": 1e-5, "stiffness": 1e6},
    "gap, rotation": {"kind": "gap", "dof": "rotation", "clearance": 2e-4, "stiffness": 1500.0},
}


def force(t):
    return PEAK * np.exp(-0.5 * ((t - ONSET) / WIDTH) ** 2)


def matrices():
    """M, C, K on (y, θ) at the centres of gravity of A and B, and the rows that read points and the joint's d."""
    bodies, points = FIXTURE["bodies"], FIXTURE["points"]
    mass = np.diag([v for b in "AB" for v in (bodies[b]["mass"], bodies[b]["inertia"])])

    def rows(name):
        first = 2 * "AB".index(points[name]["body"])
        y, theta = np.zeros(4), np.zeros(4)
        y[first], y[first + 1] = 1.0, points[name]["x"] - bodies[points[name]["body"]]["x_cg"]
        theta[first + 1] = 1.0
        return y, theta

    length = points["3"]["x"] - points["2"]["x"]
    (y2, t2), (y3, t3) = rows("2"), rows("3")
    d = np.array([y3 - y2 - length * t2, t3 - t2])
    beam = FIXTURE["joints"]["J"]["beam"]
    ei = beam["youngs_modulus"] * beam["second_moment"]
    k = ei / length**3 * np.array([[12, -6 * length], [-6 * length, 4 * length**2]])
    stiffness = d.T @ k @ d
    values, shapes = scipy.linalg.eigh(stiffness, mass)
    omega = np.sqrt(values[2:])
    elastic = mass @ shapes[:, 2:]
    damping = elastic @ np.diag(2 * np.array(FIXTURE["damping"]["modal_ratios"]) * omega) @ elastic.T
    return mass, damping, stiffness, d, {name: rows(name)[0] for name in points}


def followed(law):
    """Accelerations at 3 and 4 under the blow at 1."""
    mass, damping, stiffness, across, rows = matrices()
    inverse = np.linalg.inv(mass)
    d = across[0 if law is None or law["dof"] == "translation" else 1]
    times = np.arange(SAMPLES) / RATE

    def borne(q, z, mode):
        if law is None:
            return 0.0
        if law["kind"] == "cubic_stiffness":
            return law["stiffness3"] * (d @ q) ** 3
        if law["kind"] == "gap":
            return law["stiffness"] * (d @ q - law["clearance"]) if mode == "closed" else 0.0
        return z if mode == "stuck" else (law["slip_force"] if mode == "up" else -law["slip_force"])

    def acceleration(t, state, mode):
        q, v, z = state[:4], state[4:8], state[8]
        return inverse @ (rows["1"] * force(t) - stiffness @ q - damping @ v - d * borne(q, z, mode))

    def rates(t, state, mode):
        sticks = law is not None and law["kind"] == "friction" and mode == "stuck"
        return np.concatenate([state[4:8], acceleration(t, state, mode), [law["stiffness"] * (d @ state[4:8]) if sticks else 0.0]])

    def events(mode):
        """Where the law goes over to another branch: function, direction, branch."""
        if law is None or law["kind"] == "cubic_stiffness":
            return []
        if law["kind"] == "gap":
            return [(lambda t, s: d @ s[:4] - law["clearance"], *((1, "closed") if mode == "open" else (-1, "open")))]
        if mode == "stuck":
            return [(lambda t, s: s[8] - law["slip_force"], 1, "up"), (lambda t, s: s[8] + law["slip_force"], -1, "down")]
        return [(lambda t, s: d @ s[4:8], -1 if mode == "up" else 1, "stuck")]

    state, now, mode = np.zeros(9), 0.0, "stuck" if law and law["kind"] == "friction" else "open"
    readings = np.zeros((2, SAMPLES))
    done = 0
    while done < SAMPLES:
        watched = []
        for function, direction, to in events(mode):
            def event(t, s, function=function):
                return function(t, s)
            event.terminal, event.direction = True, direction
            watched.append((event, to))
        solution = scipy.integrate.solve_ivp(
            lambda t, s: rates(t, s, mode), (now, times[-1] + 1e-9), state, method="DOP853", rtol=1e-10, atol=1e-14, max_step=5e-5,
            events=[e for e, _ in watched] or None, dense_output=True)
        end = solution.t[-1]
        while done < SAMPLES and times[done] <= end:
            a = acceleration(times[done], solution.sol(times[done]), mode)
            readings[:, done] = rows["3"] @ a, rows["4"] @ a
            done += 1
        state, now = solution.y[:, -1].copy(), end
        for (_, to), times_of in zip(watched, solution.t_events or []):
            if len(times_of):
                mode = to
                break
        # A slider starts anew from exactly what it bears.
        if law and law["kind"] == "friction" and mode in ("up", "down"):
            state[8] = law["slip_force"] if mode == "up" else -law["slip_force"]
    return readings


def simulated(law):
    fixture = dict(FIXTURE)
    if law is not None:
        fixture["physics"] = [{**law, "place": "J"}]
    paths = {name: os.path.join(FOLDER, name) for name in ("fixture.json", "force.uff", "responses.uff")}
    with open(paths["fixture.json"], "w") as file:
        json.dump(fixture, file)
    if os.path.exists(paths["force.uff"]):
        os.remove(paths["force.uff"])
    times = np.arange(SAMPLES) / RATE
    pyuff.UFF(paths["force.uff"]).write_sets(
        {"type": 58, "func_type": 1, "ver_num": 1, "rsp_node": 1, "rsp_dir": 2, "ref_node": 0, "ref_dir": 0, "data": force(times), "x": times,
         "binary": 1, "id1": "blow", "abscissa_spacing": 1, "ord_data_type": 4, "abscissa_spec_data_type": 17,
         "ordinate_spec_data_type": 13, "orddenom_spec_data_type": 0, "ordinate_axis_units_lab": "N", "n_bytes": 0}, "add", force_double=True)
    subprocess.run([PROGRAM, "simulate", paths["fixture.json"], "--force", paths["force.uff"], "--at", "3", "4", "-o", paths["responses.uff"]],
                   check=True, stdout=subprocess.DEVNULL)
    found = {s["rsp_node"]: np.sign(s["rsp_dir"]) * s["data"] for s in pyuff.UFF(paths["responses.uff"]).read_sets()}
    return np.array([found[3], found[4]])


def main():
    plain = followed(None)
    print(f"{'law':30} {'largest deviation':>18} {'rms deviation':>14} {'what the law changes':>21}")
    for name, law in LAWS.items():
        expected, found = followed(law), simulated(law)
        size = np.abs(expected).max()
        print(f"{name:30} {np.abs(found - expected).max() / size:18.1e} "
              f"{np.sqrt(np.mean((found - expected) ** 2) / np.mean(expected**2)):14.1e} {np.abs(expected - plain).max() / size:21.1e}")


main()
