"""Touch fluids together, from Python: scenes, worlds that step, hands, forces, hosts to join, recordings.

SI units, right-handed, y up. Quaternions are w, x, y, z. A wrench is three of force (N), then three of torque (N·m),
world axes. Where a scene's grips, bodies or fluids are asked for, a name or a number does.

>>> import slosh
>>> world = slosh.World(slosh.load_scene("bucket"), 0.012)
>>> run = world.run(2.0)
>>> run.time.shape, run.wrenches.shape                     # rows, grips, force and torque

Long calls let other threads go on and end with KeyboardInterrupt on Ctrl-C. What is refused raises slosh.Error, whose
text says where, what and how to mend it; a wrong argument raises ValueError, TypeError or KeyError.
"""

import numpy as _numpy  # noqa: F401  here, not in the midst of a call that Ctrl-C may end

from slosh._core import (
    BodyState,
    Body,
    Error,
    Finding,
    Fluid,
    Grip,
    GripState,
    Keys,
    Measurement,
    Mesh,
    Plan,
    Pose,
    Recording,
    Remote,
    Replay,
    Run,
    Scene,
    SceneBuilder,
    World,
    __version__,
    backends,
    box,
    capsule,
    check,
    join,
    lathe,
    load_scene,
    make_plan,
    replay,
    scenes,
    sphere,
    tank,
)
from slosh import analysis
from slosh.analysis import sweep

__all__ = [
    "Body",
    "BodyState",
    "Error",
    "Finding",
    "Fluid",
    "Grip",
    "GripState",
    "Keys",
    "Measurement",
    "Mesh",
    "Plan",
    "Pose",
    "Recording",
    "Remote",
    "Replay",
    "Run",
    "Scene",
    "SceneBuilder",
    "World",
    "__version__",
    "analysis",
    "backends",
    "box",
    "capsule",
    "check",
    "join",
    "lathe",
    "load_scene",
    "make_plan",
    "replay",
    "scenes",
    "sphere",
    "sweep",
    "tank",
]
