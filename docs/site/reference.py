"""The pages of the reference, made from what the programs say of themselves, from the scenes that tests give to them,
and from the headers of the library."""
import json
import re
import subprocess
import tempfile
import xml.etree.ElementTree as xml
from pathlib import Path

made = "<!-- made by docs/site/reference.py -->\n"


def cell(text):
    """In a table: one line, in which nothing is taken for Markdown or HTML."""
    out = text.replace("\n", " ")
    for c in "\\|<>[]*_$`":
        out = out.replace(c, "\\" + c)
    return out


def code(text):
    return "`` " + text.replace("|", "\\|") + " ``" if "`" in text else "`" + text.replace("|", "\\|") + "`"


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def described(program):
    return json.loads(subprocess.run([program, "describe", "json"], check=True, capture_output=True, text=True).stdout)


# --- Commands ---

def option_rows(options):
    rows = []
    for o in options:
        if "--help" in o["names"]:
            continue
        name = ", ".join(code(n + (" " + o["value"] if o["value"] and n == o["names"][-1] else "")) for n in o["names"])
        meaning = cell(o["meaning"])
        if o["default"] and "[default" not in meaning:
            meaning += " \\[default: " + cell(o["default"]) + "\\]"
        if o["positional"] or o["required"]:
            meaning = ("required: " if o["required"] else "may be left out: ") + meaning
        rows.append([name, meaning])
    return rows


def exit_codes(about):
    """The numbers and their meaning in "Exit code: 0 done, 2 wrong input, ...."""
    sentence = re.search(r"Exit codes?: (.*?)\.?$", about, re.S)
    return re.findall(r"(\d[^ ]*(?: \+ signal)?) ?([^,]*)", sentence[1].replace("\n", " ")) if sentence else []


def commands(programs):
    text = made + "# Commands\n\nEvery program, verb and option, as `--help` has them. `ropewalk calibrate ...` and "
    text += "`ropewalk validate ...` start\n`ropewalk-calibrate ...` and `ropewalk-validate ...`.\n"
    for p in programs:
        about = p["about"].split("\n")[0]
        text += f"\n## `{p['program']}`\n\n{cell(about)}\n"
        own = option_rows(p["options"])
        if own:
            text += "\n" + table(["option", "meaning"], own)
        for verb in p["verbs"]:
            rows = option_rows(verb["options"])
            if not rows and p["program"] == "ropewalk":  # handed over to another program
                text += f"\n### `{p['program']} {verb['name']}`\n\n{cell(verb['meaning'])}. See below.\n"
                continue
            text += f"\n### `{p['program']} {verb['name']}`\n\n{cell(verb['meaning'])}.\n"
            if rows:
                text += "\n" + table(["argument", "meaning"], rows)
    text += "\n## Exit codes\n"
    for p in programs:
        codes = exit_codes(p["about"])
        if codes:
            text += f"\n`{p['program']}`:\n\n" + table(["code", "meaning"],
                                                      [[code(number), cell(meaning) or "ended by a signal"]
                                                       for number, meaning in codes])
    return text


# --- Scenes ---

def key_table(keys):
    return table(["key", "unit", "default", "meaning"],
                 [[code(k["key"]), cell(k["unit"]), cell(k["standard"]), cell(k["meaning"])] for k in keys])


def page_of(scene_table):
    """The name of a table's page."""
    return scene_table["table"].strip("[]") or "top"


def sentence(text):
    return cell(text[:1].upper() + text[1:]) + "."


def scene(program):
    text = made + "# Keys of a scene\n\n`ropewalk new` writes a scene with all of them, `ropewalk help scene` prints "
    text += "them. A key that is\nnot typed has the default. Each table has a page: syntax, example, formula, what it does not go with.\n"
    for t in program["scene"]:
        head = f"`{t['table']}`" if t["table"] else "Top"
        meaning = sentence(t["meaning"] if t["table"] else "at the top of the file") + f" [More](tables/{page_of(t)}.md)"
        text += f"\n## {head}\n\n{meaning}\n\n" + key_table(t["keys"])
    return text


