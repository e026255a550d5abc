#!/usr/bin/env bash
# Every hostile program of a build, SECONDS each (600), one after the other. Prints what they print, and a closing line;
# fails when there is a finding. What happened is kept in BUILD/hostile.
# Usage: run.sh BUILD_DIR [SECONDS] [--seed N] [NAME...]
set -euo pipefail
build="${1:?usage: run.sh BUILD_DIR [SECONDS] [--seed N] [NAME...]}"
shift
seconds=600
seed=$((RANDOM * 32768 + RANDOM))
names=()
while (($# > 0)); do
  case "$1" in
    --seed) seed="${2:?run.sh: --seed needs a number}"; shift ;;
    --seed=*) seed="${1#*=}" ;;
    [0-9]*) seconds="$1" ;;
    *) names+=("$1") ;;
  esac
  shift
done
[[ "$seconds" =~ ^[1-9][0-9]*$ ]] || { echo "run.sh: '$seconds' is no number of seconds" >&2; exit 2; }
[[ "$seed" =~ ^[0-9]+$ ]] || { echo "run.sh: '$seed' is no seed" >&2; exit 2; }

# No message makes anybody ask for so much at once; the largest that is right is a stream's buffer, 80 MiB.
export ASAN_OPTIONS="max_allocation_size_mb=512${ASAN_OPTIONS:+:$ASAN_OPTIONS}"

ran=0
bad=0
# run NAME PROGRAM ARGUMENTS…
run() {
  local name="$1" program="$build/bin/$2"
  shift 2
  ((${#names[@]} == 0)) || [[ " ${names[*]} " == *" $name "* ]] || return 0
  [[ -x "$program" ]] || return 0
  echo "== $name, $seconds s, seed $seed"
  ran=$((ran + 1))
  "$program" "$@" --seconds "$seconds" --seed "$seed" || bad=$((bad + 1))
}
run peers hostile_peers --folder "$build/hostile/peers"
run host hostile_host --folder "$build/hostile/host"
# The same with ends that speak QUIC as nobody should, frame by frame (tests/net/quic).
run quic_host quic_storm host
run quic_peer quic_storm peer
((ran > 0)) || { echo "run.sh: no hostile programs in $build/bin: build the target hostile" >&2; exit 2; }
echo "$((ran - bad)) hostile runs without a finding, $bad with"
((bad == 0))
