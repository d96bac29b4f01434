"""What `jointscope check` says of the concealed cases that the project ships, beside their truths.

    python3 docs/development/checks/check.py PROGRAM [fixtures/concealed]

Prints for every case the mass by the mass line beside the true one, in its standard deviations, and the kinds of remarks; then the root mean square of the deviations.
"""
import json, subprocess, sys, pathlib

program = sys.argv[1]
cases = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else "fixtures/concealed")
truths = {truth["case"]: truth for truth in json.loads((cases / "truths.json").read_text())}


def value(quantity):
    return quantity["value"] if isinstance(quantity, dict) else quantity


def mass(fixture):
    total = sum(value(body["mass"]) for body in fixture["bodies"].values())
    for effect in fixture.get("physics", []):
        if effect["kind"] in ("added_mass", "joint_mass", "attached_resonator"):
            total += value(effect["mass"])
    return total


def kind(says):
    for part in ("opposite sign", "it reads", "its noise", "coherence", "mass line", "weighs", "reciprocity", "power", "rigid body"):
        if part in says:
            return part
    return says[:40]


deviations = []
for case in sorted(truths):
    folder = cases / f"{case:02}"
    files = sorted(str(path) for path in folder.glob("*.uff") if "baseline" not in path.name)
    answer = subprocess.run([program, "check", str(folder / "fixture.json"), *files, "--json"], capture_output=True, text=True)
    if answer.returncode:
        print(f"{case:02} refused: {answer.stderr.strip()}")
        continue
    found = json.loads(answer.stdout)
    line = (found["recording"] or {}).get("mass_line")
    told = ""
    if line and line["mass"] and "fixture" in truths[case]:
        true = mass(truths[case]["fixture"])
        off = (line["mass"]["value"] - true) / line["mass"]["std"]
        deviations.append(off)
        told = f"{line['mass']['value']:.3f} ± {line['mass']['std']:.3f} kg, true {true:.3f} ({off:+.1f} σ)"
    kinds = sorted({kind(remark["says"]) for remark in found["remarks"]})
    print(f"{case:02} {str(truths[case].get('hidden'))[:60]:60} {told:50} {', '.join(kinds)}")
print(f"{len(deviations)} masses, root mean square deviation {(sum(d * d for d in deviations) / max(1, len(deviations))) ** 0.5:.2f} σ")
