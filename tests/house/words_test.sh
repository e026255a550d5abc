#!/usr/bin/env bash
# words.py finds what it is there for: invented words are planted in a small tree, one at a time, and each must be named
# with its file, its line and the field's word. Usage: words_test.sh ROOT
set -euo pipefail
root=$(readlink -f "${1:?usage: words_test.sh ROOT}")
check=$root/tests/house/words.py
copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT

mkdir -p "$copy/sim" "$copy/tests/notebook" "$copy/tests/bench/results" "$copy/build"
cd "$copy"
missed=0
planted=0
# expect FILE TEXT SAID: with that behind FILE the check fails, and says SAID of the first line added.
expect() {
  local said line
  sound
  line=$(($(wc -l <"$1") + 1))
  printf '%b\n' "$2" >>"$1"
  planted=$((planted + 1))
  if said=$(python3 "$check" . 2>&1); then
    echo "no fault was found for: $2" >&2
    missed=$((missed + 1))
  elif ! grep -qF -- "$1:$line: $3" <<<"$said"; then
    printf 'not found: %s:%s: %s\nbut:\n%s\n' "$1" "$line" "$3" "$said" >&2
    missed=$((missed + 1))
  fi
}
# Words that are the field's, or stand where all may stay.
sound() {
  printf '// Walls that leak hold nothing. A hand turns.\nconstexpr int kMaxIterations = 4, kAlmostAll = 3;\n' >sim/step.cpp
  printf '# sim\n\nNo-slip walls; [rest](../tests/notebook/2026-11-27-thinner-rest-density.md).\n' >sim/README.md
  printf '# Walls that hold\n\nDrag on jostling.\n' >tests/notebook/2026-11-28-topic.md
  printf 'case,pressures are solved for\n' >tests/bench/results/one.csv
  printf 'jostling\n' >build/left.txt
  printf '| not | jostling |\n' >GLOSSARY.md
}

sound
python3 "$check" . >/dev/null || { python3 "$check" . >&2; echo "a sound tree has faults" >&2; exit 1; }

expect sim/step.cpp 'constexpr int kMostTurns = 3;' "'kMostTurns': write 'kMax…'"
expect sim/step.cpp 'constexpr int kLeastSpan = 3;' "'kLeastSpan': write 'kMin…'"
expect sim/step.cpp 'struct TurnedMoment {};' "'TurnedMoment': write 'InverseMoment'"
expect sim/step.cpp 'void hear(const HostWord& word);' "'HostWord': write 'HostUpdate'"
expect sim/step.cpp 'class HostReins;' "'HostReins': write 'SupervisorControl'"
expect sim/step.cpp 'class FeltHand;' "'FeltHand': write 'ForceRendering'"
expect sim/step.cpp 'struct WorldBelief;' "'WorldBelief': write 'StateFreshness'"
expect sim/step.cpp 'class LentDevice;' "'LentDevice': write 'SharedHandleDevice'"
expect sim/step.cpp 'std::vector<SheetParticle> all;' "'SheetParticle': write 'LayerParticle'"
expect sim/step.cpp '  // What jostling needs.' "'jostling': write 'velocity fluctuations"
expect sim/step.cpp '/// Along walls that\n/// hold.' "'walls that hold': write 'no-slip walls'"
expect sim/README.md 'Beside walls that slip.' "'walls that slip': write 'free-slip walls'"
expect sim/README.md 'The same to\nthe bit.' "'The same to the bit': write 'bitwise identical'"
expect sim/step.cpp 'say("drag that is solved for");' "'drag that is solved for': write 'implicit viscosity'"
expect sim/step.cpp '// Where pressures are solved for.' "'pressures are solved for': write 'pressure projection'"
expect sim/step.cpp '// Who presses on whom.' "'Who presses': write 'pressure pairs'"
expect sim/step.cpp '// Fluid grows older.' "'grows older': write 'relaxation time'"
expect sim/step.cpp '// The pair turns nothing.' "'turns nothing': write 'exerts no net torque'"
expect sim/step.cpp '// A hand that is let in.' "'hand that is let in': write 'engagement ramp'"
expect sim/step.cpp '// It takes hold anew.' "'takes hold anew': write 're-engage'"
expect sim/step.cpp "// The host's word on the body." "'host's word': write 'state update'"
expect sim/README.md "The walls' guard." "'walls' guard': write 'penetration clamp'"
expect sim/README.md 'Too flat to be turned round.' "'Too flat to be turned': write 'inverse"

((missed == 0)) || exit 1
echo "$planted planted words found."
