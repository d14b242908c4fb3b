#!/usr/bin/env python3
"""The built site in Chromium, at the size of a desk, of a phone and on paper: no message on the console, no request but for
the site's own files, nothing wider than the page, also with wider fonts, formulas as MathML, pictures that are there.

    pages.py SITE"""
import base64
import shutil
import sys
from pathlib import Path

from browser import Browser

desk, phone, paper = (1300, 900), (360, 780), (718, 1000)  # CSS pixels; paper: A4 less margins
errors = []

# Fonts differ from machine to machine. A twentieth is added to the width of all text, so that a page which fits here has
# room there. A letter is about half as wide as it is high.
wider_text = """(() => {
  const style = document.createElement('style');
  style.textContent = '* { letter-spacing: 0.03em !important }';
  document.head.append(style);
})()"""


def expect(true, what):
    if not true:
        errors.append(what)


def wider(browser, width):
    """Names elements that stick out of a page of this width, but for those that scroll; empty if none does."""
    return browser.value(f"(given => {{ {sticks_out} }})({width})")


sticks_out = """
  const root = document.documentElement, width = Math.min(root.clientWidth, given);
  if (root.scrollWidth <= width) return '';
  const wide = [...document.querySelectorAll('body *')].filter(e => e.getBoundingClientRect().right > width + 1
    && !e.closest('.formula, .scroll, .table-wrapper, pre, svg > *, .sidebar-drawer, .toc-drawer'));
  return root.scrollWidth + ' pixels: ' + wide.slice(0, 3).map(e => e.outerHTML.slice(0, 120)).join(' | ');"""


