"""A blueprint as a labelled mesh: contoured whole, reduced to a face count, each face labelled by the nearest piece."""

import numpy as np
from jaxtyping import Float, Int

from partwise.errors import DegenerateMeshError
from partwise.geometry.contouring import grid_over
from partwise.mesh import TriMesh
from partwise.simulate.blueprint import Blueprint
from partwise.simulate.contour import (
    contour,
    label_by_nearest,
    largest_component,
    reduce_faces,
    smooth_labels,
    tight_bounds,
)

CELLS_PER_THICKNESS = 2.4
_N_CELLS = (80, 190)  # allowed cells along the longest side, unless more faces are asked for
_ROOM_TO_REDUCE = 1.3  # how many times the wanted faces are contoured
_MAX_DEBRIS = 0.01  # share of area that may be lost with loose crumbs
_MIN_ISLAND = 0.0015  # share of area below which a labelled island is noise


def realise(blueprint: Blueprint, part_names: tuple[str, ...], n_faces: int) -> tuple[TriMesh, Int[np.ndarray, " m"]]:
    """A closed manifold in one piece of `n_faces` faces (±2 %), and the part index of each face, (m,) int64.

    Raises
    ------
    DegenerateMeshError : the pieces do not hang together, or no reduction keeps the surface manifold.
    """
    bounds = tight_bounds(blueprint.distance, blueprint.bounds())
    spacing = _spacing(bounds, blueprint.thickness)
    for _ in range(3):
        fine = _one_piece(blueprint, bounds, spacing)
        shortage = n_faces * _ROOM_TO_REDUCE / fine.n_faces
        if shortage > 1.0:
            spacing *= 0.97 / np.sqrt(shortage)
            continue
        mesh = reduce_faces(fine, n_faces)
        if mesh is not None and abs(mesh.n_faces - n_faces) <= 0.02 * n_faces:
            return mesh, _labels(blueprint, part_names, mesh)
        spacing *= 0.83
    raise DegenerateMeshError(
        f"no clean mesh of {n_faces} faces was found at spacings down to {spacing:.4g}; ask for more faces"
    )


def require_one_piece(blueprint: Blueprint) -> None:
    """Makes sure that the pieces hang together, at the resolution that `realise` starts from.

    Raises
    ------
    DegenerateMeshError : they do not.
    """
    bounds = tight_bounds(blueprint.distance, blueprint.bounds())
    _one_piece(blueprint, bounds, _spacing(bounds, blueprint.thickness))


def part_of_piece(blueprint: Blueprint, part_names: tuple[str, ...]) -> Int[np.ndarray, " k"]:
    """Index into `part_names` of each of the blueprint's pieces, (k,) int64."""
    return np.array([part_names.index(piece.part) for piece in blueprint.pieces], dtype=np.int64)


def _one_piece(blueprint: Blueprint, bounds: Float[np.ndarray, "2 3"], spacing: float) -> TriMesh:
    mesh, share = largest_component(contour(blueprint.distance, grid_over(bounds, spacing)))
    if share < 1.0 - _MAX_DEBRIS:
        raise DegenerateMeshError(
            f"a shape must be one piece but its largest has {share:.1%} of the area; do all pieces touch?"
        )
    return mesh


def _labels(blueprint: Blueprint, part_names: tuple[str, ...], mesh: TriMesh) -> Int[np.ndarray, " m"]:
    labels = label_by_nearest(mesh, blueprint.nearest_piece, part_of_piece(blueprint, part_names))
    return smooth_labels(mesh, labels, _MIN_ISLAND)


def _spacing(bounds: Float[np.ndarray, "2 3"], thickness: float) -> float:
    longest = float((bounds[1] - bounds[0]).max())
    return float(np.clip(thickness / CELLS_PER_THICKNESS, longest / _N_CELLS[1], longest / _N_CELLS[0]))
