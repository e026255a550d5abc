#!/usr/bin/env bash
# commit_subjects.py finds subjects that are too long, leaves older ones and merges alone, and skips where there is no
# history. Usage: commit_subjects_test.sh ROOT
set -euo pipefail
root=$(readlink -f "${1:?usage: commit_subjects_test.sh ROOT}")
check=$root/tests/house/commit_subjects.py
command -v git >/dev/null || { echo "no git: skipped"; exit 77; }
copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
cd "$copy"
export GIT_CEILING_DIRECTORIES=$copy/..
long=$(printf 'x%.0s' {1..73})
# expect CODE TEXT: the check exits so, and says this.
expect() {
  local said code=0
  said=$(python3 "$check" . 2>&1) || code=$?
  if ((code != $1)) || ! grep -qF -- "$2" <<<"$said"; then
    printf 'wanted %s and %s; exit code %s and:\n%s\n' "$1" "$2" "$code" "$said" >&2
    exit 1
  fi
}
# commit DATE SUBJECT
commit() {
  GIT_COMMITTER_DATE=$1 GIT_AUTHOR_DATE=$1 git -c user.name=house -c user.email=house@example.org -c commit.gpgsign=false \
    commit -q --allow-empty --allow-empty-message -m "$2"
}

expect 77 'skipped'
git init -q .
expect 77 'skipped'
commit 2026-11-01T00:00:00Z "$long"
expect 0 '0 commits, 0 faults'
commit 2026-12-01T00:00:00Z "${long:1}"
expect 0 '1 commits, 0 faults'
commit 2026-12-01T00:01:00Z "$long"
expect 1 'the subject has 73 characters; 72 are allowed'
git reset -q --hard HEAD~1
commit 2026-12-01T00:02:00Z ''
expect 1 'no subject'
git reset -q --hard HEAD~1
git clone -q --depth 1 "file://$copy" shallow
cd shallow
expect 77 'skipped'
echo "2 planted faults found."
