"""slosh.analysis against fields that are known."""

import os
import subprocess
import tempfile
import unittest

import numpy as np
import slosh
from slosh import analysis
from small import world


def block(spacing=0.01, side=20):
    """Particles of a cube from 0 to side · spacing."""
    line = (np.arange(side) + 0.5) * spacing
    return np.stack(np.meshgrid(line, line, line), axis=-1).reshape(-1, 3)


class Fields(unittest.TestCase):
    def test_a_linear_field_is_read_between_particles(self):
        at = block()
        points = np.random.default_rng(1).uniform(0.05, 0.15, (50, 3))
        gradient = np.array([[1.0, -2.0, 0.5], [0.0, 3.0, 1.0]])
        said, filled = analysis.field_at(at, at @ gradient.T, points, 0.02, 0.01)
        self.assertEqual(said.shape, (50, 2))
        np.testing.assert_allclose(said, points @ gradient.T, atol=2e-3)
        np.testing.assert_allclose(filled, 1.0, atol=0.06)

    def test_it_says_where_fluid_ends(self):
        at = block()
        points = [[0.1, 0.1, 0.1], [0.1, 0.2, 0.1], [0.1, 0.5, 0.1]]
        said, filled = analysis.field_at(at, np.ones(len(at)), points, 0.02, 0.01)
        np.testing.assert_allclose(filled, (1.0, 0.5, 0.0), atol=0.06)
        np.testing.assert_allclose(said[:2], 1.0)
        self.assertTrue(np.isnan(said[2]))
        with self.assertRaises(ValueError):
            analysis.field_at(at, at, points, 0.0, 0.01)

    def test_it_agrees_with_a_plain_sum_and_leaves_out_what_has_left(self):
        random = np.random.default_rng(2)
        at, values, points = random.uniform(0, 0.1, (300, 3)), random.normal(size=300), random.uniform(-0.02, 0.12, (40, 3))
        values[7] = np.nan
        said, _ = analysis.field_at(at, values, points, 0.025, 0.01)
        for point, one in zip(points, said):
            q = np.linalg.norm(at - point, axis=1) / 0.025
            w = np.where((q < 1) & np.isfinite(values), np.clip(1 - q, 0, None) ** 4 * (1 + 4 * q), 0)
            if w.sum() == 0:
                self.assertTrue(np.isnan(one))
            else:
                self.assertAlmostEqual(one, np.nansum(w * np.nan_to_num(values)) / w.sum(), places=12)

    def test_profiles(self):
        at = block()
        mean, count = analysis.profile(at[:, 1], at[:, 1] ** 2, np.linspace(0, 0.3, 4))
        self.assertEqual(list(count), [4000, 4000, 0])
        self.assertAlmostEqual(mean[0], np.mean(((np.arange(10) + 0.5) * 0.01) ** 2))
        self.assertTrue(np.isnan(mean[2]))

    def test_pressure_in_still_water_rises_with_depth(self):
        w = world(hands={"finger": None})
        w.settle(1.0)
        w.run(0.1)
        # From the second layer on: the first, at a wall, has a pressure of its own
        # (tests/notebook/2026-11-23-still-water-turns-over.md).
        edges = np.linspace(0.03, 0.065, 5)
        mean, count = analysis.profile(w.positions[:, 1], w.pressures, edges)
        self.assertTrue((count > 10).all())
        slope = np.polyfit(0.5 * (edges[1:] + edges[:-1]), mean, 1)[0]
        self.assertAlmostEqual(slope / -9810, 1.0, delta=0.25)


class Fits(unittest.TestCase):
    def test_a_sine_is_found_in_noise(self):
        time = np.linspace(0, 3, 1000)
        values = 2.0 + 0.5 * np.cos(2 * np.pi * 1.7 * time + 0.3) + np.random.default_rng(3).normal(0, 0.1, 1000)
        amplitude, mean, left = analysis.fit_sine(time, values, 1.7)
        self.assertAlmostEqual(abs(amplitude), 0.5, delta=0.02)
        self.assertAlmostEqual(np.angle(amplitude), 0.3, delta=0.04)
        self.assertAlmostEqual(mean, 2.0, delta=0.02)
        self.assertAlmostEqual(left, 0.1, delta=0.02)


class Families(unittest.TestCase):
    def test_every_combination_is_run_and_the_wrong_refused_before_the_first(self):
        ran = []

        def measure(w):
            ran.append(w)
            w.step()
            return {"viscosity": w.viscosity(0), "stiffness": w.scene.grips[0].stiffness}

        values = {"fluid.viscosity_pa_s": [0.5, 2.0], "grip.stiffness_n_m": [100.0, 200.0, 300.0]}
        table = slosh.sweep("probe", values, measure, threads=1, settle=False)
        self.assertEqual(list(table), [*values, "viscosity", "stiffness"])
        np.testing.assert_array_equal(table["viscosity"], [0.5] * 3 + [2.0] * 3)
        np.testing.assert_array_equal(table["stiffness"], [100, 200, 300] * 2)
        ran.clear()
        with self.assertRaises(slosh.Error):
            slosh.sweep("probe", {"fluid.viscosity_pa_s": [0.5, -2.0]}, measure)
        self.assertEqual(ran, [])

    def test_tables_are_those_of_the_program(self):
        w = slosh.World(slosh.load_scene("probe"), threads=1, settle=False)
        run = w.run(0.2)
        with tempfile.TemporaryDirectory() as folder:
            analysis.write_tables(run, folder)
            rows = np.genfromtxt(os.path.join(folder, "wrenches.csv"), delimiter=",", names=True)
            self.assertEqual(len(rows), len(run.time))
            np.testing.assert_allclose(rows["fy_n"], run.wrenches[:, 0, 1], rtol=1e-6, atol=1e-9)
            program = [os.environ["SLOSH_PROGRAM"], "play", "probe", "--headless", "--no-render", "--unpaced", "--seconds", "0.1",
                       "--spacing", str(w.spacing), "--threads", "1", "--out", "out"]
            said = subprocess.run([*program, "--device", "replay:poses.csv"], cwd=folder, capture_output=True, text=True)
            self.assertEqual(said.returncode, 0, said.stderr)


if __name__ == "__main__":
    unittest.main()
