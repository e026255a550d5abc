"""What the room's README shows runs as it stands there."""

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


if __name__ == "__main__":
    unittest.main()
