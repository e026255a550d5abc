#!/usr/bin/env bash
# The installed program, run from elsewhere, and what is in the Debian package.
# Usage: install_test.sh BUILD VERSION FOLDER
set -euo pipefail
build=${1:?usage: install_test.sh BUILD VERSION FOLDER}
version=${2:?usage: install_test.sh BUILD VERSION FOLDER}
folder=${3:?usage: install_test.sh BUILD VERSION FOLDER}
unset SLOSH_SCENES
rm -rf "$folder"
mkdir -p "$folder/elsewhere"
folder="$(readlink -f "$folder")"
export XDG_STATE_HOME="$folder/state" XDG_DATA_HOME="$folder/data" XDG_CONFIG_HOME="$folder/config"
cd "$folder/elsewhere"

fail() { echo "$*" >&2; exit 1; }
has() { grep -qF -- "$2" <<<"$1" || fail "no '$2' in: $1"; }
# run WORD COMMAND…: the command succeeds and says the word.
run() {
  local word=$1 said
  shift
  said="$("$@" 2>&1)" || fail "$* failed: $said"
  has "$said" "$word"
}

# What an installation in PREFIX does.
try_program() {
  local prefix=$1 program="$1/bin/slosh"
  run "slosh $version" "$program" --version
  run "commit " "$program" --version
  run "CPU" "$program" --version
  run "libngtcp2 " "$program" --version
  # Its own scenes, not those of the build: one that is only there.
  cp "$prefix/share/slosh/scenes/pool.gltf" "$prefix/share/slosh/scenes/only_here.gltf"
  run only_here "$program" scenes
  run bucket "$program" scenes
  rm "$prefix/share/slosh/scenes/only_here.gltf"
  run fluid "$program" check bucket
  run particles "$program" plan bucket --spacing 0.0135
  run N "$program" play bucket --headless --no-render --unpaced --seconds 0.1 --spacing 0.0135 --threads 1 --out played
  [[ -s played/wrenches.csv && -s played/summary.json ]] || fail "play left no wrenches.csv or summary.json"
  rm -r played
  # What `slosh report coupling --link` has for a wire, where it looks for it.
  run "listening at 127.0.0.1:" timeout -s INT 20 bash -c '(sleep 1; echo quit) | "$0" --listen 127.0.0.1:0 --to 127.0.0.1:9' \
    "$prefix/bin/slosh-impair"
}

