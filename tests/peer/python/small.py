"""A scene that steps in a tenth of a millisecond: a ball on a hand in a small tank."""

import math

import slosh

START = (0.0, 0.07, 0.0)


def path(t):
    return 0.01 * math.sin(8 * t), 0.07, 0.0


def scene():
    builder = slosh.SceneBuilder(title="small", duration_s=1.0)
    builder.body("tank", slosh.tank((0.10, 0.10, 0.10), 0.02))
    builder.fluid("water", slosh.box((-0.05, 0.02, -0.05), (0.05, 0.08, 0.05)), viscosity_pa_s=0.5)
    builder.body("ball", slosh.sphere(0.02), pose=START, motion="free", mass_kg=0.1)
    builder.grip("finger", on="ball", stiffness_n_m=500.0, damping_n_s_m=10.0)
    builder.hand("motion", "finger", path, duration=1.0)
    return builder.scene()


_scene = scene()


def world(**options):
    return slosh.World(_scene, 0.011, threads=1, settle=False, **options)
