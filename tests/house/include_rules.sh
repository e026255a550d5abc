#!/usr/bin/env bash
# Who may include whom: the rules of the house, checked on every #include of every source in ROOT.
# Usage: include_rules.sh ROOT. Prints each breach as file:line and exits 1 if there is one.
#
# Nothing is left out by not being named: a source in a folder without a rule is a breach too, and so is a toolkit
# anywhere but where it is named. include_rules_test.sh plants breaches and sees that each is found.
set -euo pipefail
root=${1:?usage: include_rules.sh ROOT}
cd "$root"

# folder | what of other folders its sources may include, as prefixes. A folder follows the longest rule above it, and
# may always include what lies in its own room (the first part of its path). net/text/ stands alone, below all rooms:
# text from elsewhere comes in at each. The rooms' READMEs say the same.
rules='
scenes     | sim/math/ net/text/
sim        | sim/math/ scenes/scene.h
net        | sim/snapshot.h sim/math/ scenes/scene.h
host       | scenes/ sim/ net/
host/app   | scenes/ sim/ net/ peer/ render/
peer       | scenes/ sim/snapshot.h sim/math/ net/ render/
peer/app | scenes/ sim/ net/ render/ host/
peer/python | scenes/ sim/ net/ host/
peer/install | sim/backend.h
render     | sim/math/ net/text/
tests      | scenes/ sim/ net/ host/ peer/ render/
'
# pattern of what is included | folders or files where it may stand | why
toolkits='
^<(cuda|cub/|thrust/)         | sim/cuda sim/passes tests/cross tests/lab/report/ceilings.cu | CUDA only in sim/cuda, and where backends or GPUs are measured
^"sim/cuda/                   | sim/cuda sim/passes sim/particle_engine.cpp tests/cross | only the factory in sim/particle_engine.cpp knows the CUDA engine
^<(epoxy|GL|EGL|GLFW)/        | render tests/xr | GL only in render and in the runtime that tests show pictures to
^<(openxr|X11)/               | render/xr tests/xr | OpenXR only behind render/headset.h
^<(ngtcp2|gnutls)/            | net/quic | QUIC and TLS only behind net/quic/endpoint.h
^<(hidapi|libusb|libevdev)    | peer/devices | HID, USB and input events only in the drivers
^<pybind11/                   | peer/python | Python only in its module
^"peer/python/                | peer/python | nothing that ships knows the Python module
^<(openvdb|tbb)/              | peer/output/export/fluid_surface.cpp | OpenVDB takes long to compile: it is in one source file
^<toml\+\+/                   | peer/settings | TOML only where settings are read
^<unicode/                    | net/text | ICU only behind net/text
^"net/impair/                 | net/impair tests | a bad network is for tests and for the program slosh-impair
^"(peer|host)/app/            | peer/app host/app peer/main.cpp tests | only the program joins host and peer
^"tests/                      | tests | nothing that ships needs a test'"'"'s kit or the laboratory
'

find . \( -path './.*' -o -path ./build -o -path ./out \) -prune -o -type f \
  \( -name '*.h' -o -name '*.hpp' -o -name '*.inl' -o -name '*.c' -o -name '*.cc' -o -name '*.cpp' -o -name '*.cu' \
  -o -name '*.cuh' \) -print0 | sort -z |
  xargs -0 -r grep -HnE '^[[:space:]]*#[[:space:]]*include' |
  awk -v rules="$rules" -v toolkits="$toolkits" '
    function trim(text) { gsub(/^[ \t]+|[ \t]+$/, "", text); return text }
    function breach(why) { print file ":" line ": " text "  (" why ")"; ++breaches }
    function starts(text, prefix) { return substr(text, 1, length(prefix)) == prefix }
    function within(path, place) { return path == place || starts(path, place "/") }
    BEGIN {
      count = split(rules, lines, "\n")
      for (i = 1; i <= count; ++i) if (split(lines[i], part, "|") == 2) may[trim(part[1])] = trim(part[2])
      count = split(toolkits, lines, "\n")
      for (i = 1; i <= count; ++i) {
        n = split(lines[i], part, " [|] ")
        if (n != 3) continue
        ++tools
        pattern[tools] = trim(part[1])
        places[tools] = trim(part[2])
        reason[tools] = trim(part[3])
      }
    }
    {
      match($0, /:[0-9]+:/)
      file = substr($0, 3, RSTART - 3)  # without "./"
      line = substr($0, RSTART + 1, RLENGTH - 2)
      text = substr($0, RSTART + RLENGTH)
      what = text
      sub(/^[ \t]*#[ \t]*include[ \t]*/, "", what)
      room = file
      sub(/\/.*/, "", room)
      ++includes

      rule = ""
      for (folder in may) if (within(file, folder) && length(folder) > length(rule)) rule = folder
      if (rule == "") {
        breach("no rule says what " room " may include: give it one in tests/house/include_rules.sh")
      } else if (what ~ /^"/) {
        name = what
        sub(/^"/, "", name)
        sub(/".*/, "", name)
        if (name ~ /(^|\/)\.\.?\//) breach("from the root, not by . or ..")
        # A name without a folder lies beside its includer; what is in no room of ours is a library.
        top = name
        sub(/\/.*/, "", top)
        allowed = name !~ /\// || top == room || !(top in may)
        n = split(may[rule], prefix, " ")
        for (i = 1; i <= n && !allowed; ++i) allowed = starts(name, prefix[i])
        if (!allowed) breach(rule " may include only " may[rule])
      } else if (what !~ /^</) {
        breach("neither \"...\" nor <...>")
      }

      for (t = 1; t <= tools; ++t) {
        if (what !~ pattern[t]) continue
        allowed = 0
        n = split(places[t], place, " ")
        for (i = 1; i <= n && !allowed; ++i) allowed = within(file, place[i])
        if (!allowed) breach(reason[t])
      }
    }
    END {
      if (includes == 0) {
        print "include_rules.sh: no source here" > "/dev/stderr"
        exit 2
      }
      if (breaches) {
        fflush()  # the breaches first: both go to one place, and a line must not fall into another
        print breaches " include(s) break the rules of the house. Each room'"'"'s README says what it may include." \
          > "/dev/stderr"
        exit 1
      }
      print "Every include keeps to the rules (" includes " of them)."
    }'
