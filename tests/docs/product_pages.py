#!/usr/bin/env python3
"""The pages that the programs make, in Chromium, at the size of a desk, of a phone and on paper: the shipped ones, and the
report of a run, whose tables are held against its log.

    product_pages.py REPOSITORY ROPEWALK"""
import base64
import csv
import json
import os
import re
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
    return float(text.replace("−", "-").replace("\u202f", ""))


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


def demo_on_paper(browser, program, repository, folder):
    """The report of the demo's scene, with fewer tubes, has at most six pages of paper."""
    text = (repository / "data/scenes/rope-67nm.toml").read_text()
    pages.expect("\ntubes = 91 " in text, "rope-67nm.toml has other tubes")
    (folder / "demo.toml").write_text(text.replace("\ntubes = 91 ", "\ntubes = 19 "))
    subprocess.run([program, "run", "demo.toml", "--out", "demo", "--quiet"], cwd=folder, check=True)
    browser.size(*pages.desk)
    browser.call("Emulation.setEmulatedMedia", media="")
    browser.open((folder / "demo/report.html").as_uri())
    printed = browser.call("Page.printToPDF", paperWidth=8.27, paperHeight=11.69, preferCSSPageSize=True)["data"]
    sheets = len(re.findall(rb"/Type\s*/Page\b", base64.b64decode(printed)))
    pages.expect(1 < sheets <= 6, f"demo/report.html takes {sheets} pages of paper")


def chart_points(browser, repository):
    """Every model of the chart has its points and its row. The first figure has all scenes, in words."""
    browser.size(*pages.desk)
    browser.call("Emulation.setEmulatedMedia", media="")
    browser.open((repository / "data/chart/chart.html").as_uri())
    with open(repository / "data/chart/points.csv") as file:
        rows = list(csv.DictReader(file))
    scenes = {row["scene"] for row in rows}
    found = browser.value("""(marks => ({headings: document.querySelectorAll('h2').length, marks: marks.length,
      named: marks.filter(m => m.querySelector('title')).length}))([...document.querySelectorAll('figure .mark')])""")
    pages.expect(found["headings"] >= len(scenes), f"chart.html: {len(scenes)} scenes, {found['headings']} headings")
    pages.expect(found["marks"] > 500 and found["named"] == found["marks"], f"chart.html: points without a name: {found}")
    single = {(row["scene"], row["model"]) for row in rows if row["kind"] not in ("finest", "combination") and not row["failure"]}
    first = browser.value("[...document.querySelector('figure').querySelectorAll('.mark.faint title')].map(t => t.textContent)")
    pages.expect(len(first) >= len(single), f"chart.html: {len(single)} models in scenes, {len(first)} marks in the first figure")
    keys = [title for title in first if any(row["model"] + "," in title for row in rows if "-" in row["model"])]
    pages.expect(not keys, f"chart.html: names that are no words: {keys[:3]}")


# A value for every mark of every template: marks of the page in space, ends and begins of scripts and comments, an image.
hostile = "{{facts}}{{scripts}}{{nonce}}{{name}}<!--<script></script><script>window.ran=1</script><img src=x onerror=window.ran=1>\\u003c&amp;"


def hostile_texts(value, kept):
    """All texts of a JSON value but those of the keys `kept`."""
    if isinstance(value, dict):
        return {key: v if key in kept else hostile_texts(v, kept) for key, v in value.items()}
    if isinstance(value, list):
        return [hostile_texts(v, kept) for v in value]
    return hostile if isinstance(value, str) else value


