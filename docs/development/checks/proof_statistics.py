#!/usr/bin/env python3
"""Checks the statistics of a proof against SciPy.

    PROGRAM prove -o DIR
    python3 docs/development/checks/proof_statistics.py DIR

Binomial intervals of every rate by scipy.stats.binomtest; the detection classes counted anew from the cases, and the fitted course against a
minimum that scipy.optimize finds of the same penalised likelihood; the seal's SHA-256 against hashlib, where the truths are shipped. Ends with
status 1 if a deviation is too large.
"""
import hashlib
import json
import math
import pathlib
import sys

import numpy as np
import scipy.optimize
import scipy.stats

PRIOR = 0.02
directory = pathlib.Path(sys.argv[1])
proof = json.loads((directory / "proof.json").read_text())
failures = []


def report(what, value, limit):
    print(f"  {what:<60} {value:.2e}  {'ok' if value <= limit else 'TOO LARGE'}")
    if value > limit:
        failures.append(what)


worst = 0.0
for rate in proof["rates"].values():
    if rate["of"]:
        interval = scipy.stats.binomtest(rate["count"], rate["of"]).proportion_ci(0.95, "exact")
        worst = max(worst, abs(interval.low - rate["ci95"][0]), abs(interval.high - rate["ci95"][1]))
report("Clopper-Pearson intervals of all rates", worst, 1e-9)


def size(case):
    objectives = case["objectives"]
    without = [value for value in objectives["without"] if value is not None]
    return min([objectives["refitted"], *without]) - objectives["truth"]


def named(case):
    hidden = case["truth"]["hidden"].split(" (")[0]
    others = {other["name"]: other["objective"] for other in case["objectives"]["others"]}
    limit = case["objectives"]["truth"] + 9.0
    return any(f["name"] == hidden or (others.get(f["name"]) or math.inf) <= limit for f in case["found"])


singles = [case for case in proof["cases"] if case["truth"]["role"] in ("single", "graded") and case["verdict"]]
sizes = np.array([size(case) for case in singles])
found = np.array([named(case) for case in singles])
wrong = 0
for entry in proof["detection"]["classes"]:
    within = (np.maximum(sizes, 0) >= entry["from"]) & (np.maximum(sizes, 0) < (entry["to"] or math.inf))
    wrong += int(within.sum() != entry["named"]["of"]) + int(found[within].sum() != entry["named"]["count"])
report("detection classes that count otherwise", wrong, 0)

logs = np.log(np.maximum(sizes, 1.0))
centred = logs - logs.mean()


def penalised(p):
    x = p[0] + p[1] * centred
    return np.logaddexp(0, -x)[found].sum() + np.logaddexp(0, x)[~found].sum() + PRIOR / 2 * (p**2).sum()


best = scipy.optimize.minimize(penalised, [0.0, 1.0], method="Nelder-Mead", options={"xatol": 1e-10, "fatol": 1e-13, "maxiter": 10000})
course = [best.x[0] - best.x[1] * logs.mean(), best.x[1]]
report("course of detection, relative", max(abs(a / b - 1) for a, b in zip(course, proof["detection"]["course"])), 1e-5)

if proof["plan"].get("shipped"):
    truths = pathlib.Path(__file__).resolve().parents[3] / proof["plan"]["shipped"] / "truths.json"
    same = hashlib.sha256(truths.read_bytes()).hexdigest() == proof["sealed_truths_sha256"]
    report("SHA-256 of the shipped truths differs", float(not same), 0)

sys.exit(1 if failures else 0)
