#!/usr/bin/env bash
# The stubs say what the module has, and the examples are right by them.
# Usage: types_test.sh BUILD EXAMPLES PYTHON
set -euo pipefail
build=${1:?usage: types_test.sh BUILD EXAMPLES PYTHON}
examples=${2:?usage: types_test.sh BUILD EXAMPLES PYTHON}
python=${3:?usage: types_test.sh BUILD EXAMPLES PYTHON}
command -v mypy >/dev/null || { echo "skipped: mypy is not installed"; exit 77; }
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
export MYPYPATH="$build/python" PYTHONWARNINGS=
cd "$folder"
# What a compiled class is to Python (its metaclass, how it is made) cannot be said in a stub; top-level names are looked
# at below.
cat >allowed <<'ALLOWED'
slosh\._core\.[A-Za-z]+
slosh\._core\.[A-Za-z]+\.__init__
ALLOWED
stubtest --ignore-missing-stub --ignore-unused-allowlist --allowlist allowed slosh._core
mypy --strict --cache-dir "$folder/cache" "$examples"/*.py
# Nothing of the module is missing in the stubs, and everything has a docstring.
"$python" - "$build/python/slosh/_core.pyi" <<'PYTHON'
import re, sys
import slosh
from slosh import _core
stub = open(sys.argv[1]).read()
missing, silent = [], []
for name in dir(_core):
    if name.startswith("_"):
        continue
    thing = getattr(_core, name)
    if not re.search(rf"^(class|def) {name}\b", stub, re.M):
        missing.append(name)
    if not (thing.__doc__ or "").strip():
        silent.append(name)
    if isinstance(thing, type) and name != "Error":
        body = re.search(rf"^class {name}\b.*?(?=^\S|\Z)", stub, re.M | re.S).group(0)
        for part in vars(thing):
            if not part.startswith("_") and not re.search(rf"def {part}\b", body):
                missing.append(f"{name}.{part}")
    if name not in slosh.__all__:
        missing.append(f"slosh.{name}")
for name in re.findall(r"^(?:class|def) (\w+)", stub, re.M):
    if not hasattr(_core, name):
        missing.append(f"_core.{name}")
sys.exit(f"not in the stubs: {missing}; without a docstring: {silent}" if missing or silent else 0)
PYTHON
