#!/usr/bin/env bash
# What a run of CTest came to: each test that was skipped with its reason, and the closing line
#   N passed, N failed[, N skipped]
# CTest itself counts what is skipped as passed. A test that passed only when it was run again is named before it.
# Usage: closing_line.sh SAID LOG [LEFT_OUT [AGAIN]]
#   SAID      what ctest wrote
#   LOG       Testing/Temporary/LastTest.log of the build
#   LEFT_OUT  lines "COUNT WHAT: reason" of tests that were not run at all (select_tests.sh); they count as skipped
#   AGAIN     what ctest wrote when it ran those that had failed once more (run_again.sh); empty: it did not
set -euo pipefail
said=${1:?usage: closing_line.sh SAID LOG [LEFT_OUT]}
log=${2:?usage: closing_line.sh SAID LOG [LEFT_OUT]}
left_out=${3:-/dev/null}
again=${4:-/dev/null}

totals=$(grep -E 'tests passed, [0-9]+ tests? failed out of [0-9]+' "$said" || true)
[[ -n $totals ]] || exit 0  # nothing was run: ctest has said why
failed=$(sed -E 's/.*, ([0-9]+) tests? failed.*/\1/' <<<"$totals")
total=$(sed -E 's/.*out of ([0-9]+).*/\1/' <<<"$totals")
skipped=$(sed -nE 's/^[[:space:]]+[0-9]+ - (.*) \(Skipped\)[[:space:]]*$/\1/p' "$said")

# The reason stands in what the test wrote: GoogleTest's lines after "FILE:LINE: Skipped", a script's "skipped: WHY".
reason_of() {
  awk -v name="$1" '
    /^[0-9]+\/[0-9]+ Test: / { here = substr($0, index($0, "Test: ") + 6) == name; wrote = 0; next }
    /^Output:$/ { wrote = 1; next }
    !here || !wrote { next }
    /^skipped: / { why = substr($0, 10) }
    /^\[  SKIPPED \]/ { reading = 0 }
    reading && $0 != "" { why = why (why == "" ? "" : " ") $0 }
    /: Skipped$/ { reading = 1 }
    END { print why == "" ? "it does not say why" : why }' "$log"
}

# Those that failed, of what ctest wrote.
failures_of() { sed -nE 's/^[[:space:]]+[0-9]+ - (.*) \((Failed|Timeout)\).*$/\1/p' "$1" | sort; }
if [[ -s $again ]]; then
  while IFS= read -r name; do
    [[ -n $name ]] || continue
    failed=$((failed - 1))
    printf 'passed only when it was run again, alone: %s\n' "$name"
  done < <(comm -23 <(failures_of "$said") <(failures_of "$again"))
fi

count=0
while IFS= read -r name; do
  [[ -n $name ]] || continue
  count=$((count + 1))
  printf 'skipped %s: %s\n' "$name" "$(reason_of "$name")"
done <<<"$skipped"
ran=$((total - failed - count))
while read -r many what; do
  count=$((count + many))
  printf 'skipped %s\n' "$many $what"
done <"$left_out"

printf '%d passed, %d failed' "$ran" "$failed"
((count == 0)) || printf ', %d skipped' "$count"
printf '\n'
