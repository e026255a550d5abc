#!/usr/bin/env python3
"""Writes the package slosh, as the build has it, into a wheel that pip installs (PEP 427), and prints its name.

Usage: make_wheel.py PACKAGE SCENES LICENSE VERSION OUT

PACKAGE is the folder slosh/ of the build, SCENES the shipped scenes, OUT the folder for the wheel. The same input
gives the same file to the byte. The module is for the Python that runs this and for this machine's kind of processor.
"""

import base64
import hashlib
import shutil
import subprocess
import sys
import sysconfig
import tempfile
import zipfile
from pathlib import Path

METADATA = """Metadata-Version: 2.1
Name: slosh
Version: {version}
Summary: Networked haptic fluid simulation: scenes, worlds, hands, forces
License: MIT
Requires-Python: =={python}.*
Requires-Dist: numpy
Description-Content-Type: text/plain

Smoothed-particle hydrodynamics that hands feel: load or build a scene, step it, read forces, bodies and particles,
join a host, read recordings. `help(slosh)` begins there. Built for the processor that it was built on, and for the
libraries of that system.
"""


def tag():
    version = "cp%d%d" % sys.version_info[:2]
    platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    return f"{version}-{version}-{platform}"


def stripped(file):
    """The module's bytes without the symbols that only a debugger reads."""
    strip = shutil.which("strip")
    if not strip:
        return file.read_bytes()
    with tempfile.NamedTemporaryFile() as small:
        subprocess.run([strip, "--strip-unneeded", "-o", small.name, str(file)], check=True)
        return Path(small.name).read_bytes()


def main():
    if len(sys.argv) != 6:
        sys.exit(__doc__)
    package, scenes, license_file, version, out = sys.argv[1:]
    package, scenes, out = Path(package), Path(scenes), Path(out)
    info = f"slosh-{version}.dist-info"
    suffix = sysconfig.get_config_var("EXT_SUFFIX")
    contents = {}
    for name in ("__init__.py", "analysis.py", "_core.pyi", "py.typed"):
        contents[f"slosh/{name}"] = (package / name).read_bytes()
    contents[f"slosh/_core{suffix}"] = stripped(package / f"_core{suffix}")
    for file in sorted(scenes.glob("*.gl*")):
        contents[f"slosh/scenes/{file.name}"] = file.read_bytes()
    python = "%d.%d" % sys.version_info[:2]
    contents[f"{info}/METADATA"] = METADATA.format(version=version, python=python).encode()
    contents[f"{info}/WHEEL"] = (
        f"Wheel-Version: 1.0\nGenerator: slosh make_wheel.py\nRoot-Is-Purelib: false\nTag: {tag()}\n".encode()
    )
    contents[f"{info}/LICENSE"] = Path(license_file).read_bytes()
    record = ""
    for name, data in contents.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        record += f"{name},sha256={digest},{len(data)}\n"
    contents[f"{info}/RECORD"] = (record + f"{info}/RECORD,,\n").encode()

    out.mkdir(parents=True, exist_ok=True)
    wheel = out / f"slosh-{version}-{tag()}.whl"
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in contents.items():
            entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o755 if name.endswith(".so") else 0o644) << 16
            archive.writestr(entry, data)
    print(wheel)


if __name__ == "__main__":
    main()
