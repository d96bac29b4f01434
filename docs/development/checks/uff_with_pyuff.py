#!/usr/bin/env python3
"""Checks crates/uff against pyuff, an independent reader and writer of universal files.

    python3 docs/development/checks/uff_with_pyuff.py [--speed] [FOLDER ...]

1. Files written by pyuff, read here; 2. files written here, read by pyuff: every ordinate type, even and uneven, ASCII,
little and big endian, and units; 3. every .uff file below the folders, read by both; 4. with --speed, the time both take for 50 MB.
Prints a table of the largest deviations and ends with status 1 if one is too large. Needs numpy, pyuff and cargo.
"""
import argparse
import itertools
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import warnings

import numpy as np
import pyuff

ROOT = pathlib.Path(__file__).resolve().parents[3]
POINTS = 101
# The same data as an ordinate type of the format; single precision is half the type of double.
TYPES = {("real", "single"): 2, ("real", "double"): 4, ("complex", "single"): 5, ("complex", "double"): 6}
failures = []


def build_examples():
    """Builds the two example programs and returns the folder that holds them."""
    subprocess.run(["cargo", "build", "-q", "--release", "-p", "jointscope-uff", "--examples"], cwd=ROOT, check=True)
    metadata = subprocess.run(["cargo", "metadata", "--no-deps", "--format-version", "1"], cwd=ROOT, check=True,
                              capture_output=True, text=True).stdout
    return pathlib.Path(json.loads(metadata)["target_directory"]) / "release" / "examples"


def read_here(examples, path):
    """Header fields, abscissa and ordinates of every function, as this crate reads them."""
    with tempfile.NamedTemporaryFile() as values_file:
        run = subprocess.run([examples / "dump", path, "--values", values_file.name], capture_output=True, text=True)
        if run.returncode:
            raise RuntimeError(run.stderr.strip())
        values = np.fromfile(values_file.name, "<f8")
    functions = []
    # The last line end only: ID lines may hold what Python takes for line ends.
    for line in run.stdout.split("\n")[:-1]:
        fields = line.split("\t")
        points, is_complex = int(fields[-2]), fields[-1] == "1"
        x, values = values[:points], values[points:]
        count = points * (2 if is_complex else 1)
        data, values = values[:count], values[count:]
        functions.append((fields[:-2], x, data.view(complex) if is_complex else data))
    assert len(values) == 0
    return functions


def read_pyuff(path):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        file = pyuff.UFF(str(path))
        return [file.read_sets(index) for index, kind in enumerate(file.get_set_types()) if kind == 58]


def header_of(s):
    """The fields that `dump` prints, from pyuff."""
    keys = ["func_type", "ver_num", "rsp_node", "rsp_dir", "ref_node", "ref_dir", "abscissa_spec_data_type",
            "ordinate_spec_data_type", "orddenom_spec_data_type", "ordinate_axis_units_lab", "id1", "id4", "id5"]
    return [str(s[key]) for key in keys]


def plain(fields):
    """With one mark for every character beyond ASCII, which pyuff reads as UTF-8 only."""
    return ["".join(c if c.isascii() else "\ufffd" for c in field) for field in fields]


def deviation(got, expected):
    """Largest relative deviation, value by value (0/0 is none)."""
    got, expected = np.asarray(got), np.asarray(expected)
    if got.shape != expected.shape:
        return np.inf
    parts = [(got.real, expected.real), (got.imag, expected.imag)] if np.iscomplexobj(expected) else [(got, expected)]
    worst = 0.0
    for a, b in parts:
        scale = np.where(b == 0, 1, np.abs(b))
        worst = max(worst, float(np.max(np.abs(a - b) / scale, initial=0.0)))
    return worst


def report(what, x, y, allowed_x, allowed_y, note=""):
    ok = x <= allowed_x and y <= allowed_y
    if not ok:
        failures.append(what)
    print(f"  {what:58} {x:9.1e} {y:9.1e}   {'ok' if ok else 'TOO LARGE'} {note}")


def example_function(kind, spacing):
    random = np.random.default_rng(58)
    magnitude = 10.0 ** random.integers(-6, 7, POINTS)
    data = random.standard_normal(POINTS) * magnitude
    if kind == "complex":
        data = data + 1j * random.standard_normal(POINTS) * magnitude
    steps = np.full(POINTS, 2.5) if spacing == "even" else random.uniform(0.5, 4.0, POINTS)
    x = 10.0 + np.concatenate(([0.0], np.cumsum(steps[:-1])))
    return x, data


