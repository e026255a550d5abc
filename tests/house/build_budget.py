#!/usr/bin/env python3
"""Holds the build to its budget: how many objects a target compiles, and how many bytes the compiler reads for them.

Usage: build_budget.py BUILD_FOLDER BUDGET_FILE [TARGET...]

The budget file has a line a target: its name, objects, megabytes read. Bytes are the sizes of all files that an object
was made of, by ninja's own record, so a target is judged once it is built. Prints what each target has, the build's
slowest objects and their seconds (of the wall: ninja knows no others). Exits 1 where a budget is passed.
"""
import os
import subprocess
import sys


def ninja(folder, *words):
    return subprocess.run(["ninja", "-C", folder, "-t", *words], check=True, capture_output=True, text=True).stdout


def bytes_read(folder):
    """Object -> bytes of all it was made of."""
    sizes, read, current = {}, {}, None
    for line in ninja(folder, "deps").splitlines():
        if line and not line[0].isspace():
            current = line.split(": #deps")[0]
            read[current] = 0
        elif line.strip():
            path = os.path.join(folder, line.strip())
            if path not in sizes:
                sizes[path] = os.path.getsize(path) if os.path.exists(path) else 0
            read[current] += sizes[path]
    return read


def slowest(folder, count):
    # The log still has what builds before made, under names that no unity group has any more.
    built = {line.split(": ")[0] for line in ninja(folder, "targets", "all").splitlines()}
    seconds = {}
    with open(os.path.join(folder, ".ninja_log")) as log:
        for line in log:
            parts = line.rstrip("\n").split("\t")
            if len(parts) == 5 and parts[3].endswith(".o") and parts[3] in built:
                seconds[parts[3]] = (int(parts[1]) - int(parts[0])) / 1000.0
    return sorted(seconds.items(), key=lambda item: -item[1])[:count], sum(seconds.values())


def main(folder, budget_file, targets):
    read = bytes_read(folder)
    faults = 0
    with open(budget_file) as lines:
        budgets = [line.split() for line in lines if line.strip() and not line.startswith("#")]
    for name, most_objects, most_megabytes in budgets:
        if targets and name not in targets:
            continue
        objects = [path for path in ninja(folder, "inputs", name).split("\n") if path.endswith(".o")]
        built = [path for path in objects if path in read]
        megabytes = sum(read[path] for path in built) / 1e6
        print(f"{name}: {len(objects)} objects of at most {most_objects}, "
              f"{megabytes:.0f} MB read of at most {most_megabytes} ({len(built)} objects built)")
        if len(objects) > int(most_objects):
            faults += 1
            print(f"{budget_file}: {name} has more objects than its budget: put its files into one unity group "
                  "(unity.cmake), or raise the budget in the same commit and say why")
        if megabytes > float(most_megabytes):
            faults += 1
            print(f"{budget_file}: {name} reads more than its budget: keep heavy headers in few files, "
                  "or raise the budget in the same commit and say why")
    worst, whole = slowest(folder, 10)
    print(f"slowest objects, of {whole:.0f} object-seconds:")
    for path, seconds in worst:
        print(f"  {seconds:6.1f} s  {path}")
    print(f"{len(budgets)} budgets, {faults} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1], sys.argv[2], sys.argv[3:]))
