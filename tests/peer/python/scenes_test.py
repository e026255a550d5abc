"""Scenes: read, changed, built, checked, planned; what is refused."""

import os
import pathlib
import tempfile
import unittest

import numpy as np
import slosh


class Reading(unittest.TestCase):
    def test_the_shipped_ones_are_there(self):
        names = [name for name, _ in slosh.scenes()]
        self.assertEqual(names, ["bucket", "spoon", "pour", "spin", "pool", "probe", "crepe", "mixer", "vessel"])
        for name, title in slosh.scenes():
            scene = slosh.load_scene(name)
            self.assertEqual(scene.title, title)
            self.assertGreaterEqual(len(scene.grips), 1)
            fluid, surface = scene.estimate(0.02)
            self.assertGreater(fluid, 0)
            self.assertGreater(surface, 0)

    def test_a_scene_says_what_is_in_it(self):
        scene = slosh.load_scene("bucket")
        self.assertEqual([grip.name for grip in scene.grips], ["left_hand", "right_hand"])
        held = scene.bodies[scene.grips[0].body]
        self.assertTrue(held.free and held.mass > 0.1)
        np.testing.assert_allclose(scene.gravity, (0, -9.81, 0))
        self.assertEqual(scene.model, "corrected")
        low, high = scene.domain
        self.assertTrue((low < high).all())
        hand = scene.grips[0].hand
        self.assertEqual(hand.poses.shape, (len(hand), 7))
        np.testing.assert_allclose(hand.at(0.0).position, scene.grip_start("left_hand").position, atol=0.05)

    def test_edits_are_made_before_anything_is_checked(self):
        scene = slosh.load_scene("spoon", {"fluid.viscosity_pa_s": 3.5, "scene.duration_s": 2})
        self.assertEqual(scene.fluids[0].viscosity, 3.5)
        self.assertEqual(scene.duration, 2.0)
        for edits, word in [
            ({"fluid.viscosity_pa_s": -1.0}, "viscosity_pa_s"),
            ({"nobody.mass_kg": 1.0}, "nobody"),
            ({"fluid.colour": 1.0}, "colour"),
        ]:
            with self.assertRaises(slosh.Error) as raised:
                slosh.load_scene("spoon", edits)
            self.assertIn(word, str(raised.exception))
        with self.assertRaises(ValueError):
            slosh.load_scene("spoon", {"viscosity": 1.0})
        with self.assertRaises(slosh.Error) as raised:
            slosh.load_scene("bathtub")
        self.assertIn("bucket", str(raised.exception))

    def test_plans_say_their_passes(self):
        plan = slosh.make_plan(slosh.load_scene("bucket"), 0.01)
        self.assertIn("density", plan.passes)
        self.assertFalse(set(plan.passes) & set(plan.left_out))
        self.assertGreater(plan.time_step, 0)
        self.assertIn("density", str(plan))
        with self.assertRaises(ValueError):
            slosh.make_plan(slosh.load_scene("bucket"), 7.0)