def tolerance(precision, encoding, part):
    """What the form in the file can hold: printed digits or the width of a float."""
    if encoding == "ascii":
        return 5.1e-6 if precision == "single" or part == "abscissa" else 5.1e-12
    return 6.0e-8 if precision == "single" else 0.0


def write_pyuff(path, dataset, force_double):
    """Always by adding to no file: when pyuff overwrites with binary data, only the closing delimiter is left."""
    path.unlink(missing_ok=True)
    pyuff.UFF(str(path)).write_sets(dataset, "add", force_double=force_double)


def pyuff_dataset(kind, precision, spacing, encoding, x, data):
    return {"type": 58, "func_type": 4 if kind == "complex" else 1, "ver_num": 3, "rsp_node": 4, "rsp_dir": 2, "ref_node": 1,
            "ref_dir": -2, "data": data, "x": x, "binary": int(encoding != "ascii"), "id1": "beam", "id4": "force 1 N",
            "id5": "averages 8", "abscissa_spacing": int(spacing == "even"), "ord_data_type": TYPES[kind, precision],
            "abscissa_spec_data_type": 18, "ordinate_spec_data_type": 12, "orddenom_spec_data_type": 13,
            "ordinate_axis_units_lab": "m/s^2", "n_bytes": 0}


def check_reading(examples, folder):
    print("\nwritten by pyuff, read here: largest relative deviation of\n  "
          f"{'':58} {'abscissa':>9} {'ordinate':>9}")
    for kind, precision, spacing, encoding in itertools.product(
            ["real", "complex"], ["single", "double"], ["even", "uneven"], ["ascii", "binary"]):
        x, data = example_function(kind, spacing)
        path = folder / "from_pyuff.uff"
        dataset = pyuff_dataset(kind, precision, spacing, encoding, x, data)
        write_pyuff(path, dataset, force_double=False)
        [(fields, got_x, got)] = read_here(examples, path)
        assert fields == ["4" if kind == "complex" else "1", "3", "4", "2", "1", "-2", "18", "12", "13", "m/s^2", "beam",
                          "force 1 N", "averages 8"], fields
        note = ""
        if encoding == "binary":
            stated = int(path.read_bytes().split(b"\n")[1].split()[4])
            # What lies between record 11 and the closing delimiter.
            stored = len(path.read_bytes().split(b"\n", 13)[13]) - len(b"    -1\n")
            if stated != stored:
                note = f"(pyuff states {stated} bytes, stores {stored})"
        report(f"{kind} {precision} {spacing} {encoding}", deviation(got_x, x), deviation(got, data),
               tolerance(precision, encoding, "abscissa"), tolerance(precision, encoding, "ordinate"), note)


def check_writing(examples, folder):
    print("\nwritten here, read by pyuff: largest relative deviation of\n  "
          f"{'':58} {'abscissa':>9} {'ordinate':>9}")
    for kind, precision, spacing, encoding in itertools.product(
            ["real", "complex"], ["single", "double"], ["even", "uneven"], ["ascii", "little", "big"]):
        x, data = example_function(kind, spacing)
        source, path = folder / "source.uff", folder / "from_here.uff"
        write_pyuff(source, pyuff_dataset(kind, "double", spacing, "binary", x, data), force_double=True)
        subprocess.run([examples / "rewrite", source, path, encoding, precision], check=True)
        [got] = read_pyuff(path)
        assert header_of(got)[1:] == ["3", "4", "2", "1", "-2", "18", "12", "13", "m/s^2", "beam", "force 1 N", "averages 8"]
        assert got["ord_data_type"] == TYPES[kind, precision] and got["num_pts"] == POINTS
        if encoding != "ascii":
            numbers = POINTS * ((2 if kind == "complex" else 1) + (spacing == "uneven"))
            assert got["n_bytes"] == numbers * (4 if precision == "single" else 8), "byte count"
        report(f"{kind} {precision} {spacing} {encoding}", deviation(got["x"], x), deviation(got["data"], data),
               tolerance(precision, encoding, "abscissa"), tolerance(precision, encoding, "ordinate"))


def check_units(examples, folder):
    """Units (dataset 164) written by pyuff, read and written here, read by pyuff."""
    source, path = folder / "units.uff", folder / "units_from_here.uff"
    units = {"type": 164, "units_code": 2, "units_description": "Foot (pound f)", "temp_mode": 2, "length": 3.28083989501312334,
             "force": 2.24808943099710480e-01, "temp": 1.8, "temp_offset": 459.67}
    x, data = example_function("real", "even")
    write_pyuff(source, dict(units), force_double=True)
    pyuff.UFF(str(source)).write_sets(pyuff_dataset("real", "double", "even", "binary", x, data), "add")
    subprocess.run([examples / "rewrite", source, path, "same", "same"], check=True)
    got = pyuff.UFF(str(path)).read_sets(0)
    same = all(got[key] == value for key, value in units.items())
    print("\nunits through both")
    report("foot and pound force", 0.0, 0.0 if same else np.inf, 0.0, 0.0)


