"""slosh.World: memory, threads, endings, refusals."""

import gc
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy as np
import slosh
from small import world



def address(array):
    return array.__array_interface__["data"][0]


class Memory(unittest.TestCase):
    def test_arrays_have_the_shapes_and_types_that_the_docstrings_say(self):
        w = world()
        w.step(2)
        n = w.particles
        self.assertGreater(n, 200)
        for name, shape, kind in [
            ("positions", (n, 3), np.float32),
            ("velocities", (n, 3), np.float32),
            ("pressures", (n,), np.float32),
            ("fluid_index", (n,), np.uint8),
        ]:
            array = getattr(w, name)
            self.assertEqual(array.shape, shape, name)
            self.assertEqual(array.dtype, kind, name)
            self.assertFalse(array.flags.writeable, name)
            self.assertFalse(array.flags.owndata, "a view of the library's memory")
            with self.assertRaises(ValueError):
                array[0] = 0
        self.assertTrue(np.isfinite(w.pressures).all())

    def test_the_same_moment_is_the_same_memory_and_a_kept_array_stays_as_it_is(self):
        w = world()
        w.step()
        first = w.positions
        self.assertEqual(address(first), address(w.positions), "no copy a call")
        kept = first.copy()
        w.step(20)
        later = w.positions
        np.testing.assert_array_equal(first, kept, "the moment that was")
        self.assertGreater(np.abs(later - first).max(), 0.0)
        self.assertNotEqual(address(first), address(later))
        # Nobody looks any more: the memory is used again.
        at = address(later)
        del later
        w.step()
        self.assertEqual(address(w.positions), at)

    def test_arrays_live_longer_than_their_world(self):
        w = world()
        w.step()
        positions, part = w.positions, w.positions[10:20, 1]
        kept = part.copy()
        del w, positions
        gc.collect()
        np.testing.assert_array_equal(part, kept)

    def test_velocities_are_what_moves_the_particles(self):
        w = world()
        w.step(30)
        before = w.positions
        w.step()
        moved = (w.positions - before) / w.time_step
        np.testing.assert_allclose(w.velocities, moved, atol=2e-3)


