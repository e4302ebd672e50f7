"""Paint: the faces a brush takes. One specification for every program that paints; `docs/segmentation.md` words it.

Every quantity is float64 made from the served float32 vertices by +, −, ×, ÷, √ and comparison in one stated order, so
that two programs agree face for face. No angle is ever computed: an angle limit is given and kept as its cosine.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float, Int

from partwise.errors import MeshError, ParameterError
from partwise.mesh import TriMesh
from partwise.segmentation.face_graph import FaceGraph


@dataclass(frozen=True, slots=True)
class Brush:
    """How far paint reaches from a clicked face.

    radius : in (0, 1], Euclidean between centroids, as a share of the bounding box's diagonal.
    min_cosine : in [−1, 1], least cosine of the angle between a taken face's normal and the clicked face's; None for no
        limit. A limit in degrees is turned into a cosine once, where it is chosen.

    Raises
    ------
    ParameterError : a value outside its range, or NaN.
    """

    radius: float
    min_cosine: float | None = None

    def __post_init__(self) -> None:
        if not 0 < self.radius <= 1:
            raise ParameterError(
                f"a brush's radius must be in (0, 1], a share of the diagonal, but is {self.radius}; try 0.05"
            )
        if self.min_cosine is not None and not -1 <= self.min_cosine <= 1:
            raise ParameterError(
                f"min_cosine must be in [−1, 1] but is {self.min_cosine}; give the limit's cosine, not the angle"
            )

    @classmethod
    def with_angle(cls, radius: float, max_angle_degrees: float) -> "Brush":
        """A brush whose angle limit is given in degrees, in [0, 180].

        Raises
        ------
        ParameterError : a value outside its range, or NaN.
        """
        if not 0 <= max_angle_degrees <= 180:
            raise ParameterError(f"an angle limit must be in [0, 180] degrees but is {max_angle_degrees}; try 40")
        return cls(radius, math.cos(math.radians(max_angle_degrees)))


class PaintSurface:
    """What painting needs of a mesh. Each quantity is made when it is first asked for: many edits need none."""

    def __init__(self, mesh: TriMesh) -> None:
        self._mesh = mesh

    @classmethod
    def build(cls, mesh: TriMesh) -> "PaintSurface":
        """Raises MeshError when a vertex does not fit float32, as meshes are stored and served."""
        if np.abs(mesh.vertices).max() > np.finfo(np.float32).max:
            raise MeshError(
                f"coordinates must fit float32 but reach {np.abs(mesh.vertices).max():.3g}; scale the mesh down"
            )
        return cls(mesh)

    @property
    def n_faces(self) -> int:
        return self._mesh.n_faces

    @cached_property
    def centroids(self) -> Float[np.ndarray, "m 3"]:
        """(m, 3) float64, ((a + b) + c) / 3 of the float32 corners, model units."""
        a, b, c = self._corners()
        return ((a + b) + c) / 3.0

    @cached_property
    def crosses(self) -> Float[np.ndarray, "m 3"]:
        """(m, 3) float64, (b − a) × (c − a): the normal, not scaled."""
        a, b, c = self._corners()
        return _cross(b - a, c - a)

    @cached_property
    def cross_lengths(self) -> Float[np.ndarray, " m"]:
        """(m,) float64, length of the cross product, twice the area; 0 for degenerate faces."""
        return np.sqrt(_dot(self.crosses, self.crosses))

    @cached_property
    def diagonal(self) -> float:
        """Length of the bounding box's diagonal, over the vertices that faces use, model units."""
        used = self._vertices()[np.unique(self._mesh.faces)]
        extent = used.max(axis=0) - used.min(axis=0)
        return float(np.sqrt(_dot(extent, extent)))

    @cached_property
    def graph(self) -> FaceGraph:
        """Which faces touch across edges."""
        return FaceGraph.build(self._mesh)

    def _vertices(self) -> Float[np.ndarray, "n 3"]:
        return self._mesh.vertices.astype(np.float32).astype(np.float64)

    def _corners(self) -> tuple[Float[np.ndarray, "m 3"], Float[np.ndarray, "m 3"], Float[np.ndarray, "m 3"]]:
        vertices = self._vertices()
        a, b, c = (vertices[self._mesh.faces[:, k]] for k in range(3))
        return a, b, c


def painted_faces(
    surface: PaintSurface, seeds: Sequence[int], brush: Brush, is_open: Bool[np.ndarray, " m"] | None = None
) -> Int[np.ndarray, " r"]:
    """Faces a drag over `seeds` takes, ascending: the union of what a click on each takes.

    A click takes, breadth-first over shared edges from the clicked face, the faces within the radius and the angle
    limit of the clicked face that are open (all faces when `is_open` is None); a face that is not taken is not crossed.
    The clicked face is always within its own radius and limit. A face without area has no direction: as a taken face it
    meets every angle limit, and as the clicked face it sets none.

    Raises
    ------
    ParameterError : no seeds, a seed outside the mesh, or `is_open` of another length.
    """
    if len(seeds) == 0:
        raise ParameterError("paint must have at least one seed face but has none; click a face of the mesh")
    for seed in seeds:
        surface.graph.check_face(seed)
    if is_open is not None and is_open.shape != (surface.n_faces,):
        raise ParameterError(
            f"is_open must have one value for each of {surface.n_faces} faces but is {is_open.shape}; another mesh's?"
        )
    taken = [_clicked(surface, seed, brush, is_open) for seed in dict.fromkeys(seeds)]
    return taken[0] if len(taken) == 1 else np.unique(np.concatenate(taken))


def _clicked(surface: PaintSurface, seed: int, brush: Brush, is_open: np.ndarray | None) -> Int[np.ndarray, " r"]:
    reach = brush.radius * surface.diagonal
    squared_reach = reach * reach
    centroid, cross, length = surface.centroids[seed], surface.crosses[seed], surface.cross_lengths[seed]

    def is_taken(faces: np.ndarray) -> np.ndarray:
        offset = surface.centroids[faces] - centroid
        is_within = _dot(offset, offset) <= squared_reach
        if brush.min_cosine is not None:
            least = brush.min_cosine * (length * surface.cross_lengths[faces])
            is_within &= (_dot(surface.crosses[faces], cross) >= least) | (faces == seed)
        return is_within if is_open is None else is_within & is_open[faces]

    return surface.graph.grown(seed, is_taken)


def _dot(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """(u₀v₀ + u₁v₁) + u₂v₂ of the last axis: written out, because a library's dot product may add in another order."""
    product = u * v
    return (product[..., 0] + product[..., 1]) + product[..., 2]


def _cross(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """(u₁v₂ − u₂v₁, u₂v₀ − u₀v₂, u₀v₁ − u₁v₀), rounded after every operation."""
    return u[:, [1, 2, 0]] * v[:, [2, 0, 1]] - u[:, [2, 0, 1]] * v[:, [1, 2, 0]]
