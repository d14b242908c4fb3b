"""A flow chart of Markdown (mermaid), which code hosts draw, as a picture by Graphviz. Reads what our pages use: nodes
id["label"], arrows --> and -->|label|, chains of them."""
import re
import subprocess

node = re.compile(r'\s*(\w+)(?:\["([^"]*)"\])?')
arrow = re.compile(r'\s*-->(?:\|"?([^|"]*)"?\|)?')


def dot_of(chart):
    lines = [line for line in chart.strip().split("\n") if line.strip()]
    direction = re.fullmatch(r"flowchart (LR|TB)", lines[0].strip())
    if not direction:
        raise ValueError(f"not a flow chart: {lines[0]}")
    out = [f"rankdir={direction[1]}"]
    for line in lines[1:]:
        at, before, label = 0, None, None
        while at < len(line):
            found = node.match(line, at)
            if not found:
                raise ValueError(f"not a node: {line[at:]}")
            name, words, at = found[1], found[2], found.end()
            if words is not None:
                out.append('{} [label="{}"]'.format(name, words.replace("<br>", "\\n")))
            if before:
                out.append('{} -> {} [label="{}"]'.format(before, name, label or ""))
            found = arrow.match(line, at)
            if not found:
                if line[at:].strip():
                    raise ValueError(f"not an arrow: {line[at:]}")
                break
            before, label, at = name, found[1], found.end()
    return out


def svg_of(chart):
    look = ['bgcolor="white"', "node [shape=box style=rounded fontname=Helvetica fontsize=12]",
            "edge [fontname=Helvetica fontsize=11 color=gray40]"]
    text = "digraph {" + ";\n".join(look + dot_of(chart)) + "}"
    svg = drawn(text)
    if int(re.search(r'width="(\d+)pt"', svg)[1]) > 700:  # wider than a page
        svg = drawn(text.replace("rankdir=LR", "rankdir=TB"))
    return svg


def drawn(text):
    return subprocess.run(["dot", "-Tsvg"], input=text, check=True, capture_output=True, text=True).stdout
