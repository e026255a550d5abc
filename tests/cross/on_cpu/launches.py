"""Turns the launches in one of sim/cuda's sources into calls that a C++ compiler takes (device.h).

Usage: launches.py SOURCE.cu RESULT.cpp
"""
import re
import sys

# Those that have barriers, and run as fibers. A barrier in any other ends the program with words.
WITH_BARRIERS = {"chunk_kernel", "chunk_drag_kernel", "body_kernel"}


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
    fibers = "true" if kernel.split("<")[0] in WITH_BARRIERS else "false"
    return (f"on_cpu::Launch{{static_cast<unsigned>({blocks}), static_cast<unsigned>({threads}), {fibers}}}"
            f".run([&](auto&&... a) {{ {kernel}(a...); }}, ")


def main():
    source, result = sys.argv[1:]
    with open(source, encoding="utf-8") as file:
        text = file.read()
    text = re.sub(r"([A-Za-z_]\w*(?:<[^<>;(){}]*>)?)\s*<<<(.*?)>>>\s*\(", launch, text, flags=re.S)
    # The one cooperative launch: its arguments by their names, which an array of addresses hides.
    text = re.sub(r"return cudaLaunchCooperativeKernel\(.*?stream\);",
                  "on_cpu::Launch{grid, kSolveThreads, true}.run("
                  "[&](auto&&... a) { solve_kernel<viscosity>(a...); }, solve, status);\n    return cudaSuccess;",
                  text, flags=re.S)
    with open(result, "w", encoding="utf-8") as file:
        file.write(f'#line 1 "{source}"\n{text}')


if __name__ == "__main__":
    main()
