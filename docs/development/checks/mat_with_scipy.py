"""MATLAB files of FRFs, written by scipy (v5, v7) and h5py (v7.3, in MATLAB's layout), read by us.

    python docs/development/checks/mat_with_scipy.py FOLDER PROGRAM

Needs numpy, scipy and h5py. Writes the files to FOLDER (those that the tests of crates/import read are named so), then has the program make modes of a larger one
and compares what it reads with what was written.
"""
import json
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
from scipy.io import savemat

PROGRAM = Path(sys.argv[2]).resolve()
G = 9.80665


def testlab(lines, step, values, names, label="g/N", factor=1 / G):
    """The structure of a Testlab export: values in SI, shown in the label's unit."""
    return {
        "x_values": {"start_value": lines, "increment": step, "number_of_values": float(values.shape[0]), "quantity": {"label": "Hz"}},
        "y_values": {"values": values, "quantity": {"label": label, "unit_transformation": {"log_reference": 1.0, "factor": factor, "offset": 0.0}}},
        "function_record": {"name": names},
    }


def cells(names):
    """A cell row of texts, as savemat takes it."""
    out = np.empty(len(names), dtype=object)
    out[:] = names
    return out


def write73(path, variables):
    """HDF5 as `save -v7.3` lays it out: 512 bytes of user block, reversed dimensions, cells as references."""
    count = [0]

    def put(group, name, value):
        if isinstance(value, dict):
            inner = group.create_group(name)
            inner.attrs["MATLAB_class"] = np.bytes_("struct")
            for key, item in value.items():
                put(inner, key, item)
        elif isinstance(value, str):
            data = group.create_dataset(name, data=np.array([[ord(c)] for c in value], dtype=np.uint16))
            data.attrs["MATLAB_class"] = np.bytes_("char")
            data.attrs["MATLAB_int_decode"] = np.int32(2)
        elif isinstance(value, list):
            refs = group.file.require_group("#refs#")
            targets = []
            for item in value:
                put(refs, f"r{count[0]}", item)
                targets.append([refs[f"r{count[0]}"].ref])
                count[0] += 1
            data = group.create_dataset(name, data=np.array(targets, dtype=h5py.ref_dtype), dtype=h5py.ref_dtype)
            data.attrs["MATLAB_class"] = np.bytes_("cell")
        else:
            value = np.atleast_2d(np.asarray(value))
            if np.iscomplexobj(value):
                stored = np.empty(value.T.shape, dtype=[("real", "<f8"), ("imag", "<f8")])
                stored["real"], stored["imag"] = value.T.real, value.T.imag
            else:
                stored = value.T.astype(float)
            options = {"compression": "gzip", "chunks": True} if value.size > 10000 else {}
            data = group.create_dataset(name, data=stored, **options)
            data.attrs["MATLAB_class"] = np.bytes_("double")

    with h5py.File(path, "w", userblock_size=512, libver="earliest") as file:
        for name, value in variables.items():
            put(file, name, value)
    head = b"MATLAB 7.3 MAT-file, Platform: GLNXA64, Created on: Sun Nov 22 2026 HDF5 schema 1.00 .".ljust(116) + bytes(8) + b"\x00\x02IM"
    with open(path, "r+b") as file:
        file.write(head)


def small():
    """Two FRFs on five lines."""
    f = 10 + 2.5 * np.arange(5)
    return f, np.stack([f / 10 - 0.25j * f, 0.5 - 0.125j * f], axis=1)


def samples(folder):
    f, values = small()
    names = ["FRF 4:+Z/1:+Z", "FRF 3:+Z/1:+Z"]
    savemat(folder / "testlab-v5.mat", {"FRF": testlab(10.0, 2.5, values, cells(names))})
    savemat(folder / "testlab-v7.mat", {"FRF": testlab(10.0, 2.5, values, cells(names))}, do_compression=True)
    write73(folder / "testlab-v73.mat", {"FRF": testlab(10.0, 2.5, values, names)})
    savemat(folder / "plain-v5.mat", {"f": f[:, None], "H": values, "note": "two FRFs"})
    savemat(folder / "named-v7.mat", {"test": {"frequency": f, "H_4_1": values[:, 0], "H_3_1": values[:, 1]}}, do_compression=True)
    write73(folder / "named-v73.mat", {"test": {"frequency": f, "H_4_1": values[:, 0], "H_3_1": values[:, 1]}})


def large(folder):
    """A beam of three modes on 3,201 lines, in all versions; modes found of each must agree."""
    f = 0.5 * np.arange(3201)
    w = 2 * np.pi * f
    shapes = np.array([[1.0, -0.6, 0.4], [0.7, 0.5, -0.9]])
    values = np.zeros((f.size, 2), complex)
    for fr, zeta, phi in zip((180.0, 470.0, 910.0), (0.004, 0.006, 0.008), shapes.T):
        wr = 2 * np.pi * fr
        h = -(w**2) / (wr**2 - w**2 + 2j * zeta * wr * w)
        values += h[:, None] * (phi * phi[0])[None, :]
    rng = np.random.default_rng(1)
    values += 1e-3 * np.abs(values).max() * (rng.standard_normal(values.shape) + 1j * rng.standard_normal(values.shape))
    names = ["FRF 1:+Y/1:+Y", "FRF 2:+Y/1:+Y"]
    savemat(folder / "large-v5.mat", {"FRF": testlab(0.0, 0.5, values, cells(names))})
    savemat(folder / "large-v7.mat", {"FRF": testlab(0.0, 0.5, values, cells(names))}, do_compression=True)
    write73(folder / "large-v73.mat", {"FRF": testlab(0.0, 0.5, values, names)})
    table = np.column_stack([f, values[:, 0].real, values[:, 0].imag, np.abs(values[:, 1]), np.degrees(np.angle(values[:, 1]))])
    header = "frequency [Hz];1/1 real [m/s^2/N];1/1 imag [m/s^2/N];2/1 magnitude [m/s^2/N];2/1 phase [deg]"
    rows = "\n".join(";".join(f"{v:.15g}".replace(".", ",") for v in row) for row in table)
    (folder / "large.csv").write_text(header + "\n" + rows + "\n")
    found = {}
    for name in ("large-v5.mat", "large-v7.mat", "large-v73.mat", "large.csv"):
        run = subprocess.run([PROGRAM, "modes", folder / name, "--band", "50:1200", "--json"], capture_output=True, text=True)
        if run.returncode:
            print(f"{name}: {run.stderr.strip()}")
            continue
        found[name] = [(m["frequency"], m["damping_ratio"]) for m in json.loads(run.stdout)["modes"]]
        print(f"{name}: " + ", ".join(f"{fr:.3f} Hz {100 * z:.3f} %" for fr, z in found[name]))
    first = np.array(found["large-v5.mat"])
    for name, modes in found.items():
        print(f"{name}: largest relative difference from v5 {np.max(np.abs(np.array(modes) / first - 1)):.1e}")


if __name__ == "__main__":
    target = Path(sys.argv[1])
    target.mkdir(parents=True, exist_ok=True)
    samples(target)
    large(target)
