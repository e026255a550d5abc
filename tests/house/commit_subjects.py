#!/usr/bin/env python3
"""Subjects of commits: at most 72 characters, one line of its own. Usage: commit_subjects.py [ROOT]. Exits 1 on faults.

It looks at commits since SINCE, merges left out; older ones are as they are. Without a history (a tarball, a shallow
clone, no git) it exits 77: skipped.
"""
import subprocess
import sys

MAX_CHARACTERS = 72
SINCE = "2026-11-28T15:16:00+00:00"
SKIPPED = 77


def git(root, *arguments):
    """What git says, or None where it fails or is not there."""
    try:
        said = subprocess.run(["git", "-C", root, *arguments], capture_output=True, encoding="utf-8", errors="replace",
                              check=False)
    except OSError:
        return None
    return said.stdout if said.returncode == 0 else None


def main():
    root = sys.argv[1] if len(sys.argv) > 1 else "."
    top, shallow = git(root, "rev-parse", "--show-prefix"), git(root, "rev-parse", "--is-shallow-repository")
    # A tree that was unpacked within another repository has a prefix.
    if top is None or top.strip() or (shallow or "true").strip() == "true":
        print("no whole history here: skipped")
        return SKIPPED
    log = git(root, "log", "--no-merges", f"--since={SINCE}", "--format=%h%x09%s")
    if log is None:
        print("no commits here: skipped")
        return SKIPPED
    faults, count = [], 0
    for line in log.splitlines():
        commit, _, subject = line.partition("\t")
        count += 1
        if len(subject) > MAX_CHARACTERS:
            faults.append(f"{commit}: the subject has {len(subject)} characters; {MAX_CHARACTERS} are allowed. Say one "
                          f"thought, the rest in the body: {subject}")
        elif not subject.strip():
            faults.append(f"{commit}: no subject. Say in one line what the commit does.")
    print("\n".join(faults + [f"{count} commits, {len(faults)} faults"]))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
