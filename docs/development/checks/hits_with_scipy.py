"""FRFs that `jointscope estimate` makes of hammer hits, against SciPy and pyFRF.

    python3 docs/development/checks/hits_with_scipy.py PROGRAM RECORDINGS [CASES]

RECORDINGS holds `hammer-hit/hits.uff` (two hits, one force, two accelerations; see docs/records/2026-11-22-real-recordings.md). CASES, if given, holds
simulated cases with `hits.uff` (time histories at several levels). Only the files are shared with the program; pyuff reads them.
"""

import os
import subprocess
import sys
import tempfile
import time
import warnings

import numpy as np
import pyuff
import scipy.signal

warnings.filterwarnings("ignore")
PROGRAM, RECORDINGS = sys.argv[1:3]
CASES = sys.argv[3] if len(sys.argv) > 3 else None
FOLDER = tempfile.mkdtemp()


def hits_of(path):
    """Hits by number: struck node, interval, force and responses along +y, by the files' own directions."""
    hits = {}
    for d in pyuff.UFF(path).read_sets():
        hit = hits.setdefault(d["ver_num"], {"responses": {}, "interval": d["abscissa_inc"]})
        values = np.sign(d["rsp_dir"]) * d["data"].astype(float)
        if d["ordinate_spec_data_type"] == 13:
            hit["force"], hit["struck"] = values, d["rsp_node"]
        else:
            hit["responses"][d["rsp_node"]] = values
    return [hits[number] for number in sorted(hits)]


def estimated(path, *options):
    """(function type, response, reference) → values, by the program."""
    out = os.path.join(FOLDER, "frf.uff")
    begun = time.perf_counter()
    subprocess.run([PROGRAM, "estimate", path, "-o", out, *options], check=True, stdout=subprocess.DEVNULL)
    seconds = time.perf_counter() - begun
    sets = pyuff.UFF(out).read_sets()
    return {(d["func_type"], d["rsp_node"], d["ref_node"]): d["data"] for d in sets}, seconds


def largest(found, expected):
    return max(np.max(np.abs(f - e) / np.abs(e)) for f, e in zip(found, expected))


def by_scipy(hits, response, struck):
    """Sxx, Syy, Sxy over one rectangular block a hit, offsets removed, as scipy.signal.csd takes them."""
    used = [h for h in hits if h["struck"] == struck and response in h["responses"]]
    n = len(used[0]["force"])
    x = np.concatenate([h["force"] for h in used])
    y = np.concatenate([h["responses"][response] for h in used])
    options = dict(fs=1 / used[0]["interval"], window="boxcar", nperseg=n, noverlap=0, detrend="constant")
    spectra = [scipy.signal.csd(a, b, **options)[1] for a, b in ((x, x), (y, y), (x, y))]
    coherence = scipy.signal.coherence(x, y, **options)[1]
    return [*spectra, coherence]


def compare(name, path, lines, options=()):
    hits = hits_of(path)
    pairs = sorted({(r, h["struck"]) for h in hits for r in h["responses"]})
    rows = {}
    for estimator in ("H1", "H2", "Hv"):
        found, _ = estimated(path, "--estimator", estimator, *options)
        expected = []
        for response, struck in pairs:
            xx, yy, xy, coherence = by_scipy(hits, response, struck)
            h1, h2 = xy / xx, yy / np.conj(xy)
            expected.append({"H1": h1, "H2": h2, "Hv": h1 * np.sqrt(np.abs(h2 / h1))}[estimator][lines])
            if estimator == "H1":
                c = found[(6, response, struck)][lines].real
                rows["coherence"] = max(rows.get("coherence", 0.0), np.max(np.abs(c - coherence[lines])))
        rows[estimator] = largest([found[(4, *pair)][lines] for pair in pairs], expected)
    print(f"{name}, against SciPy: " + ", ".join(f"{k} {v:.1e}" for k, v in rows.items()))


