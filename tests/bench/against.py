#!/usr/bin/env python3
"""Is a step slower than it was? Builds bench_sim of an earlier commit beside this one's and runs them in turn.

    tests/bench/against.py COMMIT [--rounds 3] [--steps 30] [--counts 8192 32768] [--csv FILE]

Prints the ratio of the least and of the median step, new over old, for each model and number of threads that both have.
Turns, so that whatever else the machine does meets both; the least of all rounds, so that most of it meets neither.
"""
import argparse
import csv
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parents[2]
QUANTITIES = ("step_min_ms", "step_p50_ms")


def run(*command, where=HERE):
    done = subprocess.run(command, cwd=where, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode:
        sys.exit(f"against.py: {' '.join(map(str, command))}\n{done.stdout[-3000:]}")


def build(tree):
    """bench_sim of a source tree, without CUDA, in the release preset's folder of its own."""
    folder = tree / "build" / "against"
    run("cmake", "--preset", "release", "-B", folder, "-DSLOSH_TESTS=ON", "-DSLOSH_CUDA=OFF", where=tree)
    run("ninja", "-C", folder, "bench_sim", where=tree)
    return folder / "bin" / "bench_sim"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("commit", help="the earlier one")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--steps", type=int, default=30)
    parser.add_argument("--counts", type=int, nargs="+", default=[8192, 32768])
    parser.add_argument("--csv", type=pathlib.Path, help="all that was measured: tree, round, what, quantity, value")
    asked = parser.parse_args()

    rows = []
    with tempfile.TemporaryDirectory() as room:
        old = pathlib.Path(room) / "old"
        run("git", "worktree", "add", "--detach", old, asked.commit)
        try:
            print("building both ...", flush=True)
            programs = {"old": (build(old), old), "new": (build(HERE), HERE)}
            for number in range(1, asked.rounds + 1):
                for name, (program, tree) in programs.items():
                    print(f"round {number} of {asked.rounds}, {name} ...", flush=True)
                    table = pathlib.Path(room) / "table.csv"
                    counts = [word for count in asked.counts for word in ("--counts", str(count))]
                    run(program, "--only", "speed", "--steps", str(asked.steps), *counts, "--csv", table, where=tree)
                    with open(table, encoding="utf-8") as file:
                        rows += [(name, number, row["what"], row["quantity"], float(row["value"]))
                                 for row in csv.DictReader(file) if row["quantity"] in QUANTITIES]
        finally:
            run("git", "worktree", "remove", "--force", old)

    if asked.csv:
        with open(asked.csv, "w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file)
            writer.writerow(("tree", "round", "what", "quantity", "value"))
            writer.writerows(rows)
    least = {}
    for name, _, what, quantity, value in rows:
        key = (what, quantity, name)
        least[key] = min(value, least.get(key, value))
    print(f"{'':44} {'':12} {'old':>8} {'new':>8}  new/old")
    for what, quantity, name in sorted(least):
        if name != "old" or (what, quantity, "new") not in least:
            continue
        before, now = least[what, quantity, "old"], least[what, quantity, "new"]
        print(f"{what:44} {quantity:12} {before:8.3f} {now:8.3f}  {now / before:.2f}")


if __name__ == "__main__":
    main()