def scene_tables(program):
    """A page for each table of a scene, of what docs/tables.md, docs/theory.md and the program say of it."""
    pages, names = {}, {page_of(t) for t in program["scene"]}
    for t in program["scene"]:
        text = made + f"# {'`' + t['table'] + '`' if t['table'] else 'The top of a scene'}\n"
        for part in t["parts"]:
            if not part["text"]:
                raise SystemExit(f"reference.py: docs/tables.md, below \"## {page_of(t)}\": there is no "
                                 + (f"\"{part['heading']}\"" if part["heading"] else "paragraph"))
            keys = part["heading"] == "Keys"
            text += (f"\n## {part['heading']}\n" if part["heading"] else "")
            text += "\n" + (key_table(t["keys"]) if keys else part["text"] + "\n")
        pages[f"tables/{page_of(t)}.md"] = text
    unknown = set(program["described_tables"]) - names
    if unknown:
        raise SystemExit(f"reference.py: docs/tables.md: a scene has no table {', '.join(sorted(unknown))}")
    return pages


# --- Messages ---

def refused(ropewalk, folder):
    """What `ropewalk check` says of each bad scene of the tests, with the lines that it names."""
    said = []
    for file in sorted(folder.glob("*.toml"), key=lambda p: int(p.name.split("-")[0])):
        head = file.read_bytes().split(b"\n", 1)[0].decode(errors="replace")
        if not head.startswith("# expect:"):
            continue
        done = subprocess.run([ropewalk, "check", file.name], cwd=folder, capture_output=True, text=True,
                              errors="replace")
        message = done.stderr.strip()
        if done.returncode != 2 or "\n" in message:
            raise SystemExit(f"reference.py: {file}: exit code {done.returncode}, {message}")
        message = message.removeprefix("ropewalk: ")
        named = re.match(r"([^:]+\.(?:toml|csv)):(\d+):", message)
        line = ""
        if named and (folder / named[1]).is_file():
            lines = (folder / named[1]).read_text(errors="replace").split("\n")
            line = lines[int(named[2]) - 1].strip() if int(named[2]) <= len(lines) else ""
        said.append((message, line))
    return said


def of_file(message):
    """File and line, then what is wrong with which key."""
    where = re.match(r"([^:\s]+\.(?:toml|csv)(?::\d+)?): (.*)", message, re.S)
    return (where[1], where[2]) if where else ("", message)


def numerical_errors(sources):
    """The messages of NumericalError in the sources of the simulator: what went wrong, and the remedy."""
    found = []
    for file in sorted(sources.rglob("*.cpp")):
        for call in re.finditer(r"NumericalError\((.*?)\);", file.read_text(), re.S):
            parts = re.split(r"(?<=\"),", call[1])  # between two string literals
            # Literals in a row are one text; between others stands a number.
            parts = [re.sub(r'"\s*"', "", part) for part in parts]
            texts = ["...".join(re.findall(r'"((?:[^"\\]|\\.)*)"', part)) for part in parts]
            texts = [t for t in texts if t]
            if len(texts) == 2:
                found.append(texts)
    return found


