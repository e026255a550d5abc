#!/usr/bin/env python3
"""The field's words: finds invented ones in sources and pages. Usage: words.py [ROOT]. Exits 1 on faults.

A fluid or haptics engineer must be able to search the tree, so each message names the word to write in place (GLOSSARY.md
has them). Phrases are found over the ends of lines, too. Exempt are experiments as they were written down, recorded data
and names of notebook pages in links. words_test.sh plants such words and sees that each is found.
"""
import bisect
import os
import re
import sys

import tree

ENDINGS = (".h", ".cpp", ".cu", ".cuh", ".c", ".py", ".sh", ".md", ".txt", ".cmake", ".glsl", ".comp", ".frag", ".vert",
           ".slosh", ".json", ".yml", ".1")
NAMES = {"slosh", "CMakeLists.txt"}
EXEMPT = ("tests/notebook/", "tests/bench/results/", "tests/house/words.py", "tests/house/words_test.sh", "GLOSSARY.md")
NOTEBOOK_PAGE = re.compile(r"\b\d{4}-\d\d-\d\d-[a-z0-9-]+(?:\.md|\.csv)|\bnotebook/\S+")
# The start of a line within a comment or a quoted text that goes on.
LINE_START = re.compile(r"^\s*(?:///?<?|#+|\*|>|\")?\s*")

IDENTIFIERS = [
    (r"kMost[A-Z]\w*", "kMax…"),
    (r"kLeast[A-Z]\w*", "kMin…"),
    (r"TurnedMoment|turned_moment", "InverseMoment"),
    (r"HostWord|host_word", "HostUpdate"),
    (r"HostReins", "SupervisorControl"),
    (r"FeltHand\b|felt_hand(?:_test)?\b", "ForceRendering"),
    (r"WorldBelief", "StateFreshness"),
    (r"\bHearing\b", "LinkFreshness"),
    (r"LentDevice|lent_device", "SharedHandleDevice"),
    (r"SheetParticle", "LayerParticle"),
    (r"PressWalk|press_walk", "PressureLoop, pressure pairs"),
    (r"kImplicitDrag|implicit_drag|solves_drag", "kImplicitViscosity"),
    (r"\bpair_drag|\brow_drag", "pair_viscosity, row_viscosity"),
    (r"grow_older|settled_packing|kSettlesAs", "rest density, relaxation time"),
    (r"\bSixes\b|\bsixes\.h", "Vector6"),
    (r"\bGrave\b", "Tombstone"),
]
PHRASES = [
    (r"jostl(?:e|es|ed|ing)?", "velocity fluctuations; what damps them is artificial viscosity"),
    (r"walls? (?:that|which) holds?", "no-slip walls"),
    (r"walls? (?:that|which) slips?", "free-slip walls"),
    (r"(?:drag|viscosity) (?:that |which )?(?:is|was|are) solved for", "implicit viscosity"),
    (r"pressures? (?:that |which )?(?:is|was|are|were) solved for|pressures solved for", "pressure projection"),
    (r"solves? (?:the |for )?drag", "implicit viscosity"),
    (r"drag between (?:fluid )?particles|drag on fluctuations?", "viscous pair force, artificial viscosity"),
    (r"who presses", "pressure pairs"),
    (r"who drags whom", "viscous pairs"),
    (r"turns? nothing", "exerts no net torque"),
    (r"(?:be|is|are) turned round|too flat to be turned", "inverse; reversed; near singular"),
    (r"turn after turn|turns of (?:a |the )?(?:solver?|conjugate|gauss)\w*|solver?'?s? turns|\d turns at most",
     "iterations"),
    (r"gr[eo]ws? older|growing older", "relaxation time"),
    (r"whole volumes?|thinner rest", "particle volume from rest density"),
    (r"walls?['’]?s? guards?", "penetration clamp"),
    (r"hands?['’]?s? guards?", "passivity controller"),
    (r"(?:walls?['’]s?|boundary|wall) sheets?|sheets? of (?:wall |boundary )?particles", "boundary particle layer"),
    (r"host['’]s (?:newest |last )?word|word of the host|newest word of", "state update"),
    (r"(?:take|taken|takes|taking|took) hold anew|engages? anew", "re-engage"),
    (r"(?:holds?|couplings?|hands?) (?:that )?(?:is|are|was|were|being) (?:not )?let in|being let in", "engagement ramp"),
    (r"believed wholly|states .{0,20}are believed", "fresh, used"),
    (r"(?:hears?|heard) us", "receives"),
    (r"(?:in )?calm fluid|in calm", "fluid at rest, quiet time"),
    (r"unrest", "disturbance"),
    (r"(?:the same )?to the bit", "bitwise identical"),
]
WORD = re.compile("|".join(f"({pattern})" for pattern, _ in IDENTIFIERS))
PHRASE = re.compile(r"\b(?:" + "|".join(f"({pattern})" for pattern, _ in PHRASES) + r")\b", re.IGNORECASE)


def faults_in(path, lines):
    """Of all lines joined by spaces, without what marks a comment, so that a phrase may be broken anywhere."""
    starts, parts, at = [], [], 0
    for line in lines:
        part = LINE_START.sub("", NOTEBOOK_PAGE.sub("", line)).rstrip()
        starts.append(at)
        parts.append(part)
        at += len(part) + 1
    text = " ".join(parts)
    found = [(bisect.bisect_right(starts, match.start()), match.group(), rules[match.lastindex - 1][1])
             for rule, rules in ((WORD, IDENTIFIERS), (PHRASE, PHRASES)) for match in rule.finditer(text)]
    return [f"{path}:{number}: '{word}': write '{write}'." for number, word, write in sorted(found)]


def main():
    root = sys.argv[1] if len(sys.argv) > 1 else "."
    faults, count = [], 0
    for path in tree.files(root, ENDINGS, NAMES):
        if path.startswith(EXEMPT):
            continue
        with open(os.path.join(root, path), encoding="utf-8", errors="replace") as file:
            faults += faults_in(path, file.read().splitlines())
        count += 1
    print("\n".join(faults + [f"{count} files, {len(faults)} faults"]))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