# What lies beside the program.
try_files() {
  local prefix=$1 page verb
  for page in slosh slosh-play slosh-host slosh-join slosh-report slosh-impair; do
    [[ -s "$prefix/share/man/man1/$page.1.gz" ]] || fail "no man page $page"
  done
  page="$(zcat "$prefix/share/man/man1/slosh-host.1.gz")"
  has "$page" ".SH OPTIONS"
  has "$page" "max\\-watchers"
  command -v groff >/dev/null || fail "no groff here to read man pages with (groff-base)"
  local said
  for page in "$prefix"/share/man/man1/*.gz; do
    said="$(zcat "$page" | groff -K utf8 -man -Tutf8 -ww 2>&1 >/dev/null)" || true
    [[ -z "$said" ]] || fail "$page: $said"
  done
  grep -q 'SUBSYSTEM' "$prefix/lib/udev/rules.d/70-slosh.rules" || fail "the udev rule is empty"
  printf '#include <slosh/slosh_device.h>\nint main(void) { return 0; }\n' >header.c
  cc -fsyntax-only -Wall -Werror -I "$prefix/include" header.c || fail "the header of devices does not compile"
  cc -fsyntax-only -Wall -Werror -I "$prefix/include" "$prefix/share/doc/slosh/examples/example.c" ||
    fail "the example of a device does not compile"
  grep -qa 'slosh_addon/__init__.py' "$prefix/share/slosh/slosh_blender.zip" || fail "no add-on for Blender"
  # Completion, as bash asks for it.
  (
    PATH="$prefix/bin:$PATH"
    source "$prefix/share/bash-completion/completions/slosh"
    answer() {
      COMP_WORDS=(slosh "$@") COMP_CWORD=$#
      _slosh
      printf '%s ' "${COMPREPLY[@]}"
    }
    has "$(answer pl)" "play plan"
    has "$(answer play bu)" "bucket"
    has "$(answer play --unp)" "--unpaced"
    has "$(answer play --backend c)" "cpu cuda"
    has "$(answer links re)" "revoke"
  ) || exit 1
}

cmake --install "$build" --prefix "$folder/prefix" >"$folder/install.log"
try_program "$folder/prefix"
try_files "$folder/prefix"
echo "installed and run from elsewhere"

# A processor that has less than the program needs is told so; nothing crashes.
arch="$(sed -n 's/^SLOSH_ARCH:STRING=//p' "$build/CMakeCache.txt")"
if [[ "$(uname -m)" == x86_64 && "$arch" =~ ^(native|x86-64-v[34])$ ]]; then
  command -v qemu-x86_64 >/dev/null || fail "no qemu-x86_64 here to be an older processor with (qemu-user)"
  code=0
  said="$(qemu-x86_64 -cpu Nehalem "$build/bin/slosh" --version 2>&1)" || code=$?
  ((code == 1)) || fail "on an older processor: exit code $code: $said"
  has "$said" "it lacks avx, "
  code=0
  said="$(qemu-x86_64 -cpu Nehalem "$build/bin/slosh-impair" --help 2>&1)" || code=$?
  ((code == 1)) || fail "slosh-impair on an older processor: exit code $code: $said"
  has "$said" "it lacks avx, "
  echo "an older processor is refused in words"
fi
# What looks for instructions beyond a package's own finds one, and none where there is none.
printf 'void f(void) { __asm__("vpaddd %%%s0, %%%s0, %%%s0"); }\n' zmm zmm zmm >wide.c
printf 'void f(void) { __asm__("vpaddd %%%s0, %%%s0, %%%s0"); }\n' ymm ymm ymm >narrow.c
cc -c wide.c && cc -c narrow.c
source_dir="$(sed -n 's/^CMAKE_HOME_DIRECTORY:INTERNAL=//p' "$build/CMakeCache.txt")"
! "$source_dir/peer/install/check_baseline.sh" wide.o >found.txt || fail "AVX-512 was not found"
grep -q '^vpaddd 1$' found.txt || fail "found: $(cat found.txt)"
"$source_dir/peer/install/check_baseline.sh" narrow.o || fail "AVX2 was taken for more"

command -v dpkg-shlibdeps >/dev/null || { echo "skipped: no dpkg-shlibdeps here, so no Debian package"; exit 77; }
(cd "$build" && cpack -G DEB -B "$folder/package") >"$folder/cpack.log" 2>&1 || fail "cpack: $(tail -n 20 "$folder/cpack.log")"
packages=("$folder"/package/slosh_"$version"_*.deb)
[[ -f "${packages[0]}" ]] || fail "no package with the version in its name"
info="$(dpkg-deb -I "${packages[0]}")"
has "$info" "Package: slosh"
has "$info" "Version: $version"
has "$info" "Built for the instruction set"
for library in libc6 libstdc++6 libgnutls30 libngtcp2 libglfw3 libicu libopencolorio libusb-1.0-0 libzstd1; do
  grep -q "^ Depends:.*$library" <<<"$info" || fail "it does not depend on $library: $info"
done
has "$info" "Recommends: gnuplot-nox, ffmpeg"
! grep -E "^ (Depends|Pre-Depends):.*(embree|gtest|umockdev|draco|meshoptimizer)" <<<"$info" ||
  fail "it depends on what tests and reports alone need: $info"
dpkg-deb -x "${packages[0]}" "$folder/unpacked"
try_program "$folder/unpacked/usr"
try_files "$folder/unpacked/usr"
# Every library that the programs need is asked for: none is missing, none of its paths leads to the build.
for program in slosh slosh-impair; do
  ! ldd "$folder/unpacked/usr/bin/$program" | grep -E "not found|$build" || fail "$program: a library is missing or the build's own"
done
echo "$(basename "${packages[0]}"): $(du -k "${packages[0]}" | cut -f1) kB, $(dpkg-deb -c "${packages[0]}" | grep -vc '/$') files"
rm -rf "$folder"
