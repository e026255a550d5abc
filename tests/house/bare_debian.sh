#!/usr/bin/env bash
# A stranger's first hour: a machine with nothing but Debian 12 (debootstrap's smallest, git and sudo beside it), a user who
# is not root, a clone of this commit; then what the pages say, to the letter: `./slosh play`, the tutorial from its first
# command to its last, the Python module, and the Debian package on a second such machine that never saw the sources.
# Part of no `./slosh test`: it fetches half a gigabyte and compiles for half an hour on two cores.
#
# Usage, as root: bare_debian.sh FOLDER [--ccache DIR] [--only STEPS] [--test [CTEST OPTIONS…]]
#   FOLDER         keeps the machines (10 GB) and a log of each step; given again, what is there goes on
#   --ccache DIR   read DIR, compiled by the same g++, in place of compiling; nothing is written there
#   --only STEPS   of play,tutorial,blender,python,package,install,test, by commas (all but blender, which is
#                  ./slosh test --with-blender, and test); install takes the packages in FOLDER/second/tmp
#   --test         ./slosh test there too, to its closing line; the rest goes to it
# MIRROR in the environment names another mirror than deb.debian.org.
set -euo pipefail
here="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
root="$(dirname "$(dirname "$here")")"
((EUID == 0)) || { echo "bare_debian.sh: as root: it makes another machine's root and goes into it" >&2; exit 2; }
# Mounts and processes of their own, which go when this one goes.
if [[ -z "${SLOSH_BARE_INSIDE:-}" ]]; then
  exec env SLOSH_BARE_INSIDE=1 unshare --mount --pid --fork --kill-child --mount-proc "$0" "$@"
fi
folder=${1:?usage: bare_debian.sh FOLDER [--ccache DIR] [--only STEPS] [--test [CTEST OPTIONS...]]}
shift
ccache="" only=play,tutorial,python,package,install tests=()
while (($# > 0)); do
  case "$1" in
    --ccache) ccache=${2:?--ccache needs a folder}; shift ;;
    --only) only=${2:?--only needs steps}; shift ;;
    --test) only+=,test; shift; tests=("$@"); break ;;
    *) echo "bare_debian.sh: no option '$1'" >&2; exit 2 ;;
  esac
  shift
