#!/usr/bin/env python3
"""No line of a source is longer than the formatter's limit: who edits runs ./slosh format.

Usage: line_length.py ROOT. Between clang-format off and on anything goes. Exits 1 where a line is longer.
"""
import os
import sys
import unicodedata

import tree

LIMIT = 110
ENDS = (".cpp", ".h", ".cu", ".cuh")


def long_lines(path):
    off = False
    with open(path, encoding="utf-8") as lines:
        for number, line in enumerate(lines, 1):
            off = (off or "clang-format off" in line) and "clang-format on" not in line
            width = sum(not unicodedata.combining(sign) for sign in line.rstrip("\n"))
            # A text that cannot be broken is no fault.
            if width > LIMIT and not off and '"' not in line:
                yield number, width


def main(root):
    files = faults = 0
    for path in tree.files(root, ENDS):
        files += 1
        for number, length in long_lines(os.path.join(root, path)):
            faults += 1
            print(f"{path}:{number}: has {length} columns, more than {LIMIT}: ./slosh format")
    print(f"{files} sources, {faults} faults")
    return 1 if faults or not files else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]) if len(sys.argv) == 2 else __doc__)
