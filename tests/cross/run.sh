#!/usr/bin/env bash
# CUDA against the CPU, for memory errors and races, then what a step costs. Run by `./slosh test --preset gpu`.
# Usage: run.sh BUILD_FOLDER [PARTICLES...]
set -uo pipefail
bin="$1/bin"
shift
counts=("$@")
((${#counts[@]} > 0)) || counts=(33000 108000 1000000 4130000)
log="$(mktemp)"
trap 'rm -f "$log"' EXIT
passed=0 failed=0

check() {
  local name="$1"
  shift
  printf '%-50s' "$name"
  local begun=$SECONDS
  if "$@" > "$log" 2>&1; then
    passed=$((passed + 1))
    printf 'passed, %d s\n' $((SECONDS - begun))
  else
    failed=$((failed + 1))
    printf 'FAILED\n'
    grep -E 'FAILED|=========' "$log" | head -20
    tail -3 "$log"
  fi
}

nvidia-smi --query-gpu=name,driver_version,memory.total --format=csv,noheader
check 'functions, GPU and CPU (cross_math)' "$bin/cross_math"
check 'worlds, GPU and CPU (cross_world)' "$bin/cross_world"
sanitizer="$(command -v compute-sanitizer || command -v /usr/local/cuda/bin/compute-sanitizer)"
if [[ -n "$sanitizer" ]]; then
  for tool in memcheck racecheck; do
    check "$tool (compute-sanitizer, cross_world quick)" "$sanitizer" --error-exitcode 1 --tool "$tool" \
      "$bin/cross_world" quick
  done
else
  echo 'memcheck and racecheck: left out, as compute-sanitizer is not installed (it comes with the CUDA toolkit)'
fi

printf '\nA step of a pool at rest\n%-16s %10s %10s %18s %10s\n' model particles ms 'particle steps/s' 'real time'
for model in corrected paper incompressible; do
  # "CUDA, NVIDIA …",model,"at rest",fluid particles,body particles,ms simulated,ms,…
  "$bin/bench_cuda" "$model" cuda "${counts[@]}" |
    awk -F, -v model="$model" '$2 ~ /NVIDIA/ {printf "%-16s %10d %10.3f %18.3g %9.2fx\n", model, $5, $8, 1000 * $5 / $8, $7 / $8}' ||
    failed=$((failed + 1))
done
printf '\n%d passed, %d failed\n' "$passed" "$failed"
((failed == 0))
