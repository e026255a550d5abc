"""Fill a bucket that a hand holds, let it come to rest, and weigh it: the hand feels (bucket + water) · g."""

import numpy as np
import slosh

BUCKET_KG = 0.8
OUTER, INNER, FLOOR, HEIGHT, LEVEL = 0.074, 0.060, 0.014, 0.14, 0.09  # m


def bucket_of_water() -> slosh.Scene:
    ring = [(0, 0), (OUTER, 0), (OUTER, HEIGHT), (INNER, HEIGHT), (INNER, FLOOR), (0, FLOOR)]
    disc = [(0, FLOOR), (INNER, FLOOR), (INNER, LEVEL), (0, LEVEL)]
    builder = slosh.SceneBuilder(title="A bucket to weigh", duration_s=2.0, settle_s=1.0)
    builder.body("bucket", slosh.lathe(ring), motion="free", mass_kg=BUCKET_KG)
    builder.fluid("water", slosh.lathe(disc), viscosity_pa_s=0.05)
    builder.grip("handle", on="bucket", pose=(0, HEIGHT, 0), stiffness_n_m=2000.0, damping_n_s_m=60.0)
    return builder.scene()


def main() -> None:
    world = slosh.World(bucket_of_water(), 0.010, threads=1)
    rest = world.scene.grip_start("handle")
    world.hold("handle", rest)
    run = world.run(1.0)

    felt = -run.wrenches[:, 0, 1]  # N, downward, a value a step
    water = world.measure().mass
    expected = (BUCKET_KG + water) * 9.81
    print(f"{world.particles} particles, {len(run.time)} steps of {1e3 * world.time_step:.2f} ms")
    print(f"bucket {BUCKET_KG} kg, water {water:.4f} kg")
    print(f"felt {felt.mean():.4f} N, {expected:.4f} N expected, noise {felt.std():.4f} N")
    assert abs(felt.mean() / expected - 1) < 0.002, "a held weight is right to a few ten-thousandths"
    assert np.all(world.fluid_index == 0), "no water has left the world"


if __name__ == "__main__":
    main()
