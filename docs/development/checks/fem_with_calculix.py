#!/usr/bin/env python3
"""Checks the finite-element twin against CalculiX on the same mesh, and its default mesh against finer ones.

    python3 docs/development/checks/fem_with_calculix.py PROGRAM [--quick]

(a) first ten elastic frequencies of each of the paper's fixtures, half and whole depth, from the deck that `jointscope fem --deck` writes
(C3D20 bricks), against `ccx`; (b) a mesh of about 20,000 equations: time and memory of both programs, one after the other; (c) the default
mesh against the value extrapolated from finer ones (left out with --quick). PROGRAM is the built binary, `ccx` must be on the path. Ends with status 1 if a deviation is too large.
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[3] / "fixtures" / "paper"
PROGRAM = pathlib.Path(sys.argv[1]).resolve()
QUICK = "--quick" in sys.argv
failures = []


def report(what, value, limit):
    print(f"  {what:<78} {value:.2e}  {'ok' if value <= limit else 'TOO LARGE'}")
    if not value <= limit:
        failures.append(what)


def timed(command, **more):
    """Processor seconds (a machine may be busy with other work) and peak MB of the child, and what it printed."""
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **more)
    text = process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        sys.exit(f"{command}: {text[-800:]}")
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024, text


def twin(name, folder, *options):
    command = [PROGRAM, "fem", ROOT / f"{name}.json", *options, "--deck", "deck.inp", "-o", "twin.uff"]
    seconds, memory, text = timed([str(word) for word in command], cwd=folder)
    hz = [float(value) for value in re.findall(r"mode \d+: ([\d.]+) Hz", text)]
    equations = int(re.search(r"(\d+) equations", text).group(1))
    return hz, equations, seconds, memory


def calculix(folder, threads=1):
    environment = dict(os.environ, OMP_NUM_THREADS=str(threads))
    seconds, memory, _ = timed(["ccx", "deck"], cwd=folder, env=environment)
    rows = []
    for line in (pathlib.Path(folder) / "deck.dat").read_text().splitlines():
        fields = line.split()
        if len(fields) == 5 and fields[0].isdigit():
            rows.append(float(fields[3]))
        if "P A R T I C I P A T I O N" in line:
            break
    return rows, seconds, memory


def frequencies():
    print("first ten elastic frequencies on the same mesh, largest relative deviation")
    for name in ("D0", "E0", "F01", "F02"):
        for depth in ((), ("--whole",)):
            with tempfile.TemporaryDirectory() as folder:
                ours, equations, *_ = twin(name, folder, "--corner", "3", "--along", "8", "--across", "2", "--modes", "10", *depth)
                rows, *_ = calculix(folder)
                theirs = rows[6 if depth else 3:]
                worst = max(abs(a / b - 1) for a, b in zip(ours[:10], theirs[:10], strict=True))
                report(f"{name}{' '.join(('',) + depth)}, {equations} equations, {ours[0]:.2f} to {ours[9]:.0f} Hz", worst, 1e-3)


def twenty_thousand():
    print("a mesh of about 20,000 equations, modes to 2000 Hz and H41 on 400 lines; CalculiX finds the lowest 7 modes and no FRF")
    with tempfile.TemporaryDirectory() as folder:
        # The same number of modes for both: three rigid ones and four.
        ours, equations, seconds, memory = twin("D0", folder, "--corner", "9", "--along", "12")
        deck = (pathlib.Path(folder) / "deck.inp").read_text().replace("*FREQUENCY\n16\n", "*FREQUENCY\n7\n")
        (pathlib.Path(folder) / "deck.inp").write_text(deck)
        print(f"  jointscope fem: {equations} equations, {seconds:.2f} s, {memory:.0f} MB (one thread)")
        for threads in (1, 2):
            theirs, ccx_seconds, ccx_memory = calculix(folder, threads)
            print(f"  ccx, {threads} thread(s): {ccx_seconds:.2f} s, {ccx_memory:.0f} MB")
        report("their first four elastic frequencies", max(abs(a / b - 1) for a, b in zip(ours[:4], theirs[3:7])), 1e-3)
        report("seconds", seconds, 10)
        report("MB", memory, 1000)


def converged():
    print("the default mesh against the limit of finer ones (first two modes)")
    for name in ("D0", "E0", "F01", "F02"):
        with tempfile.TemporaryDirectory() as folder:
            default, equations, seconds, _ = twin(name, folder)
            fine, *_ = twin(name, folder, "--corner", "32", "--along", "24", "--across", "4")
            finest, *_ = twin(name, folder, "--corner", "64", "--along", "32", "--across", "5")
            for mode in (0, 1):
                # At a right-angled corner the energy, and so the frequency, converges about as the element size there: what halving it
                # changes is still to come.
                limit = finest[mode] + (finest[mode] - fine[mode])
                text = f"{name} mode {mode + 1}: {default[mode]:.3f} Hz, limit {limit:.3f} Hz ({equations} equations, {seconds:.1f} s)"
                report(text, abs(default[mode] / limit - 1), 5e-3)


frequencies()
twenty_thousand()
if not QUICK:
    converged()
sys.exit(1 if failures else 0)
