"""slosh.join at a real host on loopback."""

import os
import shutil
import sys
import tempfile
import unittest

import numpy as np
import slosh

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../../peer/python/examples"))
from join_a_host import start_host  # noqa: E402


def until(remote, holds, seconds=60.0):
    """Waits until it holds; how long does not matter."""
    for _ in range(int(seconds / 0.02)):
        if holds():
            return
        remote.wait(0.02)
    raise AssertionError("it did not come")


class Visits(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.host, self.links = start_host(self.folder, ["--run", "Ben"])

    def tearDown(self):
        self.host.terminate()
        self.host.wait()
        shutil.rmtree(self.folder)

    def test_a_visit_from_its_link_to_its_end(self):
        self.assertEqual(os.stat(self.links).st_mode & 0o777, 0o600)
        with open(self.links) as written:
            link = {line.split()[0]: line.split()[1] for line in written}
        with open(os.path.join(self.folder, "host.log")) as log:
            self.assertNotIn(link["hold"], log.read(), "a log keeps no secrets")
        with self.assertRaises(slosh.Error) as raised:
            slosh.join(link["hold"][:-3] + "aaa")
        self.assertIn("link", str(raised.exception))
        with self.assertRaises(ValueError):
            slosh.join()
        with slosh.join(link["hold"], name="Ana", grips=["left_hand"], timeout=60.0) as ana:
            self.assertEqual((ana.name, ana.state, ana.held), ("Ana", "live", ["left_hand"]))
            with slosh.join(link_file=self.links, name="Ben", grips=["right_hand"], particles=False, timeout=60.0) as ben:
                self.assertEqual(ben.held, ["right_hand"])
                until(ben, lambda: len(ben.people) == 2)
                self.assertEqual(sorted(name for name, _, _ in ben.people), ["Ana", "Ben"])
                self.assertEqual(ben.positions.shape, (0, 3))
                until(ben, lambda: ben.time > 0.3)
                # What is held weighs on both.
                weight = sum(body.mass for body in ben.scene.bodies if body.free) * 9.81
                until(ben, lambda: -(ben.grip(0).force[1] + ben.grip(1).force[1]) > 0.5 * weight)
                # Keys by the host's time; then a place; then the scene's own motion again.
                start = ben.handle("right_hand")
                place = np.array(start.position)
                times = ben.time + np.array((0.0, 0.5))
                ben.hold("right_hand", slosh.Keys(times, [place, place + (0, 0.01, 0)], [start.orientation] * 2))
                until(ben, lambda: ben.handle("right_hand").position[1] > place[1] + 0.009)
                ben.hold("right_hand", place)
                until(ben, lambda: abs(ben.handle("right_hand").position[1] - place[1]) < 0.001)
                ben.hold("right_hand", None)
                with self.assertRaises(slosh.Error):
                    ben.hold("left_hand", place)
                ben.let_go("right_hand")
                self.assertEqual(ben.held, [])
                ben.take("right_hand")
                self.assertEqual(ben.held, ["right_hand"])
                with self.assertRaises(slosh.Error):
                    ben.take("left_hand")
                # Ana holds; Ben, by a link of his own, also runs the world.
                self.assertEqual((ana.runs_world, ben.runs_world), (False, True))
                for asked in (ana.pause, ana.reset, lambda: ana.set_viscosity(0, 0.2), lambda: ana.set_gravity_scale(0.5)):
                    with self.assertRaises(slosh.Error) as raised:
                        asked()
                    self.assertIn("role run", str(raised.exception))
                with self.assertRaises(slosh.Error):
                    ben.set_grip_stiffness("left_hand", 2.0)
                ana.set_grip_stiffness("left_hand", 0.9)
                ben.pause()
                until(ben, lambda: ben.rate == 0.0)
                ben.pause(False)
                until(ben, lambda: ben.rate > 0.0)
                ben.set_viscosity(0, 0.2)
                with self.assertRaises(KeyError):
                    ben.body("spoon")
            self.assertEqual(ben.state, "ended")
            with self.assertRaises(slosh.Error):
                ben.hold("right_hand", place)
            samples = ana.samples()
            self.assertEqual(samples["wrenches"].shape, (len(samples["time"]), 6))
            self.assertGreater(len(samples["time"]), 50)
            self.assertTrue((np.diff(samples["time"]) > 0).all())
            until(ana, lambda: len(ana.positions) > 100)
            picture = ana.positions
            kept = picture.copy()
            ana.wait(0.2)
            np.testing.assert_array_equal(picture, kept)
            with slosh.join(link_file=self.links, watch=True, timeout=60.0) as cyd:
                self.assertEqual(cyd.held, [])
                until(cyd, lambda: cyd.time > 0.3)
            # The host ends: who waits is told.
            self.host.terminate()
            with self.assertRaises(slosh.Error):
                until(ana, lambda: False)


if __name__ == "__main__":
    unittest.main()
