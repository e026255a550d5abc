#!/usr/bin/env bash
# Runs every libFuzzer target of a build made with the preset `fuzz`, SECONDS each (60), from its seeds and
# from what earlier runs of this build kept. Prints a line a target; fails when there is a finding.
# Usage: run.sh BUILD_DIR [SECONDS] [NAME...]
set -euo pipefail
here="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
build="${1:?usage: run.sh BUILD_DIR [SECONDS] [NAME...]}"
seconds="${2:-60}"
[[ "$seconds" =~ ^[1-9][0-9]*$ ]] || { echo "run.sh: '$seconds' is no number of seconds" >&2; exit 2; }
shift $(($# < 2 ? $# : 2))

programs=()
for program in "$build"/bin/fuzz_*; do
  [[ -x "$program" && -f "$program" ]] || continue
  name="${program##*/fuzz_}"
  (($# == 0)) || [[ " $* " == *" $name "* ]] || continue
  programs+=("$program")
done
((${#programs[@]} > 0)) || { echo "run.sh: no fuzz targets in $build/bin: build the preset fuzz" >&2; exit 2; }

findings=0
for program in "${programs[@]}"; do
  name="${program##*/fuzz_}"
  corpus="$build/fuzz/$name/corpus"
  found="$build/fuzz/$name/findings"
  log="$build/fuzz/$name/log"
  mkdir -p "$corpus" "$found"
  "$program" "--write-seeds=$corpus"
  folders=("$corpus")
  [[ -d "$here/seeds/$name" ]] && folders+=("$here/seeds/$name")
  code=0
  "$program" "${folders[@]}" -max_total_time="$seconds" -max_len=65536 -timeout=10 -rss_limit_mb=2048 \
    -malloc_limit_mb=512 -print_final_stats=1 "-artifact_prefix=$found/" >"$log" 2>&1 || code=$?
  runs="$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")"
  cover="$(grep -oE 'cov: [0-9]+' "$log" | tail -n 1 || true)"
  if ((code == 0)); then
    printf '%-18s %10s inputs, %s, no finding\n' "$name" "${runs:-?}" "${cover:-cov: ?}"
  else
    findings=$((findings + 1))
    printf '%-18s FINDING: see %s and %s\n' "$name" "$log" "$found"
    grep -m 3 -E 'ERROR|runtime error|does not hold|SUMMARY' "$log" || tail -n 5 "$log"
  fi
done
((findings == 0)) || exit 1
