#!/usr/bin/env bash
# The closing line of ./slosh test adds up, with tests that pass, fail and are skipped with and without a reason.
# Usage: closing_line_test.sh CTEST. Runs that ctest on a few tests of its own.
set -euo pipefail
ctest=${1:?usage: closing_line_test.sh CTEST}
here=$(dirname "$(readlink -f "$0")")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
cat >CTestTestfile.cmake <<'END'
add_test(Good.One true)
add_test("Good.Two" true)
add_test(Bad.One false)
add_test(No.IPv6 printf "[ RUN      ] No.IPv6\n/a/file.cpp:7: Skipped\nno IPv6 here: %s\n\n[  SKIPPED ] No.IPv6 (0 ms)\n" "Cannot assign")
set_tests_properties(No.IPv6 PROPERTIES SKIP_REGULAR_EXPRESSION "\\[  SKIPPED \\]")
add_test(No.Word printf "/a/file.cpp:7: Skipped\n[  SKIPPED ] No.Word (0 ms)\n")
set_tests_properties(No.Word PROPERTIES SKIP_REGULAR_EXPRESSION "\\[  SKIPPED \\]")
add_test(No.Script sh -c "echo 'skipped: no such program here'; exit 77")
set_tests_properties(No.Script PROPERTIES SKIP_RETURN_CODE 77)
END
unset CTEST_PARALLEL_LEVEL CTEST_OUTPUT_ON_FAILURE

# expect WORDS LEFT_OUT CTEST OPTIONS…
expect() {
  local wanted=$1 left_out=$2 found
  shift 2
  "$ctest" "$@" >said 2>&1 || true
  found=$("$here/closing_line.sh" said Testing/Temporary/LastTest.log "$left_out")
  [[ "$found" == "$wanted" ]] || {
    printf 'expected:\n%s\nfound:\n%s\nof:\n' "$wanted" "$found" >&2
    cat said >&2
    exit 1
  }
}
printf '41 of physics: too slow\n2 of stability: the same\n' >left_out
expect "2 passed, 0 failed" /dev/null -R Good
expect "skipped No.IPv6: no IPv6 here: Cannot assign
skipped No.Word: it does not say why
skipped No.Script: no such program here
2 passed, 1 failed, 3 skipped" /dev/null
expect "skipped No.Script: no such program here
skipped 41 of physics: too slow
skipped 2 of stability: the same
0 passed, 0 failed, 44 skipped" left_out -R Script
expect "" /dev/null -R NothingOfThatName

# A few that failed are run once more, alone; what passes then is named, what fails again or crashes still fails.
cat >CTestTestfile.cmake <<'END'
add_test(Good.One true)
add_test(No.Word printf "/a/file.cpp:7: Skipped\nnot here\n[  SKIPPED ] No.Word (0 ms)\n")
set_tests_properties(No.Word PROPERTIES SKIP_REGULAR_EXPRESSION "\\[  SKIPPED \\]")
add_test(Busy/Flaky.One/0 sh -c "test -e once || { touch once; exit 1; }")
END
# again WORDS STATUS
again() {
  local found status=0
  "$ctest" >said 2>&1 || true
  PATH="$(dirname "$ctest"):$PATH" "$here/run_again.sh" . said again >/dev/null || status=$?
  found=$("$here/closing_line.sh" said Testing/Temporary/LastTest.log /dev/null again)
  [[ "$found" == "$1" && $((status == 0)) == "$2" ]] || {
    printf 'expected:\n%s\nfound, with status %d:\n%s\n' "$1" "$status" "$found" >&2
    exit 1
  }
}
again "passed only when it was run again, alone: Busy/Flaky.One/0
skipped No.Word: not here
2 passed, 0 failed, 1 skipped" 1
echo 'add_test(Bad.One false)' >>CTestTestfile.cmake
rm once
again "passed only when it was run again, alone: Busy/Flaky.One/0
skipped No.Word: not here
2 passed, 1 failed, 1 skipped" 0
echo 'add_test(Bad.Crash sh -c "kill -SEGV $$")' >>CTestTestfile.cmake
rm once
again "skipped No.Word: not here
1 passed, 3 failed, 1 skipped" 0

# What a list leaves out for a preset is excluded, and counted once among those that were chosen.
cat >list <<'END'
# a comment
here | label | slow|odd | on one thread
here | name  | Good\.(One|Two)|Odd\.One | draws
there | name | .* | not of this preset
END
cat >CTestTestfile.cmake <<'END'
add_test(Good.One true)
add_test(Good.Three true)
add_test(Slow.One true)
add_test(Slow.Two true)
add_test(Odd.One true)
set_tests_properties(Slow.One Slow.Two PROPERTIES LABELS slow)
set_tests_properties(Odd.One PROPERTIES LABELS odd)
END
# choose WORDS LEFT_OUT PRESET CTEST OPTIONS…
choose() {
  local wanted=$1 wanted_out=$2 preset=$3 found options=()
  shift 3
  mapfile -t options < <(PATH="$(dirname "$ctest"):$PATH" SLOSH_LEFT_OUT_LIST=$PWD/list \
    "$here/select_tests.sh" "$PWD" "$preset" left_out "$@")
  found=$("$ctest" -N "${options[@]}" | sed -nE 's/^ *Test +#[0-9]+: (.*)$/\1/p' | tr '\n' ' ')
  [[ "$found" == "$wanted" && "$(<left_out)" == "$wanted_out" ]] || {
    printf 'expected: %s\n%s\nfound: %s\n%s\n' "$wanted" "$wanted_out" "$found" "$(<left_out)" >&2
    exit 1
  }
}
choose "Good.Three " "3 of slow|odd: on one thread
1 of Good\.(One|Two)|Odd\.One: draws" here
choose "" "1 of slow|odd: on one thread" here -R Slow.One
choose "" "1 of Good\.(One|Two)|Odd\.One: draws" here -E 'Three|Slow|Odd'
choose "Good.One Good.Three Slow.One Slow.Two Odd.One " "" release
echo "The closing line adds up, and what is left out is counted."
