#!/usr/bin/env bash
# pages.py finds what it is there for: faults are planted in a copy of the pages, one of each kind, and each must be
# named with its page. Usage: pages_test.sh ROOT
set -euo pipefail
root=$(readlink -f "${1:?usage: pages_test.sh ROOT}")
check=$root/tests/house/pages.py
copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT

mkdir -p "$copy/room" "$copy/tests/notebook" "$copy/sim"
cd "$copy"
missed=0
# expect WHAT: the check fails, and says this.
expect() {
  local said
  if said=$(python3 "$check" . 2>&1); then
    echo "no fault was found for: $1" >&2
    missed=$((missed + 1))
  elif ! grep -qF -- "$1" <<<"$said"; then
    printf 'not found: %s\nbut:\n%s\n' "$1" "$said" >&2
    missed=$((missed + 1))
  fi
}
sound() {
  rm -f room/*.md tests/notebook/*.md sim/*
  printf '# A room\n\nWhat it is for. [Its other page](OTHER.md#one-part), and one\n[that](../room) is a folder.\n' >room/README.md
  printf '# Other\n\n## One part\n' >room/OTHER.md
  printf '# Title\n\n## Question\n\n## Command\n\n## Result\n\n## Verdict\n' >tests/notebook/2026-11-28-topic.md
  printf 'void step();\n' >sim/step.h
  { for n in {1..15}; do printf '| Eq %s | `step` in [step.h](step.h) |\n' "$n"; done
    printf '| Alg 1 | `step` in [step.h](step.h) |\n| Alg 2 | `step` in [step.h](step.h) |\n'; } >sim/EQUATIONS.md
}

sound
python3 "$check" . >/dev/null || { python3 "$check" . >&2; echo "sound pages have faults" >&2; exit 1; }

printf 'A line.\n%.0s' {1..121} >>room/README.md
expect 'room/README.md:121: 125 lines'
sound
printf '%0130d\n' 0 >>room/README.md
expect 'room/README.md:5: 130 columns'
sound
echo 'Measured on 23 November 2026.' >>room/README.md
expect 'room/README.md:5: the date 23 November 2026'
sound
echo 'Of 2026-11-23.' >>room/README.md
expect 'room/README.md:5: the date 2026-11-23'
sound
echo '[gone](NOWHERE.md)' >>room/OTHER.md
expect 'room/OTHER.md:4: the link to NOWHERE.md is dead'
sound
echo '[gone](OTHER.md#another-part)' >>room/README.md
expect 'room/README.md:5: OTHER.md has no heading for #another-part'
sound
sed -i 's/## Verdict/## Outcome/' tests/notebook/2026-11-28-topic.md
expect 'tests/notebook/2026-11-28-topic.md:1: the headings'
sound
mv tests/notebook/2026-11-28-topic.md tests/notebook/topic.md
expect 'tests/notebook/topic.md:1: the name'
sound
sed -i 's/`step` in/`stride` in/' sim/EQUATIONS.md
expect 'sim/EQUATIONS.md:1: stride is not in step.h'
sound
sed -i '/Eq 7 /d' sim/EQUATIONS.md
expect 'sim/EQUATIONS.md:1: no row for Eq 7'

((missed == 0)) || exit 1
echo "10 planted faults found."