def against_pyfrf(path, lines):
    import pyFRF

    hits = hits_of(path)
    struck = hits[0]["struck"]
    nodes = sorted(hits[0]["responses"])
    n = len(hits[0]["force"])
    centred = lambda values: values - values.mean()
    exc = np.array([[centred(hit["force"])] for hit in hits])
    resp = np.array([[centred(hit["responses"][node]) for node in nodes] for hit in hits])
    frf = pyFRF.FRF(
        sampling_freq=1024, exc=exc, resp=resp, exc_type="f", resp_type="a", window="none", resp_delay=0.0,
        fft_len=n)
    # It takes whole rates only; the rate enters nothing but its receptances, which are turned back with the same one.
    omega = 2 * np.pi * np.fft.rfftfreq(n, 1 / 1024)[lines]
    for name, values in (("H1", frf.get_H1()), ("H2", frf.get_H2())):
        found, _ = estimated(path, "--estimator", name)
        # pyFRF returns receptances.
        expected = [-(omega**2) * values[i, 0, lines] for i in range(len(nodes))]
        print(f"hammer-hit, {name} against pyFRF {pyFRF.__version__}: {largest([found[(4, node, struck)][lines] for node in nodes], expected):.1e}")
    found, _ = estimated(path)
    coherence = frf.get_coherence()
    off = max(np.max(np.abs(found[(6, node, struck)][lines].real - coherence[i, lines])) for i, node in enumerate(nodes))
    print(f"hammer-hit, coherence against pyFRF: {off:.1e}")


def windowed(path):
    """An exponential window by hand: e^(−decay·t) from the first sample on over force and responses leaves ratios of spectra unchanged but for scale."""
    hits, decay = hits_of(path), 3.0
    found, _ = estimated(path, "--response-window", str(decay), "--weights", "plain")
    worst = 0.0
    for (kind, response, struck), values in found.items():
        if kind != 4:
            continue
        cross, power = 0, 0
        for hit in (h for h in hits if h["struck"] == struck):
            f, y = hit["force"].copy(), hit["responses"][response].copy()
            peak = np.argmax(np.abs(f))
            begin = peak - np.argmin((np.sign(f[peak]) * f > 0.05 * abs(f[peak]))[: peak + 1][::-1]) + 1 - 16
            window = np.exp(-decay * hit["interval"] * np.maximum(np.arange(len(f)) - begin, 0))
            quiet = begin + 16 - 16
            f, y = f - np.median(f), y - y[: max(quiet, 1)].mean()
            x, y = np.fft.rfft(f * window), np.fft.rfft(y * window)
            cross, power = cross + y * np.conj(x), power + np.abs(x) ** 2
        lines = slice(200, 1600)
        worst = max(worst, largest([values[lines]], [(cross / power)[lines]]))
    print(f"an exponential window of {decay} 1/s, against NumPy (offsets found differently): {worst:.1e}")


def speed():
    """20 hits of three channels and 16,384 samples, from file to FRFs."""
    random = np.random.default_rng(1)
    n, step = 16384, 1 / 12800
    t = np.arange(n) * step
    path = os.path.join(FOLDER, "many.uff")
    file = pyuff.UFF(path)
    for hit in range(1, 21):
        force = np.where((t > 0.02) & (t < 0.021), 100 * np.sin(np.pi * (t - 0.02) / 0.001), 0) + 1e-3 * random.standard_normal(n)
        for node, kind, label in ((1, 13, "N"), (3, 12, "m/s^2"), (4, 12, "m/s^2")):
            ring = np.where(t > 0.02, np.exp(-30 * (t - 0.02)) * np.sin(2000 * node * (t - 0.02)), 0) + 1e-3 * random.standard_normal(n)
            file.write_sets([dict(
                type=58, binary=1, func_type=1, ver_num=hit, rsp_node=node, rsp_dir=2, ref_node=1, ref_dir=2, id1="speed",
                abscissa_inc=step, abscissa_min=0.0, abscissa_spacing=1, num_pts=n, ord_data_type=4, ordinate_spec_data_type=kind,
                ordinate_axis_units_lab=label, orddenom_spec_data_type=0, z_axis_spec_data_type=0, abscissa_spec_data_type=17, abscissa_axis_units_lab="s", x=t,
                data=force if node == 1 else ring)], mode="add")
    times = [estimated(path)[1] for _ in range(7)]
    print(f"20 hits × 3 channels × 16,384 samples: {sorted(times)[3]:.3f} s from file to file (median of 7)")


real = os.path.join(RECORDINGS, "hammer-hit", "hits.uff")
compare("hammer-hit", real, slice(8, 3600))
against_pyfrf(real, slice(8, 3600))
windowed(real)
if CASES:
    for case in ("013", "014", "024"):
        path = os.path.join(CASES, f"case-{case}", "hits.uff")
        compare(f"case {case} (--weights plain)", path, slice(8, 2400), ("--weights", "plain"))
speed()