class Runs(unittest.TestCase):
    def test_a_run_has_a_row_a_step_and_repeats_to_the_bit(self):
        a, b = world(), world()
        run = a.run(0.1)
        steps = len(run.time)
        self.assertEqual(steps, round(0.1 / a.time_step))
        grips, bodies = len(a.scene.grips), len(a.scene.bodies)
        self.assertEqual(run.wrenches.shape, (steps, grips, 6))
        self.assertEqual(run.handles.shape, (steps, grips, 7))
        self.assertEqual(run.body_poses.shape, (steps, bodies, 7))
        self.assertEqual(run.body_twists.shape, (steps, bodies, 6))
        self.assertEqual(run.body_centers.shape, (steps, bodies, 3))
        self.assertEqual(run.fluid_wrenches.shape, (steps, bodies, 6))
        self.assertAlmostEqual(run.time[-1], a.time)
        np.testing.assert_array_equal(run.wrenches[-1], a.wrenches)
        b.step(steps)
        self.assertEqual(a.hash, b.hash)
        self.assertEqual(a.tick, b.tick)

    def test_saved_and_restored_it_goes_on_the_same(self):
        w = world()
        w.step(10)
        saved = w.save()
        w.step(10)
        there = w.hash
        w.restore(saved)
        self.assertEqual(w.tick, 10)
        w.step(10)
        self.assertEqual(w.hash, there)
        with self.assertRaises(slosh.Error) as raised:
            w.restore(saved[:100])
        self.assertIn("saved world", str(raised.exception))
        self.assertEqual(w.hash, there, "the world is as it was")

    def test_every_and_on_step(self):
        w = world()
        seen = []

        def look():
            seen.append(w.positions[:, 1].max())
            return len(seen) < 7

        run = w.run(1.0, every=3, on_step=look)
        self.assertEqual(w.tick, 7)
        self.assertEqual(len(run.time), 2)
        self.assertEqual(len(seen), 7)

    def test_in_real_time_it_is_no_faster_than_the_clock(self):
        w = world()
        began = time.monotonic()
        run = w.run(0.3, real_time=True)
        self.assertGreaterEqual(time.monotonic() - began, 0.29)
        self.assertGreaterEqual(run.slipped, 0.0)

    def test_parameters_change_while_it_lives(self):
        w = world()
        fluid = w.scene.fluids[0]
        self.assertAlmostEqual(w.viscosity(fluid.name), fluid.viscosity)
        w.set_viscosity(fluid.name, 0.5 * fluid.viscosity)
        self.assertAlmostEqual(w.viscosity(0), 0.5 * fluid.viscosity)
        w.gravity_scale = 0.5
        self.assertEqual(w.gravity_scale, 0.5)
        with self.assertRaises(slosh.Error):
            w.gravity_scale = 5.0
        grip = w.scene.grips[0].name
        w.set_grip_stiffness(grip, 0.5)
        self.assertEqual(w.grip_stiffness(0), 0.5)
        with self.assertRaises(slosh.Error):
            w.set_grip_stiffness(grip, 100.0)
        with self.assertRaises(KeyError) as raised:
            w.set_viscosity("beer", 1.0)
        self.assertIn(fluid.name, str(raised.exception))

    def test_what_comes_and_goes(self):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "run.rec")
            w = world()
            fluid, body = "water", "ball"
            there = w.measure().particles
            w.record(file)
            w.run(0.1)
            w.take_away(fluid)
            self.assertEqual(w.measure().particles, 0)
            with self.assertRaises(slosh.Error):
                w.take_away(fluid)
            w.take_away(body)
            w.run(0.1)
            w.appear(fluid)
            w.appear(body)
            with self.assertRaises(slosh.Error) as raised:
                w.appear(body)
            self.assertIn("is there already", str(raised.exception))
            w.run(0.1)
            self.assertGreater(w.measure().particles, 0.9 * there)
            with self.assertRaises(KeyError) as raised:
                w.appear("beer")
            self.assertIn(fluid, str(raised.exception))
            w.stop_recording()
            again = slosh.replay(file, threads=1)
            self.assertTrue(again.same, again.verdict)
            changes = [change[1] for change in slosh.Recording(file).changes]
            self.assertEqual(changes, ["take_away", "take_away", "appear", "appear"])

    def test_a_body_is_cut(self):
        builder = slosh.SceneBuilder(title="butter", domain_min_m=[-1, -1, -1], domain_max_m=[1, 1, 1])
        builder.body("board", slosh.box((-0.2, -0.05, -0.2), (0.2, 0, 0.2)))
        builder.body("butter", slosh.box((-0.05, 0, -0.02), (0.05, 0.04, 0.02)), motion="free",
                     density_kg_m3=900, pieces=2)
        w = slosh.World(builder.scene(), 0.01)
        w.run(0.1)
        self.assertGreater(w.body("butter~2").pose.position[0], 1000, "not there yet")
        with self.assertRaises(slosh.Error) as raised:
            w.cut("butter", (1, 0, 0), 0.2)
        self.assertIn("is missed", str(raised.exception))
        self.assertEqual(w.cut("butter", (1, 0, 0), 0.01), "butter~2")
        w.run(0.2)
        # 6 cm stay, 4 cm come off, and stand where they stood.
        self.assertAlmostEqual(w.body("butter").center_of_mass[0], -0.02, 4)
        self.assertAlmostEqual(w.body("butter~2").center_of_mass[0], 0.03, 4)
        with self.assertRaises(slosh.Error) as raised:
            w.cut("butter", (1, 0, 0), 0.0)
        self.assertIn("has all its 2 pieces", str(raised.exception))
        with tempfile.TemporaryDirectory() as folder:
            w.record(os.path.join(folder, "run.rec"))
            with self.assertRaises(slosh.Error):
                w.cut("board", (1, 0, 0), 0.0)

    def test_it_follows_a_task(self):
        self.assertIsNone(world().task)
        builder = slosh.SceneBuilder(title="dip", task=[
            {"say": "Move it.", "until": {"speed_m_s": "ball", "at_least": 0.3}, "then": {"takes_away": "water"}},
            {"say": "Fly.", "until": {"any": [{"speed_m_s": "ball", "at_least": 99},
                                              {"tilt_deg": "ball", "at_least": 90}]}}])
        builder.body("tank", slosh.tank((0.10, 0.10, 0.10), 0.02))
        builder.fluid("water", slosh.box((-0.05, 0.02, -0.05), (0.05, 0.08, 0.05)), viscosity_pa_s=0.5)
        builder.body("ball", slosh.sphere(0.02), pose=(0.0, 0.3, 0.0), motion="free", mass_kg=0.1)
        w = slosh.World(builder.scene(), 0.011, threads=1, settle=False)
        self.assertEqual(w.task["title"], "step 1 of 2")
        w.run(0.1)
        task = w.task
        self.assertEqual([step["done"] for step in task["steps"]], [True, False])
        self.assertAlmostEqual(task["steps"][0]["took_s"], 0.05, delta=0.005)
        self.assertAlmostEqual(task["steps"][0]["measured"][0], 0.05 * 9.81, delta=0.02)
        self.assertEqual(w.measure().particles, 0)
        self.assertIn("speed of ball", task["now"])
        w.reset()
        w.run(0.02)
        self.assertEqual(w.task["title"], "step 1 of 2")

    def test_what_is_wrong_is_said(self):
        scene = slosh.load_scene("spoon")
        for options in [{"spacing": 5.0}, {"spacing": "coarse"}, {"backend": "abacus"}, {"threads": -1}]:
            with self.assertRaises(ValueError, msg=str(options)):
                slosh.World(scene, **options)
        with self.assertRaises(slosh.Error) as raised:
            slosh.World(scene, 0.5)
        error = raised.exception
        self.assertTrue(error.where and error.what, "the parts")
        self.assertIn(error.what, str(error))
        self.assertIsInstance(error, RuntimeError)
        if not slosh.backends()["cuda"]:
            with self.assertRaises(slosh.Error):
                slosh.World(scene, 0.0115, settle=False, backend="cuda")
        for seconds in (0.0, -1.0, float("nan")):
            with self.assertRaises(ValueError):
                world().run(seconds)
        with self.assertRaises(ValueError):
            world().step(0)
        for hands in (5, {"elbow": None}, {0: "by heart"}):
            with self.assertRaises((TypeError, KeyError, ValueError)):
                world(hands=hands)


