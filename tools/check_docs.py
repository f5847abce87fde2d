#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Check README.md and docs/: links lead somewhere, every public header is mentioned, no picture is missing.

    check_docs.py [ROOT]     exit 0: all well; 1: each fault as file:line
"""
import pathlib
import re
import sys

LINK = re.compile(r"!?\[[^\]]*\]\(<?([^)>\s]+)>?(?:\s+\"[^\"]*\")?\)")
HEADING = re.compile(r"^#+\s+(.*?)\s*#*$")


def anchor_of(heading):
    """The name by which a heading is linked to: lower case, spaces to hyphens, punctuation dropped."""
    return re.sub(r"[^\w\- ]", "", heading.replace("`", "").lower()).replace(" ", "-")


def prose_lines(path):
    """(number, line) of a Markdown file, code blocks left out."""
    fenced = False
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if line.lstrip().startswith("```"):
            fenced = not fenced
        elif not fenced and not line.startswith("    "):
            yield number, line


def anchors(path):
    return {anchor_of(match.group(1)) for _, line in prose_lines(path) if (match := HEADING.match(line))}


def check_links(root, page):
    faults = []
    for number, line in prose_lines(page):
        for target in LINK.findall(line):
            if re.match(r"[a-z]+:", target):
                continue
            name, _, fragment = target.partition("#")
            path = (page.parent / name) if name else page
            where = f"{page.relative_to(root).as_posix()}:{number}"
            if not path.exists():
                faults.append(f"{where}: {target} is not there")
            elif fragment and path.suffix == ".md" and fragment not in anchors(path):
                faults.append(f"{where}: {name or 'this page'} has no heading #{fragment}")
    return faults


def check_tree(root):
    pages = [root / "README.md", root / "CHANGELOG.md", root / "CONTRIBUTING.md", *sorted((root / "docs").rglob("*.md"))]
    pages = [page for page in pages if page.exists()]
    faults = [fault for page in pages for fault in check_links(root, page)]
    text = "\n".join(page.read_text(encoding="utf-8") for page in pages)
    for header in sorted((root / "include" / "contrejour").rglob("*.h")):
        if not re.search(rf"\b{re.escape(header.name)}\b", text):
            faults.append(f"{header.relative_to(root).as_posix()}:1: no page mentions this header: see README.md, Library")
    return faults, len(pages)


def main(arguments):
    root = pathlib.Path(arguments[0] if arguments else pathlib.Path(__file__).parent.parent).resolve()
    faults, count = check_tree(root)
    for fault in faults:
        print(fault)
    print(f"docs: {count} pages, {len(faults)} faults")
    return 1 if faults or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
