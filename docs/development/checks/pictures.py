"""Makes the pictures of the guide that the program itself draws: pictures.py PROGRAM [--browser chromium]

docs/images/guide-checked.svg, guide-found.svg and guide-frf-4-1.svg come from the commands of docs/guide/own-structure.md, probability.svg from the shipped
look-alikes; with a browser also diagnosis.png and decomposition.png, the first screens of pages of shipped fixtures. measure.svg, where.svg and axes.svg are drawn by hand.
"""
import json
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
IMAGES = ROOT / "docs" / "images"


def blocks(page):
    """Code blocks of a page: what stands behind the fence, and the text."""
    return re.findall(r"^```([^\n]+)\n(.*?)^```$", page.read_text(), re.M | re.S)


def guide(program, folder):
    """Types the guide along, with figures as files."""
    for kind, text in blocks(ROOT / "docs/guide/own-structure.md"):
        if kind.startswith("json excerpt "):
            file = folder / kind.removeprefix("json excerpt ")
            base = file if file.exists() else folder / "fixture.json"
            fixture = json.loads(base.read_text())
            fixture.update(json.loads("{" + text + "}"))
            file.write_text(json.dumps(fixture))
        elif kind == "sh":
            for line in text.splitlines():
                words = line.split()[1:]
                if words[0] in ("check", "diagnose") and "-o" in words:
                    words += ["--also", "svg"]
                subprocess.run([program, *words], cwd=folder, check=True, capture_output=True)


def share(x, width, y, colour, words, percent):
    """A bar with its words beside it."""
    return (
        f'<text x="{x - 12}" y="{y + 17}" text-anchor="end" fill="#222">{words}</text>'
        f'<rect x="{x}" y="{y}" width="{max(width, 2):.0f}" height="24" fill="{colour}"/>'
        f'<text x="{x + max(width, 2) + 8:.0f}" y="{y + 17}" fill="#222">{percent:.0f} %</text>'
    )


def probability(diagnosis):
    """How a finding's probability, its look-alikes' and that of everything else make up 100 %."""
    finding = diagnosis["findings"][0]
    name = lambda effect: " ".join(filter(None, [effect["kind"].replace("_", " "), effect["place"], effect.get("dof")]))
    rows = [("finding: " + name(finding), finding["probability"], "#b0257e")]
    rows += [(name(other), other["probability"], "#0072b2") for other in finding["alternatives"] if other["probability"] >= 0.005]
    rows += [("physics that nobody listed, and the rest", 1 - sum(row[1] for row in rows), "#99a2ac")]
    said = "; ".join(f"{words} {100 * p:.0f} %" for words, p, _ in rows)
    bars = "".join(share(360, 420 * p, 14 + 34 * i, colour, words, 100 * p) for i, (words, p, colour) in enumerate(rows))
    height = 24 + 34 * len(rows)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 860 {height}" font-family="sans-serif" font-size="14" role="img" '
        f'aria-label="Probabilities of one finding: {said}"><rect width="860" height="{height}" fill="#fff"/>{bars}</svg>\n'
    )


def screen(browser, page, height, picture):
    """The first screen of a page."""
    with tempfile.TemporaryDirectory() as profile:
        subprocess.run(
            [browser, "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", f"--user-data-dir={profile}",
             "--virtual-time-budget=3000", f"--window-size=1100,{height}", f"--screenshot={picture}", f"file://{page}"],
            check=True, capture_output=True)


def main():
    program = str(Path(sys.argv[1]).resolve())
    browser = sys.argv[sys.argv.index("--browser") + 1] if "--browser" in sys.argv else None
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        guide(program, folder)
        shutil.copy(folder / "checked/figures/the-assembly.svg", IMAGES / "guide-checked.svg")
        shutil.copy(folder / "out/figures/at-a-glance.svg", IMAGES / "guide-found.svg")
        shutil.copy(folder / "out/figures/frfs-frf-4-1.svg", IMAGES / "guide-frf-4-1.svg")
        # From the project's root, so that the pages show short paths.
        run = lambda *words: subprocess.run([program, *words], cwd=ROOT, check=True, capture_output=True)
        look = ROOT / "fixtures/look-alikes"
        run("diagnose", str(look / "fixture.json"), str(look / "first-test.uff"), "-o", str(folder / "look"))
        (IMAGES / "probability.svg").write_text(probability(json.loads((folder / "look/diagnosis.json").read_text())))
        if browser:
            run("diagnose", "fixtures/two-blocks/fixture.json", "fixtures/two-blocks/hammer-test.uff", "-o", str(folder / "two"))
            screen(browser, folder / "two/report.html", 800, IMAGES / "diagnosis.png")
            run("decompose", "fixtures/glued-joint/fixture.json", "fixtures/glued-joint/hammer-test.uff", "-o", str(folder / "glued"))
            screen(browser, folder / "glued/report.html", 980, IMAGES / "decomposition.png")


main()
