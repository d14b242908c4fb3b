#!/usr/bin/env python3
"""Lays out the pages of the site for Sphinx.

docs/ becomes the top of the site, with docs/README.md as its first page; other Markdown pages keep their place in the
repository. Pages of the reference are made from what the programs say (reference.py). Links lead to where their target
is laid; one that leads nowhere is an error.

    stage.py OUTPUT BUILD TAGS    (TAGS: Doxygen's list of what it has made)
"""
import os
import re
import shutil
import sys
from pathlib import Path

import chart
import reference

repository = Path(__file__).resolve().parents[2]

# The pages beside docs/, and the order of all: caption, then pages as they are named on the site.
beside_docs = ["README.md", "CHANGELOG.md", "THIRD_PARTY.md", "calibrate/README.md", "validate/README.md",
               "mdem/lammps/README.md", "data/**/README.md"]
contents = [
    ("Learn", ["tutorials/rope", "tutorials/tube", "tutorials/twist-to-failure", "tutorials/phase-diagram", "tutorials/python",
               "tutorials/atoms", "tutorials/cluster", "guide", "gallery"]),
    ("How to", ["how-to/install", "how-to/view", "how-to/resume", "how-to/campaign", "how-to/*"]),
    ("Reference", ["reference/commands", "reference/scene", "reference/tables/*", "outputs", "limits", "faults", "reference/messages",
                   "reference/library", "glossary"]),
    ("The model", ["theory", "calibrate/README", "validate/README", "mdem/lammps/README", "performance"]),
    ("Results", ["data/scenes/README", "data/**"]),
    ("The project", ["README", "architecture", "contributing", "CHANGELOG", "THIRD_PARTY", "*"]),
]
tables = Path("docs/tables.md")  # no page of its own: reference.py makes one of each of its sections
pictures = {".svg", ".png"}
font = Path("/usr/share/fonts/opentype/stix-word/STIXMath-Regular.otf")  # of formulas; Debian's fonts-stix
link = re.compile(r"(!?)\[([^\]]*)\]\(([^()\s]+)\)")
doi = re.compile(r"\bDOI(\s+)(10\.\d{4,}/[^\s,;)]*[^\s,;).])")


def place_of(path):
    """Where a file of the repository is laid on the site."""
    if path == Path("docs/README.md"):
        return Path("index.md")
    if path == tables:
        return Path("reference/scene.md")
    return path.relative_to("docs") if path.parts[0] == "docs" else path


def pages_of_repository():
    pages = {p.relative_to(repository) for p in (repository / "docs").rglob("*.md") if p.parent.name != "site"}
    for pattern in beside_docs:
        pages |= {p.relative_to(repository) for p in repository.glob(pattern)}
    return sorted(pages)


def lines_outside_code(text):
    """Each line, with whether it is text, not code."""
    fence, blank, indented = "", True, False
    for line in text.split("\n"):
        mark = re.match(r"\s*(```+|~~~+)", line)
        if fence:
            if mark and mark[1].startswith(fence):
                fence = ""
            yield line, False
            continue
        if mark:
            fence = mark[1]
            yield line, False
            continue
        indented = line.startswith("    ") and (blank or indented)
        blank = not line.strip()
        yield line, not indented


class Stage:
    def __init__(self, output):
        self.output = output
        self.pages = pages_of_repository()
        self.errors = []
        self.drawn = []  # pictures of flow charts

    def write(self, place, text):
        path = self.output / place
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def copy(self, file, place):
        (self.output / place).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(repository / file, self.output / place)

    def new_link(self, page, match):
        mark, words, target = match[1], match[2], match[3]
        if re.match(r"[a-z]+:|#", target):
            return match[0]
        target, hash_, anchor = target.partition("#")
        file = Path(os.path.normpath(page.parent / target))
        if place_of(file) in self.drawn:
            return match[0]
        if (repository / file).is_dir():
            file = file / "README.md"
        here = place_of(page).parent
        if file in self.pages:
            return f"{mark}[{words}]({os.path.relpath(place_of(file), here)}{hash_}{anchor})"
        if not (repository / file).is_file():
            self.errors.append(f"{page}: the link [{words}]({match[3]}) leads nowhere")
            return match[0]
        if file.suffix in pictures and mark:
            self.copy(file, place_of(file))
            return f"![{words}]({os.path.relpath(place_of(file), here)})"
        self.copy(file, Path("extra") / place_of(file))
        return f'<a href="{os.path.relpath(place_of(file), here)}">{words}</a>'

    def page(self, page, text=None):
        """A page of the repository as the site has it; `text` stands in the place of what is in its file."""
        text = self.with_charts(page, (repository / page).read_text() if text is None else text)
        text = re.sub(r"^( *)```math\n(.*?)^\1```$", r"\1$$\n\2\1$$", text, flags=re.S | re.M)
        lines = []
        for line, is_text in lines_outside_code(text):
            lines.append(link.sub(lambda m: self.new_link(page, m), line) if is_text else line)
        text = "\n".join(lines)
        return doi.sub(r"[DOI\1\2](https://doi.org/\2)", text)

    def table_page(self, text):
        """A page of reference/tables, whose links are those of a section of docs/tables.md: one folder higher, and to its
        other sections."""
        text = re.sub(r"(\]\(|<a href=\")(?![a-z]+:|#)", r"\1../", self.page(tables, text))
        return re.sub(r"\]\(#(\w+)\)", r"](\1.md)", text)

    def with_charts(self, page, text):
        def draw(match):
            picture = place_of(page).with_name(f"{page.stem}-chart-{len(self.drawn) + 1}.svg")
            self.drawn.append(picture)
            self.write(picture, chart.svg_of(match[1]))
            return f"![Chart]({picture.name})"

        return re.sub(r"^```mermaid\n(.*?)^```$", draw, text, flags=re.S | re.M)

    def toctrees(self, places):
        names = [str(p.with_suffix("")) for p in places if p != Path("index.md")]
        taken, text = set(), ""
        for caption, patterns in contents:
            listed = []
            for pattern in patterns:
                for name in names:
                    if name not in taken and Path(name).match(pattern.replace("**", "*")) or (
                            pattern.endswith("/**") and name.startswith(pattern[:-2]) and name not in taken):
                        listed.append(name)
                        taken.add(name)
            text += f"\n```{{toctree}}\n:hidden:\n:caption: {caption}\n" + "\n".join(listed) + "\n```\n"
        for name in sorted(set(names) - taken):
            self.errors.append(f"{name}: is in no table of contents")
        return text


def main():
    output, build, tags = (Path(p) for p in sys.argv[1:])
    shutil.rmtree(output, ignore_errors=True)
    (output / "extra").mkdir(parents=True)
    stage = Stage(output)
    made = reference.pages(repository, build, tags)
    places = [place_of(p) for p in stage.pages if p != tables] + [Path("reference") / name for name in made]
    for page in stage.pages:
        if page == tables:
            continue
        text = stage.page(page)
        if page == Path("docs/README.md"):
            text += stage.toctrees(places)
        stage.write(place_of(page), text)
    for name, text in made.items():
        if name.startswith("tables/"):
            text = stage.table_page(text)
        stage.write(Path("reference") / name, text)
    for file in (Path(__file__).with_name("conf.py"), Path(__file__).with_name("site.css"), font):
        shutil.copyfile(file, output / file.name)
    for error in stage.errors:
        print(f"stage.py: {error}", file=sys.stderr)
    return 1 if stage.errors else 0


if __name__ == "__main__":
    sys.exit(main())
