"""Record a run, read what is in the file, run it again and see that it is the same; draw what was felt.

Usage: read_a_recording.py [FILE.rec]     without a file a short run of the spoon is recorded first
"""

import os
import sys
import tempfile

import numpy as np
import numpy.typing as npt
import slosh


def record(file: str) -> None:
    world = slosh.World(slosh.load_scene("spoon"), 0.012, threads=1)
    world.record(file)
    world.run(0.6)
    world.set_viscosity(0, 1.5 * world.viscosity(0))
    world.run(0.4)
    world.stop_recording()


def draw(time: npt.NDArray[np.float64], values: npt.NDArray[np.float64], unit: str, rows: int = 12, columns: int = 72) -> None:
    """A curve in characters."""
    at = np.interp(np.linspace(time[0], time[-1], columns), time, values)
    low, high = float(at.min()), float(at.max())
    level = np.round((at - low) / max(high - low, 1e-12) * (rows - 1)).astype(int)
    for row in reversed(range(rows)):
        edge = f"{low + (high - low) * row / (rows - 1):9.3f} {unit} |"
        print(edge + "".join("*" if level[c] == row else " " for c in range(columns)))
    print(" " * 12 + f"{time[0]:.2f} s" + " " * (columns - 10) + f"{time[-1]:.2f} s")


def main() -> None:
    folder = tempfile.TemporaryDirectory()
    file = sys.argv[1] if len(sys.argv) > 1 else os.path.join(folder.name, "spoon.rec")
    if len(sys.argv) < 2:
        record(file)

    recording = slosh.Recording(file)
    print(f"'{recording.scene.name}' at {1e3 * recording.spacing:.1f} mm by slosh {recording.version} on {recording.backend}:")
    print(f"{len(recording.time)} steps, {recording.hands.shape[1]} hands, {len(recording.body_time)} states of bodies")
    for when, what, fluid, value in recording.changes:
        print(f"  {when:.3f} s: {what} of fluid {fluid} becomes {value}")

    again = slosh.replay(file, threads=1)
    print(again.verdict)
    draw(again.run.time, np.linalg.norm(again.run.wrenches[:, 0, :3], axis=1), "N")
    assert again.same and recording.complete
    assert len(again.run.time) == len(recording.time)
    if len(sys.argv) < 2:
        assert [change[1] for change in recording.changes] == ["viscosity"]
        assert np.allclose(again.run.handles, recording.hands, atol=1e-5), "the hands that the steps used"


if __name__ == "__main__":
    main()
