#!/usr/bin/env bash
# With the real Blender: what `slosh check` says of exports that it made (broken_exports.py makes them and says what has to be
# found); the add-on, installed and used; what it reads of frames that slosh exported (round_trip.py); the tutorial from its first command to its last.
# Usage: run.sh BUILD
set -euo pipefail
build=${1:?usage: run.sh BUILD}
here="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
root="$(dirname "$(dirname "$here")")"
build="$(readlink -f "$build")"
export SLOSH_SETTINGS=none
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
echo "$passed exports as expected, $failed not"

# step WORDS COMMAND…: quiet where it works
step() {
  local words="$1" code=0
  shift
  "$@" >"$folder/step.log" 2>&1 </dev/null || code=$?
  if ((code == 0)); then
    passed=$((passed + 1))
    grep -E '^(addon|round_trip|film)\.py:' "$folder/step.log" || true
  else
    failed=$((failed + 1))
    tail -n 20 "$folder/step.log"
    echo "$words: exit code $code"
  fi
}

in_blender() { blender --background --factory-startup --python-exit-code 1 --python "$@"; }

step "the mug scene" in_blender "$root/scenes/blender/mug.py" -- "$folder/mug.glb"
exports=(--export particles:ply --export surface:ply --export surface:glb --export surface:vdb)
mkdir "$folder/home"
step "the add-on" env HOME="$folder/home" XDG_CONFIG_HOME="$folder/home/.config" blender --background --factory-startup \
  --python-exit-code 1 --python "$here/addon.py" -- "$build/slosh_blender.zip" "$build/bin/slosh" "$folder/home"
step "frames of it" "$build/bin/slosh" play "$folder/mug.glb" --headless --no-render --unpaced --yes --spacing 0.008 \
  --seconds 0.02 --export-rate 50 "${exports[@]}" --out "$folder/round"
step "frames read by Blender" in_blender "$here/round_trip.py" -- "$folder/mug.glb" "$folder/round/frames" 0.008

# The tutorial's own commands, in its order, in a folder of its own; runs and renderings cut short.
mkdir "$folder/tutorial"
printf '#!/bin/sh\nexec "%s" "$@"\n' "$build/bin/slosh" >"$folder/tutorial/slosh"
chmod +x "$folder/tutorial/slosh"
mkdir -p "$folder/tutorial/scenes"
ln -s "$root/scenes/blender" "$folder/tutorial/scenes/blender"
commands=0
while read -r command; do
  case "$command" in
    *film.py*) command+=" --every 3 --samples 1 --size 96x72" ;;
    "./slosh play"*) command+=" --seconds 0.2 --yes" ;;
  esac
  case "$command" in
    "./slosh play"*--spacing*) ;;
    "./slosh play"*) command+=" --spacing 0.012" ;;
  esac
  commands=$((commands + 1))
  step "tutorial: $command" bash -c "cd '$folder/tutorial' && $command"
done < <(sed -n 's/^    \(\(\.\/slosh\|blender\) .*\)$/\1/p' "$root/scenes/blender/README.md")
for file in mug.glb mug.blend mug-film/view.mp4 mug-fine/frames/surface_00000.vdb film.mp4 film.blend; do
  [[ -s "$folder/tutorial/$file" ]] || { failed=$((failed + 1)); echo "the tutorial left no $file"; }
done
echo "$passed passed, $failed failed; $commands commands of the tutorial"
((failed == 0 && passed >= 31 && commands >= 7))
