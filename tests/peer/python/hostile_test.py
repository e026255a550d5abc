"""slosh.join at a host that means harm: what it says reaches a program as text that a terminal may show."""

import os
import subprocess
import unicodedata
import unittest

import slosh

LURE = os.environ.get("SLOSH_LURE", "")
GUESTS = 60
# What a visit may say: words of refusal, of a close, of notices, names and a farewell.
TRICKS = {"texts": 3, "refusal": 3, "close": 3, "everything": 2, "bad welcome": 2, "bad scene": 2, "streams": 2,
          "states": 2}
HIDDEN = ("Cc", "Cf", "Cs", "Co", "Zl", "Zp")


def unfit(text):
    return [f"{ord(c):#x}" for c in text.replace("\n", "") if unicodedata.category(c) in HIDDEN]


@unittest.skipUnless(LURE, "the hostile host is not built: ninja hostile_lure")
class Hostile(unittest.TestCase):
    def setUp(self):
        self.lure = subprocess.Popen([LURE, str(GUESTS), "5"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.links = []
        for line in iter(self.lure.stdout.readline, "\n"):
            self.assertNotEqual(line, "", "the hostile host did not start")
            self.links.append(line.rstrip("\n").split("\t"))

    def tearDown(self):
        self.lure.stdin.close()
        self.lure.stdout.close()
        self.assertEqual(self.lure.wait(), 0)

    def visit(self, link):
        """Everything that a visit has to say, and the errors that it ended with."""
        texts = []
        try:
            with slosh.join(link, name="Ana", timeout=5.0) as visit:
                texts += [visit.name, visit.scene.title, *(grip.name for grip in visit.scene.grips)]
                for _ in range(20):
                    visit.wait(0.05)
                    texts += visit.notices()
                    for name, _connected, grips in visit.people:
                        texts += [name, *grips]
                    texts += visit.held
        except slosh.Error as error:
            return texts, [str(error), repr(error), error.where, error.what, error.mend]
        return texts, []

    def test_what_it_says_is_text(self):
        visits = dict.fromkeys(TRICKS, 0)
        said, errors = 0, 0
        for trick, link in self.links:
            if visits.get(trick, 99) >= TRICKS.get(trick, 0):
                continue
            visits[trick] += 1
            texts, error = self.visit(link)
            said += len(texts)
            errors += len(error) > 0
            for text in texts + error:
                self.assertEqual(unfit(text), [], f"{trick}: {text!r}")
                self.assertLess(len(text), 5000, trick)
        self.assertEqual(visits, TRICKS, "each trick was tried")
        self.assertGreater(said, 20)
        self.assertGreater(errors, 5)


if __name__ == "__main__":
    unittest.main()
