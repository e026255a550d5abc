#!/usr/bin/env bash
# The wheel installs with pip into a fresh environment, without a network, and works there by itself.
# Usage: wheel_test.sh BUILD PYTHON VERSION FOLDER
set -euo pipefail
build=${1:?usage: wheel_test.sh BUILD PYTHON VERSION FOLDER}
python=${2:?usage: wheel_test.sh BUILD PYTHON VERSION FOLDER}
version=${3:?usage: wheel_test.sh BUILD PYTHON VERSION FOLDER}
folder=${4:?usage: wheel_test.sh BUILD PYTHON VERSION FOLDER}
root="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../../.."
unset PYTHONPATH SLOSH_SCENES PYTHONWARNINGS
"$python" -c 'import venv, ensurepip' 2>/dev/null || { echo "skipped: python3-venv is not installed"; exit 77; }
rm -rf "$folder"
mkdir -p "$folder"
make="$root/peer/python/make_wheel.py"
"$python" "$make" "$build/python/slosh" "$build/scenes" "$root/LICENSE" "$version" "$folder/one" >"$folder/name"
"$python" "$make" "$build/python/slosh" "$build/scenes" "$root/LICENSE" "$version" "$folder/two" >/dev/null
wheel="$(<"$folder/name")"
cmp "$wheel" "$folder/two/$(basename "$wheel")" || { echo "two wheels of the same build differ" >&2; exit 1; }
case "$(basename "$wheel")" in
  "slosh-$version-cp3"*.whl) ;;
  *) echo "an odd name: $wheel" >&2; exit 1 ;;
esac

"$python" -m venv --system-site-packages "$folder/env"
"$folder/env/bin/pip" install --quiet --no-index --disable-pip-version-check "$wheel"
"$folder/env/bin/pip" check --disable-pip-version-check 2>&1 | grep slosh && exit 1
cd "$folder"
"$folder/env/bin/python" - "$version" "$folder/env" <<'PYTHON'
import importlib.metadata, os, sys
import slosh
version, env = sys.argv[1:]
assert slosh.__version__ == version == importlib.metadata.version("slosh")
assert os.path.realpath(slosh.__file__).startswith(os.path.realpath(env)), slosh.__file__
assert slosh.load_scene("bucket").source.startswith(os.path.realpath(env)), "the package's own scenes"
assert len(slosh.scenes()) == 9
assert os.path.exists(os.path.join(os.path.dirname(slosh.__file__), "py.typed"))
files = importlib.metadata.files("slosh")
assert files is not None and all(file.locate().exists() for file in files)
world = slosh.World(slosh.load_scene("spoon"), 0.0115, threads=1, settle=False)
world.step(3)
print(f"{world.particles} particles, tick {world.tick}")
PYTHON
"$folder/env/bin/pip" uninstall --quiet --yes slosh
! "$folder/env/bin/python" -c 'import slosh' 2>/dev/null || { echo "it is still there" >&2; exit 1; }
echo "$(basename "$wheel"): $(du -k "$wheel" | cut -f1) kB"
rm -rf "$folder"
