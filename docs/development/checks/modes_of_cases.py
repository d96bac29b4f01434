#!/usr/bin/env python3
"""Runs `jointscope modes` over a folder of simulated cases and sets the damping ratios against their true ones.

    python3 docs/development/checks/modes_of_cases.py PROGRAM CASES

PROGRAM is the built binary. CASES holds one folder a case with fixture.json, frf.uff and truth.json. Prints a table in Markdown: for every elastic mode in the band the
true ratio, the one that `--update` wrote, its standard deviation, and the error in standard deviations. The truth is that of the assembly without hidden effects:
where a case hides some (interfaces, loss factors, resonators …) the ratio of the whole is meant to be another one.
"""
import json
import pathlib
import subprocess
import sys
import tempfile


def main(program, cases):
    print("| case | hidden effects | mode | frequency, Hz | true ratio, % | found, % | error/std | chi2/dof |")
    print("|---|---|---|---|---|---|---|---|")
    pulls = []
    for case in sorted(pathlib.Path(cases).glob("case-*")):
        if not (case / "frf.uff").exists():
            continue
        truth = json.loads((case / "truth.json").read_text())
        effects = ", ".join(sorted({effect["kind"] for effect in truth["effects"]})) or "none"
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            run = subprocess.run(
                [program, "modes", case / "frf.uff", "--fixture", case / "fixture.json", "--update", folder / "f.json", "-o", folder],
                capture_output=True, text=True)
            if run.returncode:
                print(f"| {case.name} | {effects} | {run.stderr.strip().replace('|', '/')} | | | | | |")
                continue
            found = json.loads((folder / "modes.json").read_text())
            ratios = json.loads((folder / "f.json").read_text())["damping"]["modal_ratios"]
        for match in sorted(found["fixture"]["matches"], key=lambda m: m["elastic_mode"]):
            index = match["elastic_mode"] - 1
            quantity = truth["true_quantities"].get(f"damping/modal_ratios/{index}")
            mode, ratio = found["modes"][match["mode"] - 1], ratios[index]
            assert ratio == {"value": mode["damping_ratio"], "std": mode["std"]["damping_ratio"]}
            known = quantity["true"] if quantity else None
            pull = (ratio["value"] - known) / ratio["std"] if known else None
            if effects == "none" and pull is not None:
                pulls.append(pull)
            print(f"| {case.name} | {effects} | {index + 1} | {mode['frequency']:.3f} | {'–' if known is None else f'{100 * known:.5f}'} "
                  f"| {100 * ratio['value']:.5f} ± {100 * ratio['std']:.5f} | {'–' if pull is None else f'{pull:+.1f}'} | {found['chi2_per_dof']:.3f} |")
    if pulls:
        rms = (sum(pull * pull for pull in pulls) / len(pulls)) ** 0.5
        print(f"\nwithout hidden effects: {len(pulls)} ratios, rms error/std {rms:.2f}, largest {max(map(abs, pulls)):.1f}")


if __name__ == "__main__":
    main(*sys.argv[1:3])
