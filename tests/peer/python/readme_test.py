"""What the room's README shows runs as it stands there."""

import inspect
import os
import re
import unittest

import slosh

README = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../../peer/python/README.md")


class Readme(unittest.TestCase):
    def test_its_program_runs(self):
        with open(README, encoding="utf-8") as file:
            blocks = re.findall(r"^```python\n(.*?)^```", file.read(), re.M | re.S)
        self.assertEqual(len(blocks), 1)
        names = {}
        exec(blocks[0], names)
        self.assertEqual(names["run"].wrenches.shape, (len(names["run"].time), 1, 6))
        self.assertIsInstance(names["world"], slosh.World)

    def test_every_public_name_says_what_it_is(self):
        without = []
        for name in dir(slosh):
            thing = getattr(slosh, name)
            if name.startswith("_") or inspect.ismodule(thing) or isinstance(thing, (int, float, str, tuple)):
                continue
            members = {f"{name}.{m}": v for m, v in vars(thing).items() if not m.startswith("_")} if inspect.isclass(thing) else {}
            for at, one in {name: thing, **members}.items():
                if not (getattr(one, "__doc__", None) or "").strip():
                    without.append(at)
        self.assertEqual(without, [])


if __name__ == "__main__":
    unittest.main()
