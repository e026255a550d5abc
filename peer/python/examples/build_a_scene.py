"""A mug on a table with a rim, half full, and a scripted hand that lifts and tilts it: written as a .glb that
`slosh check`, `slosh play` and Blender take.

Usage: build_a_scene.py [FILE.glb]
"""

import math
import os
import shutil
import subprocess
import sys
import tempfile

import slosh


def lift_and_tilt(time: float) -> slosh.Pose:
    share = 0.5 - 0.5 * math.cos(math.pi * min(max(time - 0.5, 0.0), 1.0))
    return slosh.Pose.turned((0, 0, 1), 0.6 * share, (0, 0.10 + 0.12 * share, 0))


def mug_scene() -> slosh.SceneBuilder:
    builder = slosh.SceneBuilder(title="A mug of tea over a tray", spacing_max_m=0.01, duration_s=3.0)
    builder.body("tray", slosh.tank((0.40, 0.03, 0.40), 0.02), pose=(0, -0.02, 0), color=(0.5, 0.35, 0.2))
    mug = [(0, 0), (0.05, 0), (0.05, 0.10), (0.038, 0.10), (0.038, 0.012), (0, 0.012)]
    builder.body("mug", slosh.lathe(mug), motion="free", mass_kg=0.35, friction=0.5, color=(0.9, 0.9, 0.85, 0.5))
    tea = [(0, 0.013), (0.037, 0.013), (0.037, 0.07), (0, 0.07)]
    builder.fluid("tea", slosh.lathe(tea), viscosity_pa_s=0.01, color=(0.5, 0.2, 0.05))
    builder.grip("rim", on="mug", pose=(0, 0.10, 0), stiffness_n_m=800.0)
    builder.hand("lift", "rim", lift_and_tilt, duration=3.0)
    builder.gauge("level", pose=(0, 0.05, 0), on="mug")
    builder.camera((0.35, 0.35, 0.5), (0, 0.08, 0))
    return builder


def main() -> None:
    folder = tempfile.mkdtemp()
    file = sys.argv[1] if len(sys.argv) > 1 else os.path.join(folder, "mug.glb")
    builder = mug_scene()
    builder.write(file)
    findings = slosh.check(file)
    for finding in findings:
        print(finding)
    assert not any(finding.is_error for finding in findings)

    scene = slosh.load_scene(file)
    print(scene, f"{scene.estimate(0.01)} particles at 10 mm")
    assert [grip.name for grip in scene.grips] == ["rim"] and scene.gauges == ["level"]
    assert scene.grips[0].hand is not None and len(scene.grips[0].hand) > 100

    program = os.environ.get("SLOSH_PROGRAM") or shutil.which("slosh")
    if program:
        said = subprocess.run([program, "check", file], capture_output=True, text=True)
        print(said.stdout.strip())
        assert said.returncode == 0, said.stderr

    # What is wrong is said in the words of a file that a person made.
    builder.fluid("milk", slosh.sphere(0.01), pose=(0.1, 0.2, 0), viscosity_pa_s=-1.0)
    try:
        builder.scene()
    except slosh.Error as error:
        print("refused:", error)
    else:
        raise AssertionError("a viscosity below 0 is an error")
    shutil.rmtree(folder)


if __name__ == "__main__":
    main()
