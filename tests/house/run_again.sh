#!/usr/bin/env bash
# Runs the few tests that failed in a run of CTest once more, one after another with nothing beside them: a test of real
# programs on a real clock may fail because the machine was busy with another test. A crash is nothing of the kind, and
# neither are many failures: then nothing is run again. What passes now is named in the closing line (closing_line.sh).
# Usage: run_again.sh BUILD_DIR SAID AGAIN
#   SAID   what ctest wrote
#   AGAIN  gets what ctest writes now; empty when nothing is run again
# Exit status: 0 when all of them pass now.
set -euo pipefail
build=${1:?usage: run_again.sh BUILD_DIR SAID AGAIN}
said=${2:?usage: run_again.sh BUILD_DIR SAID AGAIN}
again=${3:?usage: run_again.sh BUILD_DIR SAID AGAIN}
most=5

: >"$again"
failed=$(sed -nE 's/^[[:space:]]+[0-9]+ - (.*) \((Failed|Timeout)\).*$/\1/p' "$said")
count=$(grep -c . <<<"$failed" || true)
total=$(sed -nE 's/.*tests passed, ([0-9]+) tests? failed out of.*/\1/p' "$said")
((count > 0 && count <= most && count == ${total:-0})) || exit 1

printf '\nOnce more, with nothing beside it: %s\n' "${failed//$'\n'/, }"
log="$build/Testing/Temporary/LastTest.log"
cp "$log" "$log.first"
code=0
# An exact list of names: --rerun-failed would take the numbers of a run with other options.
pattern=$(sed -E 's/[][\.^$*+?(){}|/]/\\&/g' <<<"$failed" | paste -sd'|')
ctest --test-dir "$build" --output-on-failure --no-tests=error --no-label-summary -j 1 -R "^($pattern)\$" 2>&1 |
  tee "$again" || code=$?
mv "$log.first" "$log"  # it has why tests were skipped
exit "$code"
