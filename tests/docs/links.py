#!/usr/bin/env python3
"""Every link of the Markdown pages, as a code host shows them, and of the built site leads to a file that is there, and to
an anchor that is in it. Addresses elsewhere are listed, not asked. The version is one: of CMake, of the citation, of the newest
release notes, and of the example that finds the installed package.

    links.py REPOSITORY [SITE]"""
import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

errors, elsewhere = [], set()


def without_code(text):
    text = re.sub(r"^(```+|~~~+).*?^\1", "", text, flags=re.S | re.M)
    text = re.sub(r"(?<=\n\n)(?: {4}.*\n|\n)+", "\n", text)
    return re.sub(r"`[^`\n]*`", "", text)


def headings(text):
    """The anchors that code hosts give to headings."""
    seen, out = {}, set()
    for line in re.sub(r"^(```+|~~~+).*?^\1", "", text, flags=re.S | re.M).split("\n"):
        heading = re.match(r"#{1,6} +(.*)", line)
        if not heading:
            continue
        words = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading[1]).strip().lower()
        slug = re.sub(r"[^\w\- ]", "", words).replace(" ", "-")
        seen[slug] = seen.get(slug, -1) + 1
        out.add(slug if seen[slug] == 0 else f"{slug}-{seen[slug]}")
    return out


def check_markdown(repository):
    pages = [p for p in repository.rglob("*.md")
             if not any(part.startswith(("build", ".git")) or part in ("runs", "shared")
                        for part in p.relative_to(repository).parts)]
    count = 0
    for page in pages:
        for target in re.findall(r"\[[^\]]*\]\(([^()\s]+)\)", without_code(page.read_text())):
            count += 1
            url = urlsplit(target)
            if url.scheme:
                elsewhere.add(target)
                continue
            file = (page.parent / unquote(url.path)).resolve() if url.path else page
            where = f"{page.relative_to(repository)}: {target}"
            if not file.exists():
                errors.append(f"{where}: there is no such file")
            elif url.fragment and file.suffix == ".md" and url.fragment not in headings(file.read_text()):
                errors.append(f"{where}: there is no such heading")
    return len(pages), count


def check_version(repository):
    """The first match of each is the version, or its beginning."""
    found = {}
    for file, pattern in (("CMakeLists.txt", r"project\(ropewalk VERSION (\S+)"), ("CITATION.cff", r"^version: (\S+)"),
                          ("CHANGELOG.md", r"^## (\S+)"), ("docs/how-to/install.md", r"find_package\(Ropewalk (\S+)")):
        match = re.search(pattern, (repository / file).read_text(), re.M)
        found[file] = match[1] if match else "none"
    version = found["CMakeLists.txt"]
    for file, text in found.items():
        if not (version + ".").startswith(text + "."):
            errors.append(f"{file}: has version {text}, and CMakeLists.txt has {version}")


class Page(HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.links, self.anchors = [], set()
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name == "id" or (name == "name" and tag == "a"):
                self.anchors.add(value)
            elif name in ("href", "src") and value:
                self.links.append(value)


def check_site(site):
    files = [p for p in site.rglob("*.html") if p.relative_to(site).parts[0] != "api"] + [site / "api/index.html"]
    parsed, count = {}, 0

    def page_of(path):
        if path not in parsed:
            parsed[path] = Page(path.read_text())
        return parsed[path]

    for file in files:
        for link in page_of(file).links:
            count += 1
            url = urlsplit(link)
            if url.scheme or url.netloc:
                if url.scheme != "data":
                    elsewhere.add(link)
                continue
            target = (file.parent / unquote(url.path)).resolve() if url.path else file
            where = f"{file.relative_to(site)}: {link}"
            if target.is_dir() or not target.exists() or site.resolve() not in target.parents:
                errors.append(f"{where}: there is no such file in the site")
            elif url.fragment and target.suffix == ".html" and url.fragment not in page_of(target).anchors:
                errors.append(f"{where}: there is no such anchor")
    return len(files), count


def main():
    repository = Path(sys.argv[1]).resolve()
    print("{} pages of Markdown, {} links".format(*check_markdown(repository)))
    check_version(repository)
    if len(sys.argv) > 2:
        print("{} pages of the site, {} links".format(*check_site(Path(sys.argv[2]).resolve())))
    print("Elsewhere, not asked:", *sorted(elsewhere), sep="\n  ")
    for error in errors:
        print(error, file=sys.stderr)
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
