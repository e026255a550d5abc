"""Hands: poses, keys, functions, scripts."""

import math
import unittest

import numpy as np
import slosh
from small import path, world


class Poses(unittest.TestCase):
    def test_poses_compose_and_turn(self):
        quarter = slosh.Pose.turned((0, 0, 2), math.pi / 2, (1, 0, 0))
        np.testing.assert_allclose(quarter.transform((1, 0, 0)), (1, 1, 0), atol=1e-12)
        np.testing.assert_allclose((quarter @ quarter.inverse()).position, 0, atol=1e-12)
        np.testing.assert_allclose(quarter.orientation, (math.sqrt(0.5), 0, 0, math.sqrt(0.5)), atol=1e-12)
        self.assertIsNone(quarter.velocity)

    def test_what_is_no_pose_is_refused_in_words(self):
        for wrong in [(1, 2), (1, 2, 3, 4), "there", object()]:
            with self.assertRaises((TypeError, ValueError)):
                world().hold(0, wrong)
        with self.assertRaises(ValueError) as raised:
            slosh.Pose((0, 0, 0), (1, 1, 0, 0))
        self.assertIn("length 1", str(raised.exception))
        with self.assertRaises(ValueError):
            slosh.Pose((0, float("nan"), 0))
        with self.assertRaises(KeyError) as raised:
            world().hold("elbow", None)
        self.assertIn("finger", str(raised.exception))
        for times in [(0, 0), (1, 0)]:
            with self.assertRaises(ValueError):
                slosh.Keys(times, np.zeros((2, 3)))
        with self.assertRaises(ValueError):
            slosh.Keys((0, 1), np.zeros((3, 3)))


class Holding(unittest.TestCase):
    def setUp(self):
        self.start = world().scene.grip_start(0)

    def felt(self, source):
        w = world(hands={0: source})
        return w, w.run(0.2)

    def test_the_scenes_script_is_its_keys(self):
        scripted, _ = self.felt("script")
        by_keys, _ = self.felt(scripted.scene.grips[0].hand)
        self.assertEqual(scripted.hash, by_keys.hash)

    def test_a_pose_in_all_its_forms_is_the_same(self):
        p, q = self.start.position, self.start.orientation
        hashes = {
            self.felt(source)[0].hash
            for source in (self.start, (p, q), [*p, *q], tuple(p), np.array([*p, *q]), lambda t: self.start)
        }
        self.assertEqual(len(hashes), 1)

    def test_a_function_follows_what_keys_follow(self):
        times = np.linspace(0, 0.3, 301)
        places = np.array([path(t) for t in times])
        turns = np.tile(self.start.orientation, (len(times), 1))
        _, by_keys = self.felt(slosh.Keys(times, places, turns))
        _, by_function = self.felt(path)
        np.testing.assert_allclose(by_function.handles, by_keys.handles, atol=2e-6)
        scale = np.abs(by_keys.wrenches[:, :, :3]).max()
        self.assertLess(np.abs(by_function.wrenches - by_keys.wrenches)[20:, :, :3].max(), 0.1 * scale)

    def test_velocities_that_are_given_are_used(self):
        def exact(t):
            return slosh.Pose(path(t), self.start.orientation, (0.08 * math.cos(8 * t), 0, 0), (0, 0, 0))

        times = np.linspace(0, 0.3, 301)
        turns = np.tile(self.start.orientation, (len(times), 1))
        _, by_keys = self.felt(slosh.Keys(times, [path(t) for t in times], turns))
        _, by_function = self.felt(exact)
        scale = np.abs(by_keys.wrenches[:, :, :3]).max()
        self.assertLess(np.abs(by_function.wrenches - by_keys.wrenches)[by_keys.time > 0.1, :, :3].max(), 0.02 * scale)

    def test_who_lets_go_feels_nothing(self):
        _, none = self.felt(None)
        self.assertEqual(np.abs(none.wrenches).max(), 0.0)
        _, sometimes = self.felt(lambda t: path(t) if t < 0.1 else None)
        self.assertGreater(np.abs(sometimes.wrenches[sometimes.time < 0.09]).max(), 0.0)
        self.assertEqual(np.abs(sometimes.wrenches[sometimes.time > 0.11]).max(), 0.0)

    def test_the_coupling_is_the_grips_spring(self):
        w = world()
        w.step()
        grip = w.scene.grips[0]
        at = w.grip(0).pose
        away = slosh.Pose(at.position + (0.0, 0.001, 0.0), at.orientation)
        w.hold(0, away)
        w.step()
        pull = -w.grip(0).force[1]
        self.assertGreater(pull, 0.3 * grip.stiffness * 0.001)
        self.assertLess(pull, 1.1 * grip.stiffness * 0.001 + grip.damping * 0.01 + 1.0)
        np.testing.assert_allclose(w.grip(0).handle.position, away.position)

    def test_a_function_sees_the_world_as_it_is_by_then(self):
        w = world()
        seen = []

        def looks(t):
            seen.append((w.time, w.tick, w.grip("finger").force[1], w.body("ball").center_of_mass[0], w.positions[0, 1]))
            self.assertEqual(t, w.time)
            return path(t)

        w.hold("finger", looks)
        run = w.run(0.2)
        self.assertEqual(len(seen), len(run.time))
        self.assertEqual([row[1] for row in seen], list(range(len(seen))))
        np.testing.assert_allclose([row[2] for row in seen[1:]], run.wrenches[:-1, 0, 1])
        np.testing.assert_allclose([row[3] for row in seen[1:]], run.body_centers[:-1, 1, 0])
        self.assertGreater(len({row[4] for row in seen}), len(seen) // 2)

    def test_what_a_function_raises_comes_out(self):
        def breaks(t):
            if t > 0.05:
                raise LookupError("no more poses")
            return path(t)

        w = world(hands={0: breaks})
        with self.assertRaises(LookupError):
            w.run(1.0)
        self.assertGreater(w.time, 0.04)
        self.assertLess(w.time, 0.06)
        w.hold(0, "script")
        w.step()


if __name__ == "__main__":
    unittest.main()