def look(browser, site, page):
    """Opens a page at three sizes and notes what is wrong with it."""
    browser.size(*desk)
    browser.call("Emulation.setEmulatedMedia", media="")
    browser.open((site / page).as_uri())
    browser.value(wider_text)
    for size, name in ((desk, "desk"), (phone, "phone"), (paper, "paper")):
        browser.size(*size, phone=size == phone)
        browser.call("Emulation.setEmulatedMedia", media="print" if size == paper else "")
        browser.value("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
        wide = wider(browser, size[0])
        expect(not wide, f"{page}, {name}: is wider than the page, {wide}")
        expect(browser.value("document.body.innerText.trim().length") > 40, f"{page}, {name}: is empty")
    broken = browser.value("""[...document.images].filter(i => i.complete && i.naturalWidth === 0).map(i => i.src)""")
    expect(not broken, f"{page}: pictures are missing: {broken}")
    for line in browser.said():
        errors.append(f"{page}: the console says: {line}")
    for url in browser.asked():
        expect(url.startswith(site.as_uri() + "/") or url.startswith("data:"), f"{page}: asks for {url}")


def formulas(browser, site):
    browser.size(*desk)
    browser.open((site / "theory.html").as_uri())
    found = browser.value("""({
      inline: document.querySelectorAll('p math').length,
      block: document.querySelectorAll('.formula > math').length,
      flat: [...document.querySelectorAll('.formula > math')].filter(m => m.getBoundingClientRect().height < 12).length,
      dollars: [...document.querySelectorAll('article p, article li')].filter(p => p.innerText.includes('$')).length,
      bold: getComputedStyle(document.querySelector('mi[mathvariant=bold]')).fontWeight,
      font: document.fonts.check('16px "STIX Math"')})""")
    expect(found["inline"] > 100 and found["block"] > 25, f"theory.html: too few formulas: {found}")
    expect(found["flat"] == 0 and found["dollars"] == 0, f"theory.html: formulas that are not set: {found}")
    expect(int(found["bold"]) >= 600, f"theory.html: vectors are not bold: {found}")
    expect(found["font"], f"theory.html: the font of formulas is not loaded: {found}")


def darkness(browser, site):
    """Where the system is dark the page is, and its code as well."""
    browser.size(*desk)
    browser.call("Emulation.setEmulatedMedia", media="", features=[{"name": "prefers-color-scheme", "value": "dark"}])
    browser.open((site / "tutorials/rope.html").as_uri())
    shades = browser.value("""['body', 'pre', '.sidebar-drawer'].map(s => getComputedStyle(document.querySelector(s))
      .backgroundColor.match(/\\d+/g).slice(0, 3).map(Number)).map(c => Math.max(...c))""")
    expect(all(shade < 60 for shade in shades), f"tutorials/rope.html: not dark: {shades}")
    browser.call("Emulation.setEmulatedMedia", media="", features=[])


def search(browser, site):
    browser.size(*desk)
    browser.open((site / "search.html").as_uri() + "?q=crowding")
    found = browser.value("""new Promise(done => {
      const until = Date.now() + 20000;
      const look = () => {
        const all = [...document.querySelectorAll('#search-results li a')].map(a => a.getAttribute('href'));
        if (all.some(a => a.startsWith('theory.html')) || Date.now() > until) done(all); else setTimeout(look, 50);
      };
      look();
    })""")
    expect(any(link.startswith("theory.html") for link in found), f"search.html: crowding leads to {found}")
    for line in browser.said():
        errors.append(f"search.html: the console says: {line}")


def test_of_the_test(browser, site):
    """A page with every fault is found faulty."""
    global errors
    bad = site / "bad.html"
    bad.write_text("<!DOCTYPE html><meta name=viewport content='width=device-width'><p>A page with faults, for the test of the "
                   "test.</p><div style='width:900px'>wide</div><img src=none.png>"
                   "<img src=http://elsewhere.invalid/x.png><script>console.log('said')</script>")
    try:
        kept, errors = errors, []
        look(browser, site, "bad.html")
        found, errors = errors, kept
    finally:
        bad.unlink()
    for part in ("console says: said", "asks for http://elsewhere.invalid", "phone: is wider", "paper: is wider",
                 "pictures are missing"):
        expect(any(part in line for line in found), f"a page with faults: not seen: {part}; seen: {found}")


def test_of_the_margin(browser, site):
    """A line that takes 98 % of the width, in whatever font there is, fits and is found faulty."""
    global errors
    bad = site / "bad.html"

    def write(size):
        bad.write_text("<!DOCTYPE html><meta name=viewport content='width=device-width'><body style='margin:0'><p style="
                       f"'margin:0;width:max-content;white-space:nowrap;font-size:{size}px'>nanotubes</p>"
                       "A line that just fits, for the test of the test.")
        browser.size(*phone, phone=True)
        browser.open(bad.as_uri())

    try:
        write(50)
        write(50 * 0.98 * phone[0] / browser.value("document.querySelector('p').getBoundingClientRect().width"))
        fits = not wider(browser, phone[0])
        kept, errors = errors, []
        look(browser, site, "bad.html")
        found, errors = errors, kept
    finally:
        bad.unlink()
    expect(fits and any("phone: is wider" in line for line in found),
           f"a page that just fits: fits: {fits}, faults seen: {found}")


def main():
    if not shutil.which("chromium"):
        print("Chromium is not installed")
        return 77
    site = Path(sys.argv[1]).resolve()
    pages = sorted(p.relative_to(site) for p in site.rglob("*.html")
                   if p.relative_to(site).parts[0] not in ("api", "data", "_static") or p.name == "README.html")
    api = [Path("api/index.html"), *sorted(p.relative_to(site) for p in (site / "api").glob("bond_8hpp.html"))]
    with Browser() as browser:
        for page in pages + api:
            if str(page) != "search.html":
                look(browser, site, page)
        browser.call("Emulation.setEmulatedMedia", media="")
        formulas(browser, site)
        darkness(browser, site)
        search(browser, site)
        browser.open((site / "theory.html").as_uri())
        pdf = base64.b64decode(browser.call("Page.printToPDF")["data"])
        expect(pdf.startswith(b"%PDF") and len(pdf) > 50000, "theory.html: cannot be printed")
        test_of_the_test(browser, site)
        test_of_the_margin(browser, site)
    print(f"{len(pages) + len(api)} pages at three sizes")
    for error in errors:
        print(error, file=sys.stderr)
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
