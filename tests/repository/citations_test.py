#!/usr/bin/env python3
"""Tests that these exist: each promise and section that a comment or page cites, and each file and heading that a page
links to."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGES = ("PROMISES.md", "NUMERICS.md", "ARCHITECTURE.md")


def filesOf(*suffixes):
    for top in ("collision", "planner", "robots", "problems", "tests"):
        yield from (f for f in sorted((ROOT / top).rglob("*")) if f.suffix in suffixes and f.is_file())
    yield from (f for f in sorted(ROOT.glob("*.md")))


def headingsOf(text):
    return [h.strip() for h in re.findall(r"^#+ (.+)$", text, re.M)]


def anchorOf(heading):
    """Returns the anchor that GitHub makes from a heading."""
    plain = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "").lower()
    return re.sub(r"[^\w\- ]", "", plain).replace(" ", "-")


def citationFaults(text, name, pages):
    """Yields a fault for each citation that leads nowhere. A citation is `PAGE.md, promise N` or `PAGE.md, "Section"`;
    it may extend over two lines."""
    flat = re.sub(r"\n\s*(///?|#|\*)?\s*", " ", text)
    for page, what in re.findall(rf"({'|'.join(PAGES)})\)?, (promises? \d|\"[^\"]+\")", flat):
        headings = pages[page]
        if what.startswith("promise"):
            if not any(h.startswith(f"Promise {what.split()[1]}:") for h in headings):
                yield f"{name}: {page} has no {what}"
        elif what.strip('"') not in headings:
            yield f"{name}: {page} has no section {what}"
    for old in re.findall(r"\((?:design|numerics):[^)]*\)", flat):
        yield f"{name}: {old} cites a page that is not in the repository"


def linkFaults(path):
    name, text = path.relative_to(ROOT).as_posix(), path.read_text()
    for link in re.findall(r"\]\(([^)\s]+)\)", re.sub(r"```.*?```", "", text, flags=re.S)):
        if "://" in link:
            continue
        file, _, anchor = link.partition("#")
        target = (path.parent / file).resolve() if file else path
        if not target.exists():
            yield f"{name}: the link {link} leads nowhere"
            continue
        page = target / "README.md" if target.is_dir() else target
        if anchor and page.suffix == ".md" and anchor not in map(anchorOf, headingsOf(page.read_text())):
            yield f"{name}: {link}: no heading of that name"


def main():
    pages = {p.name: headingsOf(p.read_text()) for p in (*ROOT.glob("*/PROMISES.md"), *ROOT.glob("*/NUMERICS.md"),
                                                         *ROOT.glob("*/ARCHITECTURE.md"))}
    if set(pages) != set(PAGES):
        print(f"the pages are {sorted(pages)}, not {sorted(PAGES)}")
        return 1
    faults, cited = [], 0
    for path in filesOf(".h", ".cpp", ".md"):
        text = path.read_text(errors="replace")
        cited += sum(text.count(p) for p in PAGES)
        faults += citationFaults(text, path.relative_to(ROOT).as_posix(), pages)
        if path.suffix == ".md":
            faults += linkFaults(path)
    print("\n".join(faults))
    print(f"{cited} citations, {len(faults)} faults")
    return 1 if faults or not cited else 0


if __name__ == "__main__":
    sys.exit(main())
