"""Turns the launches in one of sim/cuda's sources into calls that a C++ compiler takes (device.h).

Usage: launches.py SOURCE.cu RESULT.cpp
"""
import re
import sys

# Those whose threads wait for others of their block, and run as fibers. Waiting in any other ends the program with
# words. "kernel" is what a kernel is called that is chosen where it is launched.
WAITING = {"density_kernel", "corrected_density_kernel", "force_kernel", "kernel", "tile_kernel", "cells_kernel",
           "press_rows_kernel"}


def split(text):
    """At the commas that stand in no brackets."""
    parts, depth = [""], 0
    for letter in text:
        depth += (letter in "(<{") - (letter in ")>}")
        if letter == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += letter
    return parts


def launch(match):
    kernel, (blocks, threads, *_) = match[1], split(match[2])
    waits = "kInBlock" if kernel.split("<")[0] in WAITING else "kForNobody"
    return (f"on_cpu::Launch{{static_cast<unsigned>({blocks}), static_cast<unsigned>({threads}), "
            f"on_cpu::Waits::{waits}}}"
            f".run([&](auto&&... a) {{ {kernel}(a...); }}, ")


def main():
    source, result = sys.argv[1:]
    with open(source, encoding="utf-8") as file:
        text = file.read()
    kernel = r"([A-Za-z_]\w*(?:<[^<>;(){}]*>)?)"
    text = re.sub(kernel + r"\s*<<<(.*?)>>>\s*\(", launch, text, flags=re.S)
    text = re.sub(rf"launch_early\({kernel},(.*?),\s*stream,\s*", launch, text, flags=re.S)
    # Cooperative launches: their arguments by their names, which an array of addresses hides.
    names = re.search(r"void\* arguments\[\] = \{(.*?)\};", text)
    if names:
        text = re.sub(r"return cudaLaunchCooperativeKernel\(reinterpret_cast<const void\*>\(([^()]*)\).*?stream\);",
                      lambda match: "on_cpu::Launch{grid, kSolveThreads, on_cpu::Waits::kInGrid}.run("
                      f"[&](auto&&... a) {{ {match[1]}(a...); }}, {names[1].replace('&', '')});\n"
                      "    return cudaSuccess;",
                      text, flags=re.S)
    with open(result, "w", encoding="utf-8") as file:
        file.write(f'#line 1 "{source}"\n{text}')


if __name__ == "__main__":
    main()