def check_folder(examples, folder):
    print(f"\n{folder}, read by both: functions, values, largest relative deviation of\n  "
          f"{'':58} {'abscissa':>9} {'ordinate':>9}")
    for path in sorted(folder.rglob("*.uff")):
        here, there = read_here(examples, path), read_pyuff(path)
        if len(here) != len(there):
            report(str(path.relative_to(folder)), np.inf, np.inf, 0, 0, f"({len(here)} functions here, {len(there)} there)")
            continue
        worst_x = worst_y = 0.0
        for (fields, x, data), s in zip(here, there):
            if plain(fields) != plain(header_of(s)):
                report(f"{path.relative_to(folder)}: header {fields} / {header_of(s)}", np.inf, np.inf, 0, 0)
            worst_x, worst_y = max(worst_x, deviation(x, s["x"])), max(worst_y, deviation(data, s["data"]))
        values = sum(len(data) for _, _, data in here)
        report(f"{path.relative_to(folder)} ({len(here)} x, {values} values)", worst_x, worst_y, 0.0, 0.0)


def best_of(repeats, act):
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        act()
        times.append(time.perf_counter() - start)
    return min(times)


def write_large(path, megabytes):
    """Eight double-precision FRFs in 58b; pyuff takes minutes to write them."""
    points = megabytes * 1_000_000 // (8 * 16)
    random = np.random.default_rng(58)
    with open(path, "wb") as out:
        for node in range(1, 9):
            header = (f"    -1\n    58b{1:6}{2:6}{11:12}{points * 16:12}{0:6}{0:6}{0:12}{0:12}\n" + "NONE\n" * 5
                      + f"{4:5}{0:10}{1:5}{0:10} {'NONE':10}{node:10}{2:4} {'NONE':10}{1:10}{2:4}\n"
                      + f"{6:10}{points:10}{1:10}{0:13.5e}{0.5:13.5e}{0:13.5e}\n"
                      + "".join(f"{code:10}{0:5}{0:5}{0:5} {'NONE':20} {'NONE':20}\n" for code in (18, 12, 13, 0)))
            out.write(header.encode() + random.standard_normal(2 * points).astype("<f8").tobytes() + b"    -1\n")


def check_speed(examples, folder):
    """Reading is `read` on bytes in memory here and `read_sets` of a cached file there; the whole process starts at the shell."""
    print("\nseconds to read, best of five")
    binary, ascii_file = folder / "large.uff", folder / "large_ascii.uff"
    write_large(binary, 50)
    subprocess.run([examples / "rewrite", binary, ascii_file, "ascii", "same"], check=True)
    for name, path in [("58b double", binary), ("58 ASCII double", ascii_file)]:
        function_here = float(subprocess.run([examples / "dump", path, "--time", "5"], check=True, capture_output=True,
                                             text=True).stdout)
        function_there = best_of(5, lambda: read_pyuff(path))
        process_here = best_of(5, lambda: subprocess.run([examples / "dump", path], check=True, capture_output=True))
        program = f"import pyuff; pyuff.UFF({str(path)!r}).read_sets()"
        process_there = best_of(5, lambda: subprocess.run([sys.executable, "-c", program], check=True))
        size = os.path.getsize(path) / 1e6
        for what, here, there in [("reading", function_here, function_there),
                                  ("whole process", process_here, process_there)]:
            print(f"  {name:16} {size:6.1f} MB  {what}: here {here:8.4f}  pyuff {there:8.4f}  ratio {there / here:6.1f}")
            if name == "58b double" and what == "reading" and there < 20 * here:
                failures.append(f"{name}, {what}: less than 20 times as fast")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", nargs="*", type=pathlib.Path, metavar="FOLDER")
    parser.add_argument("--speed", action="store_true", help="time both on 50 MB")
    arguments = parser.parse_args()
    examples = build_examples()
    print(f"pyuff {pyuff.__version__}, numpy {np.__version__}")
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        check_reading(examples, folder)
        check_writing(examples, folder)
        check_units(examples, folder)
        for recordings in arguments.folders:
            check_folder(examples, recordings)
        if arguments.speed:
            check_speed(examples, folder)
    print(f"\n{len(failures)} failures" + "".join(f"\n  {failure}" for failure in failures))
    sys.exit(bool(failures))


if __name__ == "__main__":
    main()
