#!/usr/bin/env bash
# What `slosh check` says of exports that Blender made: broken_exports.py makes them and says what has to be found.
# Usage: run.sh BUILD
set -euo pipefail
build=${1:?usage: run.sh BUILD}
here="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT

if ! blender --background --factory-startup --python-exit-code 1 --python "$here/broken_exports.py" -- "$folder" \
  >"$folder/blender.log" 2>&1; then
  tail -20 "$folder/blender.log" >&2
  echo "blender could not make the exports" >&2
  exit 1
fi

passed=0 failed=0
while read -r name kind words; do
  code=0
  said="$("$build/bin/slosh" check "$folder/$name.glb" --json 2>/dev/null)" || code=$?
  wrong=""
  case "$kind" in
    none)
      ((code == 0)) || wrong="exit code $code"
      grep -q '"kind"' <<<"$said" && wrong="there is nothing to find"
      ;;
    error) ((code == 1)) || wrong="exit code $code in place of 1" ;;
  esac
  [[ "$kind" == none ]] || grep -qF "\"kind\": \"$kind\"" <<<"$said" || wrong="no finding of kind $kind"
  [[ -z "$words" ]] || grep -qF -- "$words" <<<"$said" || wrong="nothing about '$words'"
  if [[ -n "$wrong" ]]; then
    failed=$((failed + 1))
    printf '%s: %s\n%s\n' "$name" "$wrong" "$said"
  else
    passed=$((passed + 1))
  fi
done <"$folder/expected.txt"
echo "$passed passed, $failed failed"
((failed == 0 && passed >= 20))
