"""A hand that gives way: a program closes the loop. It holds a ball in syrup by a force, not by a place: each step it reads
what it feels and lets its hand go where a small mass with a damper would go, pulled by 0.1 N. The ball ends at the speed
at which the fluid's drag is that force, and twice the force makes it twice as fast: Stokes, and no turbulence.
"""

import numpy as np
import slosh

MASS, DAMPER = 0.05, 2.0  # of the hand's own, kg and N·s/m


def scene() -> slosh.Scene:
    builder = slosh.SceneBuilder(title="A ball in syrup", gravity_m_s2=(0, -1e-6, 0))
    builder.body("trough", slosh.tank((0.24, 0.09, 0.10), 0.02))
    builder.fluid("syrup", slosh.box((-0.12, 0.02, -0.05), (0.12, 0.10, 0.05)), density_kg_m3=1200.0, viscosity_pa_s=5.0)
    builder.body("ball", slosh.sphere(0.02), pose=(-0.06, 0.06, 0), motion="free", density_kg_m3=1200.0)
    builder.grip("finger", on="ball", stiffness_n_m=500.0, damping_n_s_m=10.0)
    return builder.scene()


def pulled(newtons: float) -> float:
    """m/s of the ball once it goes steadily."""
    world = slosh.World(scene(), 0.010, threads=1)
    place = world.scene.grip_start("finger").position
    velocity = np.zeros(3)

    def gives_way(time: float) -> slosh.Pose:
        nonlocal place, velocity
        force = world.grip("finger").force + (newtons, 0.0, 0.0) - DAMPER * velocity
        velocity = velocity + force / MASS * world.time_step
        place = place + velocity * world.time_step
        return slosh.Pose(place, velocity=velocity)

    world.hold("finger", gives_way)
    run = world.run(0.6)
    speed = np.gradient(run.body_centers[:, 1, 0], run.time)
    return float(speed[run.time > 0.4].mean())


def main() -> None:
    once, twice = pulled(0.1), pulled(0.2)
    print(f"0.1 N: {1e3 * once:.2f} mm/s; 0.2 N: {1e3 * twice:.2f} mm/s, {twice / once:.3f} times as fast")
    assert once > 0.001 and abs(twice / once - 2) < 0.1


if __name__ == "__main__":
    main()
