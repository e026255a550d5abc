"""What somebody models first: a mug is poured over a funnel into a tray with a rim, everything default."""

import math
import os
import tempfile
import unittest

import slosh

SPACING = 0.008  # m
SECONDS = 5.5


def pour(time: float) -> slosh.Pose:
    share = 0.5 - 0.5 * math.cos(math.pi * min(max((time - 0.3) / 3.5, 0.0), 1.0))
    return slosh.Pose.turned((0, 0, 1), 2.0 * share, (0.06, 0.365, 0))


def mug_over_funnel(model: str = "corrected", support_ratio: float = 2.0, **walls: float) -> slosh.SceneBuilder:
    builder = slosh.SceneBuilder(
        title="A mug over a funnel over a tray", duration_s=SECONDS, settle_s=0.0, model=model, support_ratio=support_ratio
    )
    builder.body("tray", slosh.tank((0.36, 0.05, 0.36), 0.02), pose=(0, -0.02, 0), **walls)
    funnel = [(0.037, 0.10), (0.037, 0.15), (0.12, 0.225), (0.11, 0.24), (0.025, 0.16), (0.025, 0.10)]
    builder.body("funnel", slosh.lathe(funnel), **walls)
    mug = [(0, 0), (0.058, 0), (0.058, 0.11), (0.046, 0.11), (0.046, 0.012), (0, 0.012)]
    builder.body("mug", slosh.lathe(mug), motion="free", mass_kg=0.3, pose=(0.118, 0.255, 0), **walls)
    water = [(0, 0.0125), (0.0455, 0.0125), (0.0455, 0.0985), (0, 0.0985)]
    builder.fluid("water", slosh.lathe(water), pose=(0.118, 0.255, 0))
    builder.grip("lip", on="mug", pose=(-0.058, 0.11, 0))
    builder.hand("hand", "lip", pour, duration=SECONDS)
    builder.camera((0.5, 0.5, 0.8), (0, 0.15, 0))
    return builder


def lost(builder: slosh.SceneBuilder) -> float:
    """kg that left the domain, of 0.558."""
    world = slosh.World(builder.scene(), SPACING)
    before = world.measure().mass
    world.run(SECONDS, every=1000)
    return float(before - world.measure().mass)


class FirstScene(unittest.TestCase):
    def test_nothing_is_wrong_with_it(self):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "mug.glb")
            mug_over_funnel().write(file)
            self.assertEqual(slosh.check(file), [])

    def test_what_is_poured_stays(self):
        # Reached: 0.025 kg, at 6 and 10 mm 0.020 and 0.045: 0.088 until impacts were damped (sim/viscosity/artificial_viscosity.h).
        # By the published model 0.45 of 0.55 kg of such a mug were gone.
        self.assertLess(lost(mug_over_funnel()), 0.035)

    def test_a_wider_support_keeps_no_more_on_a_thin_tray(self):
        # Reached: 0.037 kg; at 6 and 10 mm 0.010 and 0.041. On a tray of 5 cm, and on this one while its walls counted
        # for less than their thickness (tests/notebook/2026-11-26-thin-walls.md), next to nothing.
        self.assertLess(lost(mug_over_funnel(support_ratio=2.5)), 0.05)

    def test_pressures_that_are_solved_for_keep_it(self):
        # What the program advises where fluid was lost. Reached: 0.005 kg; at 6 and 10 mm 0.008 and 0.007.
        self.assertLess(lost(mug_over_funnel("incompressible")), 0.012)

    def test_walls_of_honey_keep_all_of_it(self):
        # And this. Reached: nothing is lost.
        self.assertLess(lost(mug_over_funnel(viscosity_pa_s=2.0)), 0.005)


if __name__ == "__main__":
    unittest.main()