def pages_of_thresholds(program, folder):
    """Names of points from the sweep, shapes from a table of trials that comes from somebody else."""
    (folder / "short.toml").write_text(scene.replace("hold_ps = 2", "hold_ps = 0.1").replace("tubes = 19", "tubes = 1"))
    other = hostile.replace("{{facts}}", "{{other}}")
    (folder / "sweep.toml").write_text(
        'format = "ropewalk-sweep-1"\nscene = "short.toml"\n[threshold]\nkey = "twist.moment_nN_nm"\nfrom = 1\nto = 2\n'
        f"column = \"rotation_deg\"\nabove = 1e-3\naccuracy = 0.5\n[vary]\nname = ['{hostile}', '{other}']\n")
    threshold = [program, "threshold", "sweep.toml", "--quiet", "--out"]
    subprocess.run([*threshold, "first"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
    with open(folder / "first/trials.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    with open(folder / "known.csv", "w", newline="") as file:
        table = csv.DictWriter(file, rows[0])
        table.writeheader()
        table.writerows({**row, "shape": hostile} for row in rows)
    subprocess.run([*threshold, "thresholds", "--known", "known.csv"], cwd=folder, check=True, stdout=subprocess.DEVNULL)


def pages_of_validations(program, folder):
    """Results of cases, and parameter sets, that come from somebody else."""
    data = Path(__file__).resolve().parents[2] / "data/parameters"
    kept = ("format", "case", "verdict", "key", "guard", "hash", "error", "not_applicable")  # such cases are run anew

    def put(directory, names, outcome, **changed):
        (folder / directory).mkdir(parents=True, exist_ok=True)
        for name in names:
            (folder / directory / f"{name}.json").write_text(json.dumps({**outcome, "case": name, **changed}))

    cases = json.loads(subprocess.run([program, "validate", "list", "--json"], check=True, capture_output=True).stdout)
    of = {group: [c["name"] for c in cases if c["against"] == group] for group in ("theory", "stability")}
    not_limits = [c["name"] for c in cases if c["against"] != "stability"]
    for tube in ("5-5", "9-0"):
        name = f"cnt-{tube}-tersoff"
        for directory in ("tube", "tubes"):
            (folder / directory).mkdir(exist_ok=True)
            for ending in ("-stiffness.csv", "-contact.csv"):
                shutil.copy(data / (name + ending), folder / directory)
            lines = (data / (name + ".toml")).read_text().splitlines()
            # The potential stands in titles, the reference in the page of the set.
            (folder / directory / (name + ".toml")).write_text("\n".join(
                f"{line.split('=')[0]}= '{hostile}'" if line.split(" ")[0] in ("potential", "reference") else line
                for line in lines) + "\n")
        subprocess.run([program, "validate", "run", "euler-buckling", "--parameters", f"tube/{name}.toml", "--quiet", "--out", "one"],
                       cwd=folder, check=True, stdout=subprocess.DEVNULL)
        outcome = hostile_texts(json.loads((folder / "one/euler-buckling.json").read_text()), kept)
        for directory in ("tube", "tubes"):
            put(f"{directory}/{name}-validation", not_limits, outcome)
    outcome["checks"] += [{**outcome["checks"][0], "relative": False, "informative": False},
                          {**outcome["checks"][0], "known_miss": {"difference": 1, "within": 1}}]
    outcome["limits"] = [{"method": hostile, "found": 1, "theory": 1, "unit": hostile, "guard": "told", "how": hostile}]
    outcome["remarks"] = outcome["sources"] = [hostile]
    put("validation", of["theory"], outcome)
    put("validation-failed", of["theory"][:1], outcome, error=hostile)
    put("validation-failed", of["theory"][1:2], outcome, not_applicable=hostile)
    put("stability", of["stability"], outcome)
    for directory in ("validation", "validation-failed", "stability"):
        subprocess.run([program, "validate", "report", directory], cwd=folder, check=True, stdout=subprocess.DEVNULL)
    # Some of the cases miss with such results, which is no fault of the page.
    for directory, tubes in (("tube", ["5,5"]), ("tubes", ["5,5", "9,0"])):
        subprocess.run([program, "parametrize", *tubes, "--out", directory, "--friction", "none", "--quiet"], cwd=folder,
                       stdout=subprocess.DEVNULL)
    # A tube without a set, with the reason that LAMMPS does not start.
    subprocess.run([program, "parametrize", "5,5", "9,0", "6,0", "--out", "tubes", "--friction", "none", "--quiet"], cwd=folder,
                   stdout=subprocess.DEVNULL, env={**os.environ, "ROPEWALK_LMP": f"{folder}/nowhere/{hostile}"})


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
    # A run directory may come from a stranger. Each text of its manifest and limits is therefore a hostile one here.
    kept_of_manifest = ("format", "status", "scene_hash", "parameter_hash", "own_parts")
    for name, kept in (("manifest.json", kept_of_manifest), ("limits.json", ("format", "key"))):
        path = folder / "hostile" / name
        path.write_text(json.dumps(hostile_texts(json.loads(path.read_text()), kept)))
    subprocess.run([program, "report", "hostile"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
    subprocess.run([program.parent.parent / "calibrate/ropewalk-calibrate", "show", "set.toml", "--page", "set.html"], cwd=folder,
                   check=True, stdout=subprocess.DEVNULL)
    pages_of_thresholds(program, folder)
    pages_of_validations(program, folder)
    # The page of a comparison has the names of directories, that of a parametrization those of its tubes.
    for page, shown in (("hostile/report.html", True), ("hostile/view.html", True), ("compared.html", False), ("sets.html", True),
                        ("set.html", True), ("thresholds/thresholds.html", True), ("validation/report.html", True),
                        ("validation-failed/report.html", True), ("stability/report.html", True), ("tubes/report.html", True),
                        ("tube/report.html", True)):
        browser.size(*pages.desk)
        browser.open((folder / page).as_uri())
        pages.expect(browser.value("typeof window.ran") == "undefined", f"{page}: a text has run a script")
        if shown:
            pages.expect(hostile in browser.value("document.documentElement.textContent"), f"{page}: does not show the text")
        pages.expect(browser.value("document.images.length") == 0, f"{page}: a text has become an image")
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
        pictures = browser.value("document.images.length")  # the last page has the states beside each threshold
        pages.expect(pictures >= 2, f"{shipped[-1]}: {pictures} pictures")
        chart_points(browser, repository)
        report_of_a_run(browser, Path(sys.argv[2]).resolve(), Path(folder).resolve())
        demo_on_paper(browser, Path(sys.argv[2]).resolve(), repository, Path(folder).resolve())
        hostile_pages(browser, Path(sys.argv[2]).resolve(), Path(folder).resolve())
    print(f"{len(shipped) + 1} pages at three sizes")
    for error in pages.errors:
        print(error, file=sys.stderr)
    return 1 if pages.errors else 0


if __name__ == "__main__":
    sys.exit(main())