class Building(unittest.TestCase):
    def tank(self, **fields):
        builder = slosh.SceneBuilder(title="t", **fields)
        builder.body("tank", slosh.tank((0.2, 0.12, 0.2), 0.03), measured=True)
        water = slosh.box((-0.1, 0.03, -0.1), (0.1, 0.11, 0.1))
        builder.fluid("water", water, density_kg_m3=900.0, viscosity_pa_s=0.05)
        return builder, water

    def test_shapes_have_the_volume_that_they_should(self):
        self.assertAlmostEqual(slosh.box((0, 0, 0), (1, 2, 3)).volume, 6.0)
        self.assertAlmostEqual(slosh.tank((1, 1, 1), 0.5).volume, 2 * 2 * 1.5 - 1)
        self.assertAlmostEqual(slosh.sphere(1.0, 60, 120).volume, 4.18879, delta=0.01)
        self.assertAlmostEqual(slosh.capsule(1.0, 0.0, 1.0, 40, 80).volume, 4.18879 + 3.14159, delta=0.03)
        cone = slosh.lathe([(0, 0), (1, 0), (0, 1)], 200)
        self.assertAlmostEqual(cone.volume, 1.0472, delta=0.001)
        moved = cone.moved(slosh.Pose.turned((1, 0, 0), 1.0, (5, 5, 5)))
        self.assertAlmostEqual(moved.volume, cone.volume)
        both = cone + slosh.box((4, 0, 0), (5, 1, 1))
        self.assertAlmostEqual(both.volume, cone.volume + 1.0)
        again = slosh.Mesh(both.points, both.triangles)
        self.assertAlmostEqual(again.volume, both.volume)
        with self.assertRaises(ValueError):
            slosh.Mesh(np.zeros((3, 3)), [[0, 1, 3]])
        with self.assertRaises(ValueError):
            slosh.box((0, 0, 0), (1, 0, 1))

    def test_a_tank_is_built_and_its_water_weighs_on_its_floor(self):
        builder, water = self.tank(settle_s=0.5)
        builder.gauge("middle", (0, 0.06, 0))
        builder.region("left", slosh.box((-0.1, 0, -0.1), (0, 0.2, 0.1)))
        scene = builder.scene()
        self.assertEqual((scene.gauges, scene.regions), (["middle"], ["left"]))
        world = slosh.World(scene, 0.01, threads=1)
        run = world.run(0.2)
        measured = world.measure()
        self.assertAlmostEqual(measured.mass, 900.0 * water.volume, delta=0.02 * measured.mass)
        self.assertAlmostEqual(run.fluid_wrenches[:, 0, 1].mean(), -9.81 * measured.mass, delta=0.01 * 9.81 * measured.mass)
        self.assertAlmostEqual(measured.masses[0], 0.5 * measured.mass, delta=0.1 * measured.mass)
        self.assertAlmostEqual(measured.levels[0], 0.11, delta=0.01)
        self.assertAlmostEqual(measured.pressures[0], 900 * 9.81 * 0.05, delta=150)
        self.assertEqual(measured.lost, 0)

    def test_a_probe_and_a_hand_by_a_function(self):
        builder, _ = self.tank(duration_s=1.0)
        builder.probe("tip", (0, 0.09, 0), mass_kg=0.05)
        builder.grip("finger", on="tip", stiffness_n_m=200.0)
        builder.hand("dip", "finger", lambda t: (0.01 * t, 0.09, 0), duration=1.0, rate=30)
        scene = builder.scene()
        self.assertTrue(scene.bodies[1].point_probe)
        self.assertAlmostEqual(scene.grips[0].hand.at(1.0).position[0], 0.01, delta=1e-6)

    def test_what_is_wrong_is_said_as_for_a_file(self):
        for fields, word in [({"density_kg_m3": -1.0}, "density_kg_m3"), ({"desnity_kg_m3": 1.0}, "desnity_kg_m3")]:
            builder, water = self.tank()
            builder.fluid("oil", water.moved((5, 0, 0)), **fields)
            with self.assertRaises(slosh.Error) as raised:
                builder.scene()
            self.assertIn(word, str(raised.exception))
            self.assertIn("oil", str(raised.exception))
        builder, water = self.tank()
        with self.assertRaises(ValueError):
            builder.fluid("water", water)
        with self.assertRaises(KeyError):
            builder.grip("handle", on="nothing")
        with self.assertRaises(ValueError):
            builder.hand("h", "g", lambda t: (0, 0, 0))
        with self.assertRaises(TypeError):
            builder.body("x", water, friction=object())
        open_box = slosh.Mesh(water.points, water.triangles[1:])
        builder.body("open", open_box)
        with self.assertRaises(slosh.Error) as raised:
            builder.scene()
        self.assertIn("open", str(raised.exception))

    def test_files_are_written_and_findings_told_apart(self):
        with tempfile.TemporaryDirectory() as folder:
            for name in ("tank.glb", "tank.gltf"):
                file = os.path.join(folder, name)
                self.tank()[0].write(file)
                findings = slosh.check(file)
                self.assertEqual([f.kind for f in findings if f.is_error], [])
                self.assertIn("no-camera", [f.kind for f in findings])
                self.assertEqual(slosh.load_scene(file).fluids[0].density, 900.0)
                self.assertEqual(slosh.load_scene(pathlib.Path(file)).name, "tank")
            with self.assertRaises(ValueError):
                self.tank()[0].write(os.path.join(folder, "tank.obj"))
            with self.assertRaises(slosh.Error):
                self.tank()[0].write(os.path.join(folder, "no", "such", "folder.glb"))
            broken = os.path.join(folder, "broken.gltf")
            with open(broken, "w") as file:
                file.write("{}")
            found = slosh.check(broken)
            self.assertTrue(found and found[0].is_error and "broken" in str(found[0]))


if __name__ == "__main__":
    unittest.main()
