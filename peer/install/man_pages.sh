#!/usr/bin/env bash
# Man pages of the program, of each of its verbs and of what is installed beside it, from what --help says: one text, two
# forms.
# Usage: man_pages.sh PROGRAM VERSION OUT [OTHER PROGRAM…]
#   OUT gets slosh.1.gz, slosh-VERB.1.gz and a page of each other program
set -euo pipefail
program=${1:?usage: man_pages.sh PROGRAM VERSION OUT [OTHER PROGRAM…]}
version=${2:?usage: man_pages.sh PROGRAM VERSION OUT [OTHER PROGRAM…]}
out=${3:?usage: man_pages.sh PROGRAM VERSION OUT [OTHER PROGRAM…]}
export SLOSH_SETTINGS=none  # the defaults, not those of whoever builds

# page NAME [VERB]: of `program`
page() {
  local name=$1 verb=${2:-}
  "$program" ${verb:+"$verb"} --help | awk -v name="$name" -v version="$version" -v verb="$verb" '
  function plain(text) {  # what roff would take for its own
    gsub(/\\/, "\\e", text)
    gsub(/-/, "\\-", text)
    if (text ~ /^[.\x27]/) text = "\\&" text
    return text
  }
  function whole(item) { return gsub(/\[/, "[", item) == gsub(/\]/, "]", item) }
  function section(title) { close_block(); print ".SH " title }
  function close_block() { if (block) print ".EE"; block = 0 }
  BEGIN {
    printf ".TH %s 1 \"\" \"slosh %s\" \"slosh\"\n", toupper(name), version
  }
  # The first line that is not empty says what it is; the second how it is called.
  !what && NF { what = $0; sub(/\.$/, "", what); print ".SH NAME"; print plain(name) " \\- " plain(what); next }
  /^Usage: / { section("SYNOPSIS"); print ".B " plain(substr($0, 8)); next }
  /^(Positionals|Options|Subcommands):$/ {
    title = toupper(substr($0, 1, length($0) - 1))
    section(title == "POSITIONALS" ? "ARGUMENTS" : title)
    items = 1
    next
  }
  items && /^  [^ ]/ {
    item = substr($0, 3)
    said = ""
    if (match(item, /  +/) && RSTART > 1) {
      said = substr(item, RSTART + RLENGTH)
      item = substr(item, 1, RSTART - 1)
    } else if (length($0) > 34 && substr($0, 34, 1) == " " && whole(substr($0, 3, 31))) {
      said = substr($0, 35)  # the item fills its column to the last place
      item = substr($0, 3, 31)
    }
    print ".TP"
    print ".B " plain(item)
    if (said != "") print plain(said)
    next
  }
  items && /^   / { sub(/^ +/, ""); print plain($0); next }
  items && !NF { next }
  # The rest is prose, lists and examples in lines of their own.
  /^Examples?:$/ { items = 0; section("EXAMPLES"); print ".EX"; block = 1; next }
  NF && items { items = 0; section("DESCRIPTION"); print ".EX"; block = 1 }
  block { print plain($0) }
  END {
    section("SEE ALSO")
    print verb == "" && name == "slosh" ? "\\fBslosh VERB \\-\\-help\\fR, and the page \\fBslosh\\-VERB\\fR(1) of each verb" : "\\fBslosh\\fR(1)"
  }'
}

mkdir -p "$out"
rm -f "$out"/*.1.gz
page slosh | gzip -9n >"$out/slosh.1.gz"
for verb in $("$program" --help | sed -n '/^Subcommands:/,$s/^  \([a-z]\{1,\}\) .*/\1/p'); do
  page "slosh-$verb" "$verb" | gzip -9n >"$out/slosh-$verb.1.gz"
done
shift 3
for program in "$@"; do
  page "$(basename "$program")" | gzip -9n >"$out/$(basename "$program").1.gz"
done
