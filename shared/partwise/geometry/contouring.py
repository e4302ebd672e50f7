"""From a field to a closed welded triangle mesh: sample near the surface only, then march cubes."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import igl
import numpy as np
from jaxtyping import Float, Int

from partwise.errors import DegenerateMeshError
from partwise.mesh import TriMesh

Field: TypeAlias = Callable[[Float[np.ndarray, "n 3"]], Float[np.ndarray, " n"]]

_BLOCK = 4  # grid points along a block's side
_CUBE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])


@dataclass(frozen=True, slots=True, eq=False)
class Grid:
    """Cubic lattice: `origin` (3,) and `spacing` in model units, `n_blocks` (3,) blocks of 4×4×4 points."""

    origin: Float[np.ndarray, "3"]
    spacing: float
    n_blocks: Int[np.ndarray, "3"]

    @property
    def shape(self) -> tuple[int, int, int]:
        x, y, z = (int(n) * _BLOCK for n in self.n_blocks)
        return (x, y, z)


def grid_over(bounds: Float[np.ndarray, "2 3"], spacing: float) -> Grid:
    """The grid with one cell of room around the box (low, high)."""
    n_points = np.ceil((bounds[1] - bounds[0]) / spacing).astype(np.int64) + 4
    return Grid(bounds[0] - 1.5 * spacing, spacing, -(-n_points // _BLOCK))


def contour(field: Field, grid: Grid, steepness: float) -> TriMesh:
    """Zero surface of the field on the grid: welded, oriented outwards, closed where it does not leave the grid.

    The field is sampled only in blocks that the surface may cross. Values are kept off zero, so no face is degenerate.

    Parameters
    ----------
    field : (n, 3) points → (n,) values, negative inside.
    steepness : the most the field changes per unit of length; 1 for a distance.

    Raises
    ------
    DegenerateMeshError : the surface does not cross the grid.

    Source: Lorensen & Cline 1987 (libigl's).
    """
    values = _sample(field, grid, steepness)
    inside = values < 0.0
    corners = [inside[tuple(slice(o, n - 1 + o) for o, n in zip(c, grid.shape, strict=True))] for c in _CUBE]
    n_inside = np.sum(corners, axis=0, dtype=np.int8)
    cells = np.argwhere((n_inside > 0) & (n_inside < 8))
    if len(cells) == 0:
        raise DegenerateMeshError(
            f"the surface does not cross a grid of spacing {grid.spacing:.4g}; is the shape thinner than that?"
        )
    corner_index = np.ravel_multi_index(tuple((cells[:, None, :] + _CUBE).reshape(-1, 3).T), grid.shape)
    used, compact = np.unique(corner_index, return_inverse=True)
    points = grid.origin + np.stack(np.unravel_index(used, grid.shape), axis=1) * grid.spacing
    vertices, faces, _ = igl.marching_cubes(values.ravel()[used], points, compact.reshape(-1, 8).astype(np.int64), 0.0)
    return TriMesh(vertices, faces)


def _sample(field: Field, grid: Grid, steepness: float) -> np.ndarray:
    """Field on all grid points; in blocks that the surface cannot cross, the value at the block's centre."""
    h = grid.spacing
    block = np.indices(tuple(grid.n_blocks)).reshape(3, -1).T
    at_centre = field(grid.origin + (block * _BLOCK + (_BLOCK - 1) / 2.0) * h)
    reach = steepness * h * np.sqrt(3.0) * ((_BLOCK - 1) / 2.0 + 1.0)
    active = block[np.abs(at_centre) <= reach]
    values = np.broadcast_to(
        at_centre.reshape(*grid.n_blocks)[:, None, :, None, :, None],
        (grid.n_blocks[0], _BLOCK, grid.n_blocks[1], _BLOCK, grid.n_blocks[2], _BLOCK),
    ).copy()
    within = np.indices((_BLOCK,) * 3).reshape(3, -1).T
    index = (active[:, None, :] * _BLOCK + within).reshape(-1, 3)
    fine = field(grid.origin + index * h)
    floor = 0.02 * h
    fine = np.where(np.abs(fine) < floor, np.where(fine < 0.0, -floor, floor), fine)
    values = values.reshape(grid.shape)
    values[tuple(index.T)] = fine
    return values
