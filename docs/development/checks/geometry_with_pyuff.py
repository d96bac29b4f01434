"""Geometry and shapes of universal files as pyuff reads them, beside ours, number by number.

    cargo build --release -p jointscope-uff --example dump
    python docs/development/checks/geometry_with_pyuff.py FOLDER [--sample OUT.uff]

Needs pyuff and numpy. FOLDER holds .uff files, such as the `data` folder of ladisk/pyuff. `--sample` writes the file that the tests of crates/uff read.
"""
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pyuff

ROOT = Path(__file__).resolve().parents[3]
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
DUMP = TARGET / "release/examples/dump"


def theirs(path):
    """Nodes, elements, traces, and data at nodes, in file order."""
    nodes, elements, traces, data = [], [], [], []
    uff = pyuff.UFF(str(path))
    for index, kind in enumerate(uff.get_set_types()):
        if kind not in (15, 82, 55, 2411, 2412, 2414):
            continue
        try:
            s = uff.read_sets(index)
        except Exception as error:
            print(f"  pyuff cannot read dataset {kind} ({index}): {error}")
            continue
        if kind in (15, 2411):
            for row in zip(s["node_nums"], s["disp_cs"], s["x"], s["y"], s["z"]):
                nodes.append([float(v) for v in row])
        elif kind == 2412:
            for kind_of_element, group in s.items():
                if isinstance(kind_of_element, int):
                    elements += [[int(e["element_nums"]), *[int(n) for n in np.ravel(e["nodes_nums"])]] for e in group]
        elif kind == 82:
            # pyuff keeps the zeros that fill the last line.
            traces.append([int(s["trace_num"]), *[int(n) for n in s["nodes"]][: int(s["n_nodes"])]])
        elif kind == 55:
            columns = [s[f"r{i}"] for i in range(1, int(s["n_data_per_node"]) + 1)]
            data.append([[int(n), *values] for n, *values in zip(s["node_nums"], *columns)])
        elif s.get("dataset_location") == 1:
            values = [list(np.ravel(v)) for v in s["data_at_node"]]
            if s["data_type"] == 5:
                values = [v if np.iscomplexobj(v) else [complex(a, b) for a, b in zip(v[::2], v[1::2])] for v in values]
            data.append([[int(n), *v] for n, v in zip(s["node_nums"], values)])
    return nodes, elements, traces, data


def ours(path):
    """The same of the dump."""
    nodes, elements, traces, data = [], [], [], []
    text = subprocess.run([DUMP, path, "--beside"], capture_output=True, text=True, check=True).stdout
    for line in text.splitlines():
        kind, *words = line.split()
        if kind == "node":
            nodes.append([float(w) for w in words])
        elif kind == "element":
            elements.append([int(words[0]), *map(int, words[2:])])
        elif kind == "trace":
            traces.append([int(w) for w in words])
        elif kind == "data":
            data.append([])
        elif kind == "values":
            numbers = [float(w) for w in words[1:]]
            data[-1].append([int(words[0]), *[complex(a, b) for a, b in zip(numbers[::2], numbers[1::2])]])
    return nodes, elements, traces, data


def differences(a, b):
    """Largest relative difference of two nested lists, or what does not fit."""
    if len(a) != len(b):
        return f"{len(a)} against {len(b)}"
    worst = 0.0
    for x, y in zip(a, b):
        if isinstance(x, list):
            inner = differences(x, y)
            if isinstance(inner, str):
                return inner
            worst = max(worst, inner)
        elif x != y:
            worst = max(worst, abs(x - y) / max(abs(x), abs(y)))
    return worst


def sample(path):
    """The file of the tests: geometry, header, a real and a complex mode."""
    Path(path).unlink(missing_ok=True)
    p = pyuff
    sets = [
        p.prepare_151(model_name="bench", description="two nodes off the line", db_app="bench", date_db_created="22-Nov-26",
                      time_db_created="10:00:00", version_db1=1, version_db2=0, file_type=0, date_db_saved="22-Nov-26",
                      time_db_saved="10:00:00", program="pyuff 2.5", date_db_written="22-Nov-26", time_db_written="10:00:00"),
        p.prepare_164(units_code=5, units_description="mm (milli-newton)", temp_mode=2, length=1000.0, force=1000.0, temp=1.0, temp_offset=273.15),
        p.prepare_18(cs_num=[7], cs_type=[0], ref_cs_num=[0], color=[8], method=[1], cs_name=["SIDE"], ref_o=np.array([[100.0, 0, 0]]),
                     x_point=np.array([[100.0, 1, 0]]), xz_point=np.array([[100.0, 0, 1]])),
        p.prepare_15(node_nums=[1, 2, 3], def_cs=[0, 7, 0], disp_cs=[0, 7, 0], color=[8, 8, 8], x=[0.0, 20, 150], y=[0.0, 5, -2.5], z=[0.0, -1, 0]),
        p.prepare_2420(Part_UID=1, Part_Name="part", CS_sys_labels=[3], CS_types=[0], CS_colors=[2], CS_names=["TURNED"],
                       CS_matrices=[np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0], [10, 0, 0]])]),
        p.prepare_2411(node_nums=[11, 12], def_cs=[3, 3], disp_cs=[3, 0], color=[11, 11], x=[1.5, -2.25], y=[0.0, 1e-3], z=[1e5, 3.0]),
        p.prepare_82(trace_num=2, n_nodes=5, color=30, id="outline", nodes=np.array([1, 2, 0, 2, 3])),
        p.prepare_55(id1="first bending", id2="NONE", id3="NONE", id4="NONE", id5="NONE", model_type=1, analysis_type=2, data_ch=2,
                     spec_data_type=8, data_type=2, n_data_per_node=3, r1=[0.0] * 3, r2=[1.0, -0.5, 1.0], r3=[0.0] * 3, load_case=1, mode_n=1,
                     freq=312.5, modal_m=1.25, modal_damp_vis=0.003, modal_damp_his=0.0, node_nums=[1, 2, 3]),
        p.prepare_55(id1="complex", id2="NONE", id3="NONE", id4="NONE", id5="NONE", model_type=1, analysis_type=3, data_ch=2, spec_data_type=8,
                     data_type=5, n_data_per_node=3, r1=np.zeros(2, complex), r2=np.array([1 + 0.5j, -2 - 0.25j]), r3=np.zeros(2, complex),
                     load_case=1, mode_n=2, eig=-30 + 4000j, modal_a=1 + 2j, modal_b=3 + 4j, node_nums=[1, 3]),
    ]
    pyuff.UFF(str(path)).write_sets(sets, "add")


if __name__ == "__main__":
    if "--sample" in sys.argv:
        sample(sys.argv[sys.argv.index("--sample") + 1])
    for path in sorted(Path(sys.argv[1]).glob("*.uff")):
        got, expected = ours(path), theirs(path)
        if not any(got) and not any(expected):
            continue
        print(path.name)
        for name, a, b in zip(("nodes", "elements", "traces", "data at nodes"), got, expected):
            if name == "elements":
                a, b = sorted(a), sorted(b)
            if a or b:
                print(f"  {name}: {len(a)}, largest relative difference {differences(a, b)}")
