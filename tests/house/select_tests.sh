#!/usr/bin/env bash
# Which tests of a build ./slosh test runs: all but those that the file left_out names for its preset.
# Prints the options for ctest, one a line: those that were given, and what excludes the tests that are left out.
# Usage: select_tests.sh BUILD_DIR PRESET LEFT_OUT [CTEST OPTIONS…]
#   LEFT_OUT gets lines "COUNT of WHICH: reason", counted among the tests that the options choose.
set -euo pipefail
build=${1:?usage: select_tests.sh BUILD_DIR PRESET LEFT_OUT [CTEST OPTIONS...]}
preset=${2:?usage: select_tests.sh BUILD_DIR PRESET LEFT_OUT [CTEST OPTIONS...]}
left_out=${3:?usage: select_tests.sh BUILD_DIR PRESET LEFT_OUT [CTEST OPTIONS...]}
shift 3
list=${SLOSH_LEFT_OUT_LIST:-$(dirname "$(readlink -f "$0")")/left_out}

# ctest knows one -E alone: the caller's goes together with ours.
options=()
excluded=""
while (($# > 0)); do
  case "$1" in
    -E | --exclude-regex) excluded=${2:-}; shift $(($# < 2 ? 1 : 2)); continue ;;
    *) options+=("$1") ;;
  esac
  shift
done
names() {
  ctest --test-dir "$build" -N "$@" ${excluded:+-E "$excluded"} 2>/dev/null |
    sed -nE 's/^ *Test +#[0-9]+: (.*)$/\1/p' | sed 's/ (Disabled)$//' | sort
}

: >"$left_out"
chosen=$(names ${options[@]+"${options[@]}"})
gone=""  # named already by a line above
all_labels=""
all_names=$excluded
while IFS='|' read -r for_preset kind rest; do
  for_preset=${for_preset//[[:space:]]/}
  kind=${kind//[[:space:]]/}
  [[ -n $for_preset && $for_preset != \#* && $for_preset == "$preset" ]] || continue
  # The pattern may hold a |, which stands without blanks there.
  pattern=$(sed -E 's/^ *//; s/ \| .*$//' <<<"$rest")
  reason=$(sed -E 's/^.* \| //' <<<"$rest")
  case "$kind" in
    label)
      which=$(names -L "^($pattern)\$")
      all_labels+=${all_labels:+|}$pattern
      ;;
    name)
      which=$(grep -E "^($pattern)\$" <<<"$chosen" || true)
      all_names+=${all_names:+|}"^($pattern)\$"
      ;;
    *) echo "select_tests.sh: '$kind' in $list is neither label nor name" >&2; exit 2 ;;
  esac
  which=$(comm -12 <(printf '%s\n' "$chosen") <(printf '%s\n' "$which") | grep . | comm -23 - <(printf '%s\n' "$gone") || true)
  [[ -n $which ]] || continue
  gone=$(printf '%s\n%s\n' "$gone" "$which" | sort)
  printf '%d of %s: %s\n' "$(wc -l <<<"$which")" "$pattern" "$reason" >>"$left_out"
done <"$list"

((${#options[@]} == 0)) || printf '%s\n' "${options[@]}"
[[ -z $all_labels ]] || printf '%s\n' -LE "^($all_labels)\$"
[[ -z $all_names ]] || printf '%s\n' -E "$all_names"
