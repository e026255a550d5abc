#!/usr/bin/env bash
# A host with two hands and a watcher, all of them programs of a build with ThreadSanitizer: once as they are, once
# with a hand that is killed and comes back. Fails on any report, and when one of them does not end in order.
# Usage: tsan_host.sh BUILD_DIR [FOLDER]. FOLDER (a temporary one) keeps what they said and wrote.
set -euo pipefail
build=${1:?usage: tsan_host.sh BUILD_DIR [FOLDER]}
program=$(readlink -m "$build/bin/slosh")
if ! grep -qs __tsan_init "$program"; then
  echo "tsan_host.sh: $program is not there or not built with ThreadSanitizer: use the preset tsan" >&2
  exit 2
fi
folder=${2:-}
[ -n "$folder" ] || folder=$(mktemp -d)
mkdir -p "$folder"
folder=$(readlink -f "$folder")
patience=300  # s for anything here; reached only when something hangs
declare -A pids=()
trap 'for pid in "${pids[@]}"; do kill -9 "$pid" 2>/dev/null || true; done' EXIT

# start NAME ARGUMENTS…: the program in a folder of its own, with nothing of the user's.
start() {
  local name=$1 home=$round/$1
  shift
  mkdir -p "$home"
  (
    cd "$home"
    export XDG_STATE_HOME=$home XDG_DATA_HOME=$home XDG_RUNTIME_DIR=$home DISPLAY='' WAYLAND_DISPLAY=''
    export TSAN_OPTIONS="log_path=$round/$name.report halt_on_error=0 second_deadlock_stack=1"
    exec "$program" "$@" >"$home/said" 2>&1 </dev/null
  ) &
  pids[$name]=$!
}

gone() { ! kill -0 "$1" 2>/dev/null; }

# until_true WHO WHAT COMMAND…: waits for what WHO will do.
until_true() {
  local who=$1 what=$2 since=$SECONDS
  shift 2
  until "$@"; do
    if ((SECONDS - since > patience)) || { gone "${pids[$who]}" && ! "$@"; }; then
      echo "tsan_host.sh: $what did not happen; see $round" >&2
      tail -n 5 "$round/$who/said" >&2
      exit 1
    fi
    sleep 0.1
  done
}

# ended NAME CODE: waits for its end.
ended() {
  local code=0
  until_true "$1" "the end of $1" gone "${pids[$1]}"
  wait "${pids[$1]}" 2>/dev/null || code=$?
  unset "pids[$1]"
  if ((code != $2)); then
    failed=1
    echo "$round_name: $1 ended with $code, not $2:"
    tail -n 5 "$round/$1/said"
  fi
}

link() { sed -n "s/^$1 //p" "$round/host/links.txt" | head -n 1; }
has_rows() { [ -s "$1" ] && (($(wc -l <"$1") > 20)); }

# play_round NAME SECONDS KILLED(yes|no)
play_round() {
  round_name=$1
  round=$folder/$1
  mkdir -p "$round"
  start host host pour --spacing 0.0139 --threads 2 --listen 127.0.0.1:0 --links links.txt --seconds "$2" --wait 2 \
    --checkpoint c --record r
  until_true host "a link" test -s "$round/host/links.txt"
  start ana join "$(link hold)" --name Ana --key key --headless --no-render --out out
  start ben join "$(link hold)" --name Ben --key key --headless --no-render --out out
  start eve watch "$(link watch)" --name Eve --key key --no-render --out out
  if [ "$3" = yes ]; then
    until_true ben "a force on Ben" has_rows "$round/ben/out/wrenches.csv"
    kill -9 "${pids[ben]}"
    ended ben 137
    start ben join "$(link hold)" --name Ben --key key --headless --no-render --out again
    until_true ben "a force on Ben, who came back" has_rows "$round/ben/again/wrenches.csv"
    grep -q "your place was kept" "$round/ben/said" || {
      failed=1
      echo "$round_name: Ben's place was not kept"
    }
  fi
  for name in host ana ben eve; do ended "$name" 0; done
}

failed=0
play_round together 2 no
play_round killed 4 yes

shopt -s nullglob
reports=("$folder"/*/*.report.*)
if ((${#reports[@]} > 0)); then
  failed=1
  cat "${reports[@]}"
fi
echo "$((${#reports[@]})) of 9 programs reported"
if ((failed)); then
  echo "see $folder" >&2
elif [ -z "${2:-}" ]; then
  rm -rf "$folder"
fi
exit "$failed"
