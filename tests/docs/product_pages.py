#!/usr/bin/env python3
"""The pages that the programs make, in Chromium, at the size of a desk, of a phone and on paper: the shipped ones, and the
report of a run, whose tables are held against its log.

    product_pages.py REPOSITORY ROPEWALK"""
import csv
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import pages
from browser import Browser

shipped = ["data/chart/chart.html", "data/validation/report.html", "data/validation/stability/report.html",
           "data/reproduction/fig5.html", "data/campaigns/helix-threshold/thresholds.html"]

scene = """format = "ropewalk-scene-1"
name = "looked-at"
parameters = "cnt-10-10-tersoff"

[rope]
tubes = 19
length_nm = 20

[twist]
moment_nN_nm = 6
rate_nN_nm_per_ps = 2
hold_ps = 2

[run]
log_every_ps = 0.1
frames_every_ps = 1
"""

# Columns of the report's tables and of the log.
columns = {"stretch (eV)": "stretch_eV", "bend (eV)": "bend_eV", "twist (eV)": "twist_eV", "van der Waals (eV)": "vdw_eV",
           "kinetic (eV)": "kinetic_eV", "work (eV)": "work_eV", "β (°)": "beta_deg", "amplitude (nm)": "amplitude_nm"}


def number(text):
    return float(text.replace("−", "-").replace("\u2009", ""))


def report_of_a_run(browser, program, folder):
    (folder / "scene.toml").write_text(scene)
    subprocess.run([program, "run", "scene.toml", "--out", "run", "--quiet"], cwd=folder, check=True)
    pages.look(browser, folder, "run/report.html")
    with open(folder / "run/log.csv") as file:
        last = list(csv.DictReader(file))[-1]
    tables = browser.value("""[...document.querySelectorAll('table.numbers')].map(t => [
      [...t.querySelectorAll('th')].map(c => c.textContent), [...t.rows[t.rows.length - 1].cells].map(c => c.textContent)])""")
    compared = set()
    for names, row in tables:
        if names[0] != "time (ps)":
            continue
        for name, text in zip(names, row):
            if name in columns:
                logged = float(last[columns[name]])
                pages.expect(abs(number(text) - logged) <= 1e-3 * abs(logged) + 1e-12,
                             f"run/report.html: {name} is {text}, and {logged} in the log")
                compared.add(name)
    pages.expect(compared == set(columns), f"run/report.html: tables without {set(columns) - compared}")


def chart_points(browser, repository):
    """Every model of the chart has its points and its row."""
    browser.size(*pages.desk)
    browser.call("Emulation.setEmulatedMedia", media="")
    browser.open((repository / "data/chart/chart.html").as_uri())
    with open(repository / "data/chart/points.csv") as file:
        scenes = {row["scene"] for row in csv.DictReader(file)}
    found = browser.value("""(marks => ({headings: document.querySelectorAll('h2').length, marks: marks.length,
      named: marks.filter(m => m.querySelector('title')).length}))([...document.querySelectorAll('figure .mark')])""")
    pages.expect(found["headings"] >= len(scenes), f"chart.html: {len(scenes)} scenes, {found['headings']} headings")
    pages.expect(found["marks"] > 500 and found["named"] == found["marks"], f"chart.html: points without a name: {found}")


# A value for every mark of every template: marks of the page in space, ends and begins of scripts and comments, an image.
hostile = "{{facts}}{{scripts}}{{nonce}}{{name}}<!--<script></script><script>window.ran=1</script><img src=x onerror=window.ran=1>\\u003c&amp;"


def hostile_pages(browser, program, folder):
    """Names of scenes and sets are texts in every page that shows them."""
    shipped_set = Path(__file__).resolve().parents[2] / "data/parameters/cnt-10-10-tersoff.toml"
    quoted = "'" + hostile + "'"
    lines = [f"name = {quoted}" if line.startswith("name = ") else line for line in shipped_set.read_text().splitlines()]
    (folder / "set.toml").write_text("\n".join(lines) + "\n")
    (folder / "scene.toml").write_text(scene.replace('"looked-at"', quoted).replace('"cnt-10-10-tersoff"', '"set.toml"')
                                       .replace("hold_ps = 2", "hold_ps = 0.1").replace("tubes = 19", "tubes = 1"))
    for words in (["run", "scene.toml", "--out", "hostile", "--quiet"], ["view", "hostile"],
                  ["compare", "hostile", "hostile", "--page", "compared.html"],
                  ["compare", "set.toml", "set.toml", "--page", "sets.html"]):
        subprocess.run([program, *words], cwd=folder, check=True, stdout=subprocess.DEVNULL)
    for page in ("hostile/report.html", "hostile/view.html", "compared.html", "sets.html"):
        browser.size(*pages.desk)
        browser.open((folder / page).as_uri())
        pages.expect(browser.value("typeof window.ran") == "undefined", f"{page}: a name of a scene has run a script")
        if page != "compared.html":  # which has the names of directories
            pages.expect(hostile in browser.value("document.documentElement.textContent"), f"{page}: does not show the name")
        pages.expect(browser.value("document.images.length") == 0, f"{page}: a name has become an image")
        browser.said(), browser.asked()
        if page.endswith("view.html"):
            facts = browser.value("JSON.parse(document.getElementById('facts').textContent).name")
            pages.expect(facts == hostile, f"{page}: its facts have the name {facts}")
            pages.expect(browser.value("typeof THREE") == "object", f"{page}: its own scripts do not run")
            browser.value("""(() => { const s = document.createElement('script'); s.textContent = 'window.ran = 1';
              document.body.append(s); })()""")
            pages.expect(browser.value("typeof window.ran") == "undefined", f"{page}: a script without the nonce runs")
            browser.said()


def main():
    if not shutil.which("chromium"):
        print("Chromium is not installed")
        return 77
    repository = Path(sys.argv[1]).resolve()
    with Browser() as browser, tempfile.TemporaryDirectory() as folder:
        for page in shipped:
            pages.look(browser, repository, page)
        chart_points(browser, repository)
        report_of_a_run(browser, Path(sys.argv[2]).resolve(), Path(folder).resolve())
        hostile_pages(browser, Path(sys.argv[2]).resolve(), Path(folder).resolve())
    print(f"{len(shipped) + 1} pages at three sizes")
    for error in pages.errors:
        print(error, file=sys.stderr)
    return 1 if pages.errors else 0


if __name__ == "__main__":
    sys.exit(main())
