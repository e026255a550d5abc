#!/usr/bin/env python3
"""The house's pages: short, undated, linked alive. Usage: pages.py [ROOT]. Exits 1 on faults.

READMEs have at most 120 lines of at most 120 columns (rows of tables and lines with links may be longer) and no dates:
experiments live in tests/notebook. Relative links lead somewhere, in every .md. A notebook page has its headings. What
sim/EQUATIONS.md names is in the file that it names. pages_test.sh breaks pages and sees that each fault is found.
"""
import os
import re
import sys

import tree

MAX_LINES = 120
MAX_COLUMNS = 120
# Not yet within these limits: take a name out once its page is. Nothing else is let off.
NOT_YET = {
    "scenes/blender/README.md",
}
HEADINGS = ["## Question", "## Command", "## Result", "## Verdict"]
NOTEBOOK = "tests/notebook"
EQUATIONS = "sim/EQUATIONS.md"

MONTH = "January|February|March|April|May|June|July|August|September|October|November|December"
DATE = re.compile(rf"\b\d{{4}}-\d\d-\d\d\b|\b\d{{1,2}} (?:{MONTH})(?: \d{{4}})?\b|\b(?:{MONTH}) \d{{4}}\b")
LINK = re.compile(r"\]\(([^()\s]+)\)")  # its text may begin on the line before
NAMED = re.compile(r"((?:`[^`]+`, )*`[^`]+`) in \[[^\]]*\]\(([^)#]+)\)")

faults = []


def fault(page, number, text):
    faults.append(f"{page}:{number}: {text}")


def prose(lines):
    """(number, line) outside of blocks of code, which quote what is no link and no prose."""
    fenced = False
    for number, line in enumerate(lines, 1):
        if line.startswith("```"):
            fenced = not fenced
        elif not fenced and not line.startswith("    "):
            yield number, line


def anchor(heading):
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading.lstrip("#").strip().lower())
    return re.sub(r"[^\w\- ]", "", text).replace(" ", "-")


def check_links(root, page, lines):
    for number, line in prose(lines):
        for target in LINK.findall(re.sub(r"`[^`]*`", "``", line)):
            if re.match(r"[a-z][a-z0-9+.-]*:", target):
                continue
            path, _, part = target.partition("#")
            at = os.path.join(root, os.path.dirname(page), path) if path else os.path.join(root, page)
            if not os.path.exists(at):
                fault(page, number, f"the link to {target} is dead. Point it at where that is now, or take it out.")
            elif part and at.endswith(".md"):
                with open(at, encoding="utf-8") as other:
                    if part not in {anchor(text) for text in other if text.startswith("#")}:
                        fault(page, number, f"{path or page} has no heading for #{part}. Name one that it has.")


def check_limits(page, lines):
    if len(lines) > MAX_LINES:
        fault(page, MAX_LINES + 1, f"{len(lines)} lines; {MAX_LINES} are allowed. Move experiments to {NOTEBOOK}, "
              "lists of fields and formats to a page of their own.")
    for number, line in enumerate(lines, 1):
        if len(line) > MAX_COLUMNS and not line.startswith("|") and not LINK.search(line):
            fault(page, number, f"{len(line)} columns; {MAX_COLUMNS} are allowed. Break the line.")
        date = DATE.search(LINK.sub("", line))
        if date:
            fault(page, number, f"the date {date.group()}. What was measured when stands in {NOTEBOOK}.")


def check_notebook(page, lines):
    found = [line.rstrip() for line in lines if line.startswith("## ")]
    if not lines or not lines[0].startswith("# "):
        fault(page, 1, "no title. Begin with '# Title'.")
    if found != HEADINGS:
        fault(page, 1, f"the headings are {found}. They are to be {HEADINGS}, in this order.")
    if not re.match(r"\d{4}-\d\d-\d\d-[a-z0-9-]+\.md$", os.path.basename(page)):
        fault(page, 1, "the name. Call it YYYY-MM-DD-topic.md.")


def check_equations(root, page, lines):
    for number, line in enumerate(lines, 1):
        for names, path in NAMED.findall(line):
            at = os.path.join(root, os.path.dirname(page), path)
            if not os.path.exists(at):
                continue  # the link's fault
            with open(at, encoding="utf-8") as source:
                text = source.read()
            for name in re.findall(r"`([^`]+)`", names):
                if not all(re.search(rf"\b{re.escape(word)}\b", text) for word in re.split(r"::|\.", name)):
                    fault(page, number, f"{name} is not in {path}. Name the function, and the file that has it now.")
    rows = {match.group(1) for line in lines if (match := re.match(r"\| ((?:Eq|Alg) \d+) \|", line))}
    for wanted in [f"Eq {n}" for n in range(1, 16)] + ["Alg 1", "Alg 2"]:
        if wanted not in rows:
            fault(page, 1, f"no row for {wanted}. Say where it is, or that nothing does it.")


def main():
    root = sys.argv[1] if len(sys.argv) > 1 else "."
    count = 0
    for page in tree.files(root, ".md"):
        count += 1
        with open(os.path.join(root, page), encoding="utf-8") as file:
            lines = file.read().splitlines()
        check_links(root, page, lines)
        if os.path.basename(page) == "README.md":
            if page not in NOT_YET:
                check_limits(page, lines)
        elif os.path.dirname(page) == NOTEBOOK:
            check_notebook(page, lines)
        if page == EQUATIONS:
            check_equations(root, page, lines)
    print("\n".join(faults + [f"{count} pages, {len(faults)} faults"]))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
