#!/usr/bin/env bash
# clang-tidy with the repository's .clang-tidy, one file after the other. Exits 1 if there is a finding.
# Usage: tidy.sh BUILD_DIR [FILES…]. BUILD_DIR is a configured build: the presets write the compile_commands.json
# that is needed. Without FILES: every .cpp that is part of that build and of the repository.
set -euo pipefail
build=${1:?usage: tidy.sh BUILD_DIR [FILES...]}
shift
root=$(dirname "$(readlink -f "$0")")/../..
root=$(readlink -f "$root")
commands=$(readlink -m "$build/compile_commands.json")
if [ ! -r "$commands" ]; then
  echo "There is no $commands: configure with a preset, or with -DCMAKE_EXPORT_COMPILE_COMMANDS=ON." >&2
  exit 2
fi
tool=$(command -v clang-tidy-19 || command -v clang-tidy || true)
if [ -z "$tool" ]; then
  echo "This needs clang-tidy: apt-get install clang-tidy-19 (or clang-tidy)." >&2
  exit 2
fi

files=("$@")
if [ "${#files[@]}" -eq 0 ]; then
  mapfile -t files < <(cd "$root" && git ls-files '*.cpp' | while IFS= read -r file; do
    if grep -qF "\"$root/$file\"" "$commands"; then printf '%s\n' "$root/$file"; fi
  done)
fi

# GCC's options that clang does not know are no finding. A header that many sources include is reported once.
findings=$(mktemp)
trap 'rm -f "$findings"' EXIT
failed=0
for file in "${files[@]}"; do
  "$tool" --quiet -p "$(dirname "$commands")" --extra-arg=-Wno-unknown-warning-option "$file" 2>/dev/null |
    tee -a "$findings" || failed=1
done
found=$({ grep -E '^/.*: (warning|error): ' "$findings" || true; } | sort -u | wc -l)
echo "${#files[@]} files, $found findings"
[ "$found" -eq 0 ] && [ "$failed" -eq 0 ]