done
mkdir -p "$folder/logs"
folder="$(readlink -f "$folder")"
mirror=${MIRROR:-http://deb.debian.org/debian}
wanted() { [[ ",$only," == *",$1,"* ]]; }

# in_root MACHINE USER COMMAND…: as that user there, with the environment of a login and no more.
in_root() {
  local machine=$1 user=$2 home=/root
  shift 2
  [[ $user == root ]] || home=/home/$user
  local place=(env -i "HOME=$home" "USER=$user" "PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin" TERM=dumb LANG=C.UTF-8)
  if [[ -n $ccache && $machine == first ]]; then
    place+=(CCACHE_DIR=/ccache CCACHE_READONLY=1 CCACHE_TEMPDIR=/tmp CCACHE_BASEDIR=/home CCACHE_NOHASHDIR=1)
  fi
  chroot --userspec="$user" "$folder/$machine" "${place[@]}" bash -c 'cd; cd slosh 2>/dev/null; "$@"' - "$@" </dev/null
}

# step MACHINE USER WORDS COMMAND: quiet where it works, its end where it does not.
passed=0 failed=0
step() {
  local machine=$1 user=$2 words=$3 command=$4 begun=$SECONDS code=0
  local log="$folder/logs/${only%%,*}-$(printf %02d $((passed + failed + 1))).log"
  printf '$ %s\n' "$command" >"$log"
  in_root "$machine" "$user" bash -c "$command" >>"$log" 2>&1 || code=$?
  if ((code == 0)); then
    passed=$((passed + 1))
    printf 'ok  %4d s  %s\n' $((SECONDS - begun)) "$words"
  else
    failed=$((failed + 1))
    printf 'NOT %4d s  %s: exit code %d, %s\n' $((SECONDS - begun)) "$words" "$code" "$log"
    tail -n 15 "$log"
  fi
}
# made WORDS FILE…: on the first machine, below the clone.
made() {
  local file
  for file in "${@:2}"; do
    [[ -s "$clone/$file" ]] && continue
    failed=$((failed + 1))
    echo "NOT         $1 left no $file"
  done
}

# ---- The machines.
if [[ ! -e "$folder/machine/etc/debian_version" ]]; then
  debootstrap --variant=minbase bookworm "$folder/machine" "$mirror" >"$folder/logs/debootstrap.log" ||
    { tail "$folder/logs/debootstrap.log"; echo "bare_debian.sh: debootstrap could not make it" >&2; exit 1; }
fi
for machine in first second; do
  new=""
  if [[ ! -d "$folder/$machine" ]]; then
    cp -a --reflink=auto "$folder/machine" "$folder/$machine"
    new=yes
  fi
  cp -L /etc/resolv.conf "$folder/$machine/etc/resolv.conf"
  mount -t proc proc "$folder/$machine/proc"
  mount --rbind /sys "$folder/$machine/sys"
  mount --rbind /dev "$folder/$machine/dev"
  # A container's /dev/full may be root's alone; on any machine it is everybody's, and a test writes to it.
  if [[ $(stat -c %a /dev/full) != 666 ]]; then
    rm -f "$folder/full-of-$machine"
    mknod -m 666 "$folder/full-of-$machine" c 1 7
    mount --bind "$folder/full-of-$machine" "$folder/$machine/dev/full"
  fi
  [[ -n $new ]] || continue
  # What any machine has that somebody has fetched something to.
  in_root "$machine" root bash -c "apt-get update && DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends git sudo &&
    useradd -m -s /bin/bash stranger && echo 'stranger ALL=(ALL) NOPASSWD: ALL' >/etc/sudoers.d/stranger" \
    >"$folder/logs/$machine.log" 2>&1 || { tail "$folder/logs/$machine.log"; exit 1; }
  [[ $machine == first ]] || continue
  git clone -q "$root" "$folder/first/home/stranger/slosh"
  in_root first root chown -R stranger: /home/stranger/slosh
done
if [[ -n $ccache ]]; then
  mkdir -p "$folder/first/ccache"
  mount --bind "$ccache" "$folder/first/ccache"
  mount -o remount,bind,ro "$folder/first/ccache"
  in_root first root apt-get install -y --no-install-recommends ccache >"$folder/logs/ccache.log" 2>&1
fi
echo "Debian $(cat "$folder/first/etc/debian_version"), $(in_root first root dpkg-query -W | wc -l) packages, commit $(git -C "$root" rev-parse --short HEAD)"

# ---- README.md
clone="$folder/first/home/stranger/slosh"  # what an earlier run of this left there would be refused or numbered
if wanted play; then
  rm -rf "$clone/out"
  step first stranger "./slosh play, from nothing to a film" "./slosh play"
  made "./slosh play" out/bucket/view.mp4 out/bucket/wrenches.png out/bucket/wrenches.csv
  step first stranger "slosh --version" "./slosh --version"
fi

# ---- scenes/blender/README.md
if wanted tutorial; then
  rm -rf "$clone"/mug* "$clone"/film.*
  step first root "apt install blender python3-numpy" \
    "DEBIAN_FRONTEND=noninteractive apt-get install -y blender python3-numpy"
  while read -r command; do
    step first stranger "tutorial: $command" "$command"
  done < <(sed -n 's/^    \(\(\.\/slosh\|blender\) .*\)$/\1/p' "$root/scenes/blender/README.md")
  made "the tutorial" mug.glb mug.blend mug-film/view.mp4 mug-film/wrenches.png mug-fine/frames/surface_00000.vdb film.mp4 film.blend
fi

if wanted blender; then
  step first stranger "./slosh test --with-blender" "./slosh test --with-blender"
  tail -n 1 "$folder/logs/${only%%,*}-$(printf %02d $((passed + failed))).log"
fi

# ---- peer/python/README.md
if wanted python; then
  step first stranger "./slosh python" "./slosh python"
  step first stranger "the wheel in an environment" \
    "python3 -m venv --system-site-packages env && env/bin/pip install --no-index build/release/dist/slosh-*.whl &&
     cd / && ~/slosh/env/bin/python -c 'import slosh; print(slosh.scenes())'"
  for example in build_a_scene fill_and_weigh find_viscosity admittance read_a_recording join_a_host; do
    step first stranger "example $example.py" "PATH=\$PWD/build/release/bin:\$PATH env/bin/python peer/python/examples/$example.py"
  done
fi

# ---- peer/install/README.md
if wanted package; then
  step first stranger "./slosh package" "./slosh package"
  cp "$clone"/build/package/slosh_*.deb "$folder/second/tmp/"
fi
if wanted install; then
  step second root "apt install ./slosh.deb, where no sources are" \
    "apt-get update && DEBIAN_FRONTEND=noninteractive apt-get install -y /tmp/slosh_*.deb"
  step second stranger "slosh --version there" "slosh --version"
  step second stranger "slosh play there, to a film" "rm -rf played && slosh play --headless --seconds 1 --out played && test -s played/view.mp4 -a -s played/wrenches.png"
  step second stranger "what it depends on is there, and nothing that tests need" \
    "! ldd /usr/bin/slosh | grep -E 'not found|embree|gtest'"
  step second root "man slosh-play, and its completion" \
    "DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends man-db bash-completion gcc libc6-dev &&
     man slosh-play | grep -q -- --unpaced && bash -c '. /usr/share/bash-completion/bash_completion; . /usr/share/bash-completion/completions/slosh
       COMP_WORDS=(slosh play bu) COMP_CWORD=2; _slosh; [[ \"\${COMPREPLY[*]}\" == *bucket* ]]'"
  step second stranger "a device of one's own by the header there" \
    "rm -rf mine && cp /usr/share/doc/slosh/examples/example.c . && gcc -shared -fPIC -O2 -Wall -Werror -o mine.so example.c -lm &&
     slosh play spoon --device plugin:./mine.so --headless --no-render --seconds 1 --spacing 0.012 --out mine"
fi

if wanted test; then
  step first stranger "./slosh test ${tests[*]-}" "./slosh test ${tests[*]-}"
  tail -n 30 "$folder/logs/${only%%,*}-$(printf %02d $((passed + failed))).log" | grep -E '^skipped|passed, ' || true
fi

echo "$passed passed, $failed failed"
((failed == 0))