class Threads(unittest.TestCase):
    def test_others_go_on_while_it_steps_and_are_refused_the_world(self):
        w = world()
        counted, refused = 0, []
        done = threading.Event()

        def step():
            w.run(3.0)
            done.set()

        stepping = threading.Thread(target=step)
        stepping.start()
        while not done.is_set():
            counted += 1
            try:
                w.positions
            except slosh.Error as error:
                refused.append(str(error))
            time.sleep(0.001)
        stepping.join()
        self.assertGreater(counted, 3)
        self.assertTrue(refused)
        self.assertIn("another thread", refused[0])
        self.assertEqual(len(w.positions), w.particles)

    def test_what_it_calls_may_read_but_not_step(self):
        w = world()
        with self.assertRaises(slosh.Error) as raised:
            w.run(0.1, on_step=lambda: w.step())
        self.assertIn("already", str(raised.exception))
        w.step()

        def fails():
            raise ZeroDivisionError("mine")

        tick = w.tick
        with self.assertRaises(ZeroDivisionError):
            w.run(0.1, on_step=fails)
        self.assertEqual(w.tick, tick + 1)
        w.step()

    def interrupted(self, work):
        """A program that does `work` and is sent SIGINT; what it says."""
        program = (
            f"import sys; sys.path.insert(0, {os.path.dirname(os.path.abspath(__file__))!r})\n"
            "from small import world\n"
            "w = world()\n"
            "print('ready', flush=True)\n"
            f"try:\n    {work}\n    print('through')\n"
            "except KeyboardInterrupt:\n    print('interrupted at', w.tick)\n"
            "w.step()\n"
        )
        child = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True)
        self.assertEqual(child.stdout.readline(), "ready\n")
        time.sleep(0.3)
        child.send_signal(signal.SIGINT)
        said, _ = child.communicate(timeout=120)
        self.assertEqual(child.returncode, 0)
        return said

    def test_ctrl_c_ends_long_calls_and_the_world_is_sound(self):
        for work in ("w.run(1e5)", "w.step(10**9)", "w.run(1e5, real_time=True)", "w.settle(60.0)",
                     "w.hold(0, lambda t: (0, 0.07, 0)) or w.run(1e5)"):
            self.assertIn("interrupted at", self.interrupted(work), work)

    def test_ctrl_c_ends_reading_a_file_too(self):
        # A file that takes seconds to read: it is still read, on the thread that was left behind.
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "heavy.glb")
            builder = slosh.SceneBuilder()
            builder.body("ball", slosh.sphere(0.1, rings=700, segments=700))
            builder.write(file)
            for call in ("load_scene", "check"):
                program = (
                    "import os, slosh\n"
                    "threads = lambda: len(os.listdir('/proc/self/task'))\n"
                    "before = threads()\n"
                    "print('ready', flush=True)\n"
                    f"try:\n    slosh.{call}({file!r})\n"
                    "except KeyboardInterrupt:\n    print(threads() - before, 'left behind')\n"
                )
                child = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True)
                self.assertEqual(child.stdout.readline(), "ready\n")
                time.sleep(0.3)
                child.send_signal(signal.SIGINT)
                said, _ = child.communicate(timeout=120)
                self.assertEqual(child.returncode, 0, call)
                self.assertEqual(said, "1 left behind\n", call)

    def test_ctrl_c_while_a_pose_is_read_is_no_complaint_about_the_pose(self):
        class Interrupted:
            def __array__(self, *_, **__):
                raise KeyboardInterrupt

        w = world()
        with self.assertRaises(KeyboardInterrupt):
            w.hold(0, Interrupted())
        with self.assertRaises(KeyboardInterrupt):
            w.hold(0, (Interrupted(), (1, 0, 0, 0)))
        with self.assertRaises(KeyboardInterrupt):
            slosh.Keys((0, 1), ((0, 0, 0), (0, 0, 0)), Interrupted())
        w.hold(0, (0, 0.07, 0))
        w.step()