def messages(repository, programs, ropewalk):
    text = made + """# What the messages mean

A message names file, line and key, what is wrong, and what to do. Search this page for the words that you see; your
names and numbers stand in place of those here.

## Wrong input: exit code 2

Nothing is written. Left: a line of a scene, a parameter set or a state. Right: what `ropewalk check`, `run` and all other
verbs say of it. These are the scenes that the tests hold the program to.
"""
    groups = {}
    top, sets, state_files = "A scene as a whole", "Parameter sets", "State files"
    tables = {t["table"].strip("[]"): f"`{t['table']}`" for t in programs[0]["scene"] if t["table"]}
    for message, line in refused(ropewalk, repository / "tests/cli/bad"):
        where, what = of_file(message)
        key = re.match(r"([a-zA-Z_]+)[.:]", what)
        file = where.split(":")[0]
        group = (state_files if file.endswith(".csv") else sets if file.startswith("parameters/")
                 else tables[key[1]] if key and key[1] in tables else top)
        groups.setdefault(group, []).append((what, line if len(line) < 100 else line[:95] + " ..."))
    order = sorted(groups, key=lambda g: ([top, sets, state_files].index(g) if g in (top, sets, state_files) else 0.5, g))
    for group in order:
        rows = [[code(line) if line else "", cell(what)] for what, line in groups[group]]
        text += f"\n### {group}\n\n" + table(["line", "message"], rows)
    text += """
## A run that stops: exit code 3

The state at that moment is in `failed-state.csv`. The message begins with the step and the element.

"""
    text += table(["what went wrong", "what to do"],
                  [[cell(what), cell(remedy)] for what, remedy in numerical_errors(repository / "mdem/sim")])
    text += """
## A limit of the model is passed: a warning, or exit code 5

`run` names the place and the time and goes on, or does what `--on-limit` says. The table `[limits]` of a
[scene](scene.md) changes or switches off each.

"""
    text += "[Limits](../limits.md) says of each what is wrong, whether it is real and what to change.\n\n"
    text += table(["limit", "what the message says", "why it matters", "what to do"],
                  [[code(k["key"]), cell(k["what"]) + " ...", cell(k["consequence"]), cell(k["remedy"])]
                   for k in programs[0]["limits"]])
    text += """
## A relaxation that does not come to rest: exit code 4

The last line says what ended it and what to do: more steps (`run.max_steps`, or `ropewalk resume`), another solver, a smaller load, or dynamics.
The files are kept: start another scene from `final.csv`.
"""
    return text


# --- The library ---

folders = {
    "model": "pure forms: bonds, contact laws, damping, parameter sets",
    "sim": "states, neighbours, forces, dynamics",
    "observe": "what is measured on a state",
    "scene": "scenes: keys, readers, starting states",
    "io": "files",
    "plan": "what is foreseen of a scene, and a run against a finer model",
    "run": "the loop around a simulation, and its directory",
    "report": "pages and pictures",
    "campaign": "many runs",
    "cli": "command lines",
}


def first_sentence(header):
    words = []
    for line in header.read_text().split("\n"):
        if not re.match(r"// {0,2}\S", line):  # the end of the paragraph, or an example
            break
        words.append(line.lstrip("/ "))
    text = re.split(r"(?<=[.;]) +(?=[A-Za-z(])", " ".join(words))[0]
    return text.rstrip(".:;")


def library(repository, tags):
    page_of = {}
    for file in xml.parse(tags).getroot().findall("compound[@kind='file']"):
        path = Path(file.findtext("path") or "", file.findtext("name"))
        if path.suffix != ".hpp":
            continue
        page_of[str(path.relative_to(repository / "mdem"))] = file.findtext("filename")
    text = made + """# The library

The headers that `cmake --install` puts into `include/ropewalk`, with the first sentence of each. A name leads to all that
it declares. [How to use them in a program of your own](../how-to/install.md).
"""
    groups = {}
    for path in sorted(page_of):
        groups.setdefault(path.split("/")[0], []).append(path)
    for folder in sorted(groups, key=lambda f: list(folders).index(f) if f in folders else 99):
        text += f"\n## `{folder}`: {folders[folder]}\n\n" if folder in folders else f"\n## `{folder}`\n\n"
        rows = [[f'<a href="../api/{page_of[p]}"><code>{p}</code></a>', cell(first_sentence(repository / "mdem" / p))]
                for p in groups[folder]]
        text += table(["header", "about"], rows)
    return text


def pages(repository, folder, tags):
    """Name and text of each page. `folder`: the build, `tags`: Doxygen's list of what it has made."""
    ropewalk = folder / "mdem/ropewalk"
    programs = [described(p) for p in (ropewalk, folder / "calibrate/ropewalk-calibrate",
                                       folder / "validate/ropewalk-validate")]
    return {"commands.md": commands(programs), "scene.md": scene(programs[0]), **scene_tables(programs[0]),
            "messages.md": messages(repository, programs, ropewalk.resolve()), "library.md": library(repository, tags)}
