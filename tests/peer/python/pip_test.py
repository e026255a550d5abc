"""pyproject.toml: what `pip install .` is told. With scikit-build-core here, by the back end itself; in full by hand:
pip install . --no-build-isolation"""

import importlib.util
import os
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..")
BUILD, VERSION = sys.argv[1:3]


class Project(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        try:
            import tomllib
        except ImportError:
            raise unittest.SkipTest("Python 3.11 has the reader of TOML")
        with open(os.path.join(ROOT, "pyproject.toml"), "rb") as file:
            cls.project = tomllib.load(file)
        cls.skbuild = cls.project["tool"]["scikit-build"]

    def test_the_version_is_cmakes(self):
        version = self.skbuild["metadata"]["version"]
        with open(os.path.join(ROOT, version["input"])) as file:
            self.assertEqual(re.search(version["regex"], file.read())["value"], VERSION)

    def test_the_package_and_what_is_built_are_there(self):
        for package in self.skbuild["wheel"]["packages"]:
            self.assertTrue(os.path.exists(os.path.join(ROOT, package, "__init__.py")), package)
        known = subprocess.run(["cmake", "--build", BUILD, "--target", "help"], capture_output=True, text=True).stdout
        for target in self.skbuild["build"]["targets"]:
            self.assertRegex(known, rf"(?m)^(\.\.\. )?{target}\b", "a target of CMake's")

    def test_the_back_end_takes_it(self):
        if not importlib.util.find_spec("scikit_build_core"):
            self.skipTest("scikit-build-core is not installed")
        from scikit_build_core import build

        with tempfile.TemporaryDirectory() as folder:
            before = os.getcwd()
            os.chdir(ROOT)
            try:
                made = build.prepare_metadata_for_build_wheel(folder)
            finally:
                os.chdir(before)
            with open(os.path.join(folder, made, "METADATA")) as file:
                metadata = file.read()
            self.assertIn(f"Name: slosh\nVersion: {VERSION}\n", metadata)
            self.assertIn("Requires-Dist: numpy", metadata)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
