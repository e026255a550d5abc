#!/usr/bin/env bash
# Who may include whom: the rules of the house, checked on every #include of the tree.
# Usage: include_rules.sh ROOT. Prints each breach as file:line and exits 1 if there is one.
set -euo pipefail
root=${1:?usage: include_rules.sh ROOT}
cd "$root"

breaches=0
# room, what its includes of other rooms may look like (extended regular expression)
check_room() {
  local room=$1 allowed=$2
  while IFS= read -r hit; do
    echo "$hit"
    breaches=$((breaches + 1))
  done < <(grep -rnE --include='*.h' --include='*.cpp' --include='*.cu' \
             '^#include "(scenes|sim|net|host|peer|render|tests)/' "$room" |
           grep -vE "#include \"($room/|$allowed)" || true)
}

check_room scenes 'sim/math/'
check_room sim 'scenes/scene\.h"'
check_room net 'sim/snapshot\.h"|sim/math/|scenes/scene\.h"'
check_room host 'scenes/|sim/|net/'
check_room peer 'scenes/|sim/|net/|render/|host/'
check_room render 'sim/math/'

# Toolkits that belong in one place.
check_toolkit() {
  local pattern=$1 why=$2
  shift 2
  while IFS= read -r hit; do
    echo "$hit  ($why)"
    breaches=$((breaches + 1))
  done < <(grep -rnE --include='*.h' --include='*.cpp' --include='*.cu' "$pattern" "$@" || true)
}

# tests/cross compares the two backends, and so may see both.
mapfile -t tests_but_cross < <(find tests -mindepth 1 -maxdepth 1 -type d ! -name cross)
check_toolkit '#include <(cuda|cub/|thrust/)' 'CUDA only in sim/cuda' scenes net host peer render sim/cpu sim/math sim/*.h sim/*.cpp "${tests_but_cross[@]}"
check_toolkit '#include "sim/cuda/' 'only the factory in sim/particle_engine.cpp knows the CUDA engine' scenes net host peer render sim/cpu sim/math sim/*.h "${tests_but_cross[@]}"
check_toolkit '#include <(epoxy|GL|EGL|GLFW)/' 'GL only in render' scenes sim net host peer
check_toolkit '#include "host/' 'only the program that joins host and peer includes host' peer/haptics peer/hud peer/view peer/output

if [ "$breaches" -gt 0 ]; then
  echo "$breaches include(s) break the rules of the house. Each room's README says what it may include." >&2
  exit 1
fi
echo "Every include keeps to the rules."
