"""Which fluid is in the cup? A stirring hand's power tells its viscosity.

A slow stick in a viscous fluid takes a force in proportion to its speed and to the viscosity, so the mean power of a
hand that stirs is a + b · viscosity. Two fluids that are known give a and b; a third is then found from what the hand
felt, and compared with the value that was put in.
"""

import math
from typing import Tuple

import numpy as np
import slosh

RADIUS, TURN = 0.020, 2 * math.pi / 0.8  # m, rad/s: 0.16 m/s


def cup(viscosity: float) -> slosh.Scene:
    builder = slosh.SceneBuilder(title="A stick in a cup", duration_s=2.0, settle_s=0.2)
    builder.body("cup", slosh.tank((0.10, 0.09, 0.10), 0.02), color=(0.8, 0.8, 0.8, 0.3))
    fill = slosh.box((-0.05, 0.02, -0.05), (0.05, 0.08, 0.05))
    builder.fluid("syrup", fill, density_kg_m3=1200.0, viscosity_pa_s=viscosity)
    stick = slosh.capsule(0.012, 0.05, 0.13)
    builder.body("stick", stick, pose=(RADIUS, 0, 0), motion="free", mass_kg=0.05)
    builder.grip(
        "hand",
        on="stick",
        pose=(0, 0.13, 0),
        stiffness_n_m=3000.0,
        damping_n_s_m=20.0,
        rotational_stiffness_nm_rad=50.0,
        rotational_damping_nm_s_rad=1.0,
    )
    return builder.scene()


def stir(time: float) -> Tuple[float, float, float]:
    """Where the hand is, m: at rest at first, then round and round."""
    angle = TURN * (time - 0.2 * math.tanh(time / 0.2))
    return RADIUS * math.cos(angle), 0.13, -RADIUS * math.sin(angle)


def stirring_power(viscosity: float) -> float:
    """W that the hand puts in, mean over one turn once the fluid goes round."""
    world = slosh.World(cup(viscosity), 0.010, threads=1, hands={"hand": stir})
    run = world.run(1.4)
    path = run.handles[:, 0, :3]
    velocity = np.gradient(path, run.time, axis=0)
    power = -np.einsum("ij,ij->i", run.wrenches[:, 0, :3], velocity)
    return float(power[run.time > 0.6].mean())


def main() -> None:
    known = (1.0, 4.0)
    power = [stirring_power(mu) for mu in known]
    slope = (power[1] - power[0]) / (known[1] - known[0])
    for mu, watts in zip(known, power):
        print(f"known   {mu:.2f} Pa·s: {1e3 * watts:.2f} mW")
    for secret in (2.0, 3.0):
        watts = stirring_power(secret)
        found = known[0] + (watts - power[0]) / slope
        print(f"unknown {secret:.2f} Pa·s: {1e3 * watts:.2f} mW, so {found:.3f} Pa·s ({100 * (found / secret - 1):+.1f} %)")
        assert abs(found / secret - 1) < 0.05


if __name__ == "__main__":
    main()