class Resets(unittest.TestCase):
    def test_a_world_that_was_reset_runs_again_to_the_bit(self):
        w = world()
        first = w.run(0.1)
        at = w.hash
        w.reset()
        self.assertEqual(w.time, 0.0)
        self.assertEqual(w.tick, 0)
        again = w.run(0.1)
        self.assertEqual(w.hash, at)
        np.testing.assert_array_equal(first.wrenches, again.wrenches)

    def test_what_was_set_stays_set(self):
        w = world()
        w.set_viscosity(0, 0.3)
        w.gravity_scale = 0.5
        w.step(10)
        w.reset()
        self.assertEqual((w.viscosity(0), w.gravity_scale, w.tick), (0.3, 0.5, 0))

    def test_a_recording_goes_on_through_it(self):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "run.rec")
            w = world()
            w.record(file)
            w.run(0.2)
            w.reset()
            w.run(0.1)
            w.stop_recording()
            self.assertTrue(slosh.replay(file).same)


class Names(unittest.TestCase):
    def test_a_misspelt_name_is_answered_with_the_nearest(self):
        w = world()
        name = w.scene.grips[0].name
        with self.assertRaises(KeyError) as raised:
            w.hold(name + "x", None)
        self.assertIn(f"Did you mean {name}?", str(raised.exception))
        with self.assertRaises(KeyError) as raised:
            slosh.World(w.scene, hands={name[:-1] + "x": None})
        self.assertIn(f"Did you mean {name}?", str(raised.exception))
        with self.assertRaises(ValueError) as raised:
            w.hold(name, "scirpt")
        self.assertIn("Did you mean script?", str(raised.exception))
        with self.assertRaises(slosh.Error) as raised:
            slosh.load_scene("spoon", {"fluid.viscosty_pa_s": 2.0})
        self.assertIn("Did you mean viscosity_pa_s?", str(raised.exception))
        with self.assertRaises(slosh.Error) as raised:
            slosh.load_scene("spoon", {"spon.friction": 0.5})
        self.assertIn("Did you mean spoon?", str(raised.exception))
        builder = slosh.SceneBuilder()
        builder.body("bowl", slosh.box((0, 0, 0), (0.1, 0.1, 0.1)), motion="free", mass_kg=1.0)
        with self.assertRaises(KeyError) as raised:
            builder.grip("rim", on="bowll")
        self.assertIn("Did you mean bowl?", str(raised.exception))


class Recordings(unittest.TestCase):
    def test_what_is_recorded_is_replayed_the_same_and_by_the_program_too(self):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "run.rec")
            w = world()
            w.record(file)
            with self.assertRaises(slosh.Error):
                w.record(file)
            with self.assertRaises(slosh.Error):
                w.settle(0.1)
            run = w.run(0.4)
            w.stop_recording()
            w.stop_recording()
            with self.assertRaises(slosh.Error):
                w.record(file)
            again = slosh.replay(file, threads=1)
            self.assertTrue(again.same, again.verdict)
            np.testing.assert_array_equal(again.run.wrenches, run.wrenches)
            self.assertEqual(len(slosh.Recording(file).time), len(run.time))
            said = subprocess.run([os.environ["SLOSH_PROGRAM"], "replay", file, "--no-render", "--out", "again"],
                                  cwd=folder, capture_output=True, text=True)
            self.assertEqual(said.returncode, 0, said.stderr)
            with open(file, "rb") as whole:
                damaged = bytearray(whole.read())
            damaged[len(damaged) // 2] ^= 0xFF
            with open(file, "wb") as changed:
                changed.write(damaged)
            with self.assertRaises(slosh.Error):
                slosh.Recording(file)
            with self.assertRaises(slosh.Error) as raised:
                slosh.Recording(os.path.join(folder, "none.rec"))
            self.assertIn("none.rec", str(raised.exception))


if __name__ == "__main__":
    unittest.main()
