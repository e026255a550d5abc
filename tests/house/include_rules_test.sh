#!/usr/bin/env bash
# include_rules.sh finds what it is there for: breaches are planted in a copy of the sources, one in every folder that
# holds sources and one of each kind, and each must be named.
# Usage: include_rules_test.sh ROOT
set -euo pipefail
root=$(readlink -f "${1:?usage: include_rules_test.sh ROOT}")
check=$root/tests/house/include_rules.sh
copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT

cd "$root"
for room in */; do
  [[ $room == build/ || $room == out/ ]] && continue
  find "$room" \( -name '*.h' -o -name '*.cpp' -o -name '*.cu' -o -name '*.cuh' \) -print0
done | tar -c --null -T - | tar -x -C "$copy"
cd "$copy"
bash "$check" . >/dev/null || { echo "the copy itself has breaches" >&2; exit 1; }

planted=()
# plant FILE LINE: a source that holds this include alone.
plant() {
  mkdir -p "$(dirname "$1")"
  printf '%s\n' "$2" >"$1"
  planted+=("$1:1:")
}
mapfile -t folders < <(find . -type f -printf '%P\n' | sed 's|/[^/]*$||' | sort -u)
for folder in "${folders[@]}"; do
  case "$folder" in
    tests/cross*) plant "$folder/planted.cpp" '#include <GLFW/glfw3.h>' ;;
    tests*) plant "$folder/planted.cpp" '#include <cuda_runtime.h>' ;;
    *) plant "$folder/planted.cpp" '#include "tests/support/places.h"' ;;
  esac
done
# What each rule is for.
plant peer/remote/knows_the_host.h '#include "host/server/server.h"'
plant peer/haptics/knows_the_world.cu '#include "sim/world.h"'
plant peer/output/knows_the_program.cpp '#include "peer/app/local_run.h"'
plant sim/cpu/knows_the_net.h '  #  include "net/channel.h"'
plant sim/knows_the_scene_files.cuh '#include "scenes/load.h"'
plant scenes/knows_the_world.cpp '#include "sim/world.h"'
plant net/codec/knows_the_peer.h '#include "peer/remote/remote_link.h"'
plant host/knows_pictures.cpp '#include "render/image.h"'
plant render/gl/knows_scenes.cpp '#include "scenes/scene.h"'
plant peer/remote/knows_quic.cpp '#include <ngtcp2/ngtcp2.h>'
plant peer/view/reads_hid.cpp '#include <hidapi.h>'
plant peer/view/reads_pads.cpp '#include <libevdev/libevdev.h>'
plant peer/haptics/finds_usb.cpp '#include <libusb.h>'
plant peer/view/draws.cpp '#include <epoxy/gl.h>'
plant net/quic/impairs.cpp '#include "net/impair/relay.h"'
plant peer/app/binds.cpp '#include <pybind11/pybind11.h>'
plant peer/remote/knows_the_module.cpp '#include "peer/python/hand.h"'
plant net/goes_up.cpp '#include "../host/host.h"'
plant host/names_by_macro.cpp '#include WHAT'
plant elsewhere/no_rule.cpp '#include <vector>'
plant no_room.cpp '#include <vector>'

found=$(bash "$check" . 2>&1) && { echo "no breach was found" >&2; exit 1; }
missed=0
for breach in "${planted[@]}"; do
  grep -qE "^(\./)?$breach" <<<"$found" || { echo "not found: $breach" >&2; missed=$((missed + 1)); }
done
# What keeps to the rules is not named.
kinds=$((${#planted[@]} - ${#folders[@]}))
others=$(($(grep -vcF "planted.cpp:1:" <<<"$found") - 1))  # without the closing line
((others == kinds)) || { echo "$others named that are not in folders, not $kinds" >&2; missed=$((missed + 1)); }
((missed == 0)) || exit 1
echo "${#planted[@]} planted breaches found, in each of ${#folders[@]} folders and of every kind."
