"""Instruments for programs: fields between particles, profiles, harmonic fits, families of runs, the files of a run.

Plain numpy on what a World and a Run give; nothing here moves anything.
"""

import itertools
import os
from typing import Any, Callable, Dict, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from slosh._core import Run, World, load_scene

Floats = npt.NDArray[np.float64]
Value = Union[bool, float, str]


def field_at(
    positions: npt.ArrayLike, values: npt.ArrayLike, points: npt.ArrayLike, radius: float, spacing: float
) -> Tuple[Floats, Floats]:
    """What the particles say between them: a mean by Wendland's C2 kernel (Shepard's interpolation).

    positions (N, 3) m and values (N,) or (N, k) of particles, points (M, 3) m, radius m of the kernel (a world's
    plan.support_radius), spacing m. Returns (M,) or (M, k) values, nan where no particle is within the radius, and (M,)
    how full of fluid the place is: about 1 inside, 0.5 at a plane surface, 0 outside.
    """
    at = np.asarray(positions, dtype=float)
    what = np.asarray(values, dtype=float)
    where = np.asarray(points, dtype=float)
    if not radius > 0 or not spacing > 0:
        raise ValueError("radius, spacing: above 0")
    flat = what.reshape(len(at), -1)
    there = np.isfinite(at).all(axis=1) & np.isfinite(flat).all(axis=1)
    at, flat = at[there], flat[there]
    sums, weights = np.zeros((len(where), flat.shape[1])), np.zeros(len(where))
    if len(at):
        low = np.minimum(at.min(axis=0), where.min(axis=0)) - radius
        size = np.floor((np.maximum(at.max(axis=0), where.max(axis=0)) - low) / radius).astype(np.int64) + 2

        def key(cells: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
            keys: npt.NDArray[np.int64] = (cells[:, 2] * size[1] + cells[:, 1]) * size[0] + cells[:, 0]
            return keys

        keys = key(((at - low) / radius).astype(np.int64))
        order = np.argsort(keys, kind="stable")
        at, flat, keys = at[order], flat[order], keys[order]
        cells = ((where - low) / radius).astype(np.int64)
        for y, z in itertools.product((-1, 0, 1), repeat=2):  # three cells in a row are one run of particles
            first = key(cells + (-1, y, z))
            begin, end = np.searchsorted(keys, first), np.searchsorted(keys, first + 3)
            count = end - begin
            point = np.repeat(np.arange(len(where)), count)
            inside = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
            particle = np.repeat(begin, count) + inside
            q = np.linalg.norm(at[particle] - where[point], axis=1) / radius
            near = q < 1
            weight = (1 - q[near]) ** 4 * (1 + 4 * q[near])
            np.add.at(weights, point[near], weight)
            np.add.at(sums, point[near], weight[:, None] * flat[particle[near]])
    with np.errstate(invalid="ignore"):
        mean = np.where(weights[:, None] > 0, sums / np.where(weights > 0, weights, 1)[:, None], np.nan)
    filled = weights * spacing**3 * 21 / (2 * np.pi * radius**3)
    return mean.reshape((len(where),) + what.shape[1:]), filled


def profile(coordinate: npt.ArrayLike, values: npt.ArrayLike, edges: npt.ArrayLike) -> Tuple[Floats, npt.NDArray[np.int_]]:
    """Means of values (N,) or (N, k) in the layers that edges (m + 1,) part along a coordinate (N,).

    Returns (m,) or (m, k) means, nan where nothing is, and (m,) how many there are. What is nan is left out.
    """
    along, what, parts = np.asarray(coordinate, float), np.asarray(values, float), np.asarray(edges, float)
    flat = what.reshape(len(along), -1)
    there = np.isfinite(along) & np.isfinite(flat).all(axis=1)
    layer = np.digitize(along[there], parts) - 1
    layers = len(parts) - 1
    inside = (layer >= 0) & (layer < layers)
    count = np.bincount(layer[inside], minlength=layers)
    sums = np.zeros((layers, flat.shape[1]))
    np.add.at(sums, layer[inside], flat[there][inside])
    mean = np.where(count[:, None] > 0, sums / np.maximum(count, 1)[:, None], np.nan)
    return mean.reshape((layers,) + what.shape[1:]), count


def fit_sine(time: npt.ArrayLike, values: npt.ArrayLike, frequency: float) -> Tuple[complex, float, float]:
    """Least squares of mean + Re(amplitude · exp(2πi · frequency · time)) to values (n,) at time (n,) s.

    Returns the complex amplitude, the mean, and the rms of what is left. The phase of a force against the phase of the
    way that it answers tells what is elastic (in phase) from what is viscous (a quarter ahead).
    """
    t, x = np.asarray(time, float), np.asarray(values, float)
    if t.ndim != 1 or t.shape != x.shape or len(t) < 4:
        raise ValueError("time, values: (n,) each, n at least 4")
    turn = 2 * np.pi * frequency * t
    basis = np.column_stack((np.cos(turn), np.sin(turn), np.ones_like(t)))
    (a, b, mean), *_ = np.linalg.lstsq(basis, x, rcond=None)
    left = x - basis @ (a, b, mean)
    return complex(a, -b), float(mean), float(np.sqrt(np.mean(left**2)))


def sweep(
    scene: Union[str, "os.PathLike[str]"],
    values: Mapping[str, Sequence[Value]],
    measure: Callable[[World], Mapping[str, float]],
    spacing: Optional[float] = None,
    **options: Any,
) -> Dict[str, npt.NDArray[Any]]:
    """Runs a scene with every combination of values of its fields, and returns one table.

    scene: a shipped name or a file; values: {'OBJECT.FIELD': values} as load_scene's edits; measure: runs the world and
    returns named numbers; spacing and options: World's. Returns {name: (runs,) array}, the fields first, the last field
    fastest. Every combination is loaded, and so checked, before the first runs.

    >>> slosh.sweep("spoon", {"fluid.viscosity_pa_s": [0.5, 2, 8]},
    ...             lambda w: {"peak_n": abs(w.run(2.0).wrenches[:, 0, :3]).max()})
    """
    names = list(values)
    combinations = list(itertools.product(*(values[name] for name in names)))
    scenes = [load_scene(scene, dict(zip(names, each))) for each in combinations]
    table: Dict[str, List[Any]] = {name: [] for name in names}
    for each, one in zip(combinations, scenes):
        said = measure(World(one, spacing, **options))
        for name, value in (*zip(names, each), *said.items()):
            table.setdefault(name, []).append(value)
    return {name: np.array(column) for name, column in table.items()}


def write_tables(run: Run, folder: str) -> None:
    """Writes wrenches.csv and poses.csv as `slosh play` does: `--device replay:poses.csv` plays the hands again."""
    os.makedirs(folder, exist_ok=True)
    grips = run.wrenches.shape[1]
    device = np.tile(np.arange(grips), len(run.time))
    time = np.repeat(run.time, grips)
    for name, header, rows in (
        ("wrenches.csv", "time_s,device,fx_n,fy_n,fz_n,tx_nm,ty_nm,tz_nm", run.wrenches),
        ("poses.csv", "time_s,device,x_m,y_m,z_m,qw,qx,qy,qz", run.handles),
    ):
        columns = rows.reshape(len(time), -1)
        form = ["%.6f", "%d"] + ["%.9g"] * columns.shape[1]
        np.savetxt(os.path.join(folder, name), np.column_stack((time, device, columns)), form, ",", header=header, comments="")
