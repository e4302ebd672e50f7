"""Boundary refinement: boundaries of given labels move onto nearby creases, and unlabelled faces are filled.

`BoundaryRefiner` holds what depends on the mesh alone, so that a slider and repeated passes cost only the cuts. Labels
are part ids of any numbering ≥ 0, −1 where unlabelled.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial import cKDTree

from partwise.errors import LabelError
from partwise.geometry.adjacency import edge_adjacency, edge_components
from partwise.geometry.faces import bounding_box_diagonal, face_areas, face_centroids
from partwise.mesh import TriMesh
from partwise.segmentation.alpha_expansion import alpha_expansion
from partwise.segmentation.boundary_costs import cut_costs, leaving_costs
from partwise.segmentation.boundary_distances import SurfaceGraph, boundary_distances
from partwise.segmentation.creases import Creases, measure_creases
from partwise.segmentation.energy import LabelProblem
from partwise.segmentation.parameters import BoundaryParameters
from partwise.unlabelled import NO_CLASS

_DEFAULTS = BoundaryParameters()


@dataclass(frozen=True, slots=True, eq=False)
class BoundaryRefiner:
    """A mesh made ready for refinement. Everything is in units of the bounding box's diagonal.

    graph : distances along the surface. creases : of the edges.
    areas : (m,), centroids : (m, 3), lengths : (k,) of the edges.
    piece : (m,) int64, connected component of each face across edges.
    """

    graph: SurfaceGraph
    creases: Creases
    areas: Float[np.ndarray, " m"]
    centroids: Float[np.ndarray, "m 3"]
    lengths: Float[np.ndarray, " k"]
    piece: Int[np.ndarray, " m"]

    @classmethod
    def build(cls, mesh: TriMesh, shape_diameter: np.ndarray | None = None) -> "BoundaryRefiner":
        """Any mesh; `shape_diameter` as `partwise.features.shape_diameter` makes it, or None to go by angles alone.

        Raises
        ------
        ParameterError : shape diameters that are not one finite value per face.
        """
        diagonal = bounding_box_diagonal(mesh) or 1.0  # a single point has no lengths to scale
        centre = mesh.vertices.mean(axis=0)
        unit = TriMesh((mesh.vertices - centre) / diagonal, mesh.faces)
        adjacency = edge_adjacency(unit)
        return cls(
            graph=SurfaceGraph.build(unit, adjacency),
            creases=measure_creases(unit, adjacency, shape_diameter),
            areas=face_areas(unit),
            centroids=face_centroids(unit),
            lengths=adjacency.lengths,
            piece=edge_components(unit),
        )

    def refine(
        self,
        labels: Int[np.ndarray, " m"],
        parameters: BoundaryParameters = _DEFAULTS,
        anchor: Int[np.ndarray, " m"] | None = None,
    ) -> Int[np.ndarray, " m"]:
        """One pass; see `refine_boundaries`."""
        anchor = labels if anchor is None else anchor
        self._check("labels", labels)
        self._check("anchor", anchor)
        part_ids = np.setdiff1d(np.concatenate([labels, anchor]), [NO_CLASS])
        if not len(part_ids):
            raise LabelError("refinement needs a labelled face but all are −1; label a patch of each part first")
        start = np.searchsorted(part_ids, self.filled(labels if (labels != NO_CLASS).any() else anchor))
        refined = alpha_expansion(self.problem(anchor, part_ids, parameters), start, parameters.max_sweeps)
        return part_ids[refined].astype(np.int64)

    def problem(
        self, anchor: Int[np.ndarray, " m"], part_ids: Int[np.ndarray, " L"], parameters: BoundaryParameters = _DEFAULTS
    ) -> LabelProblem:
        """The energy that a pass lowers, over indices into `part_ids`: ascending, the anchor's and maybe more."""
        classes = np.where(anchor == NO_CLASS, NO_CLASS, np.searchsorted(part_ids, anchor))
        distances = boundary_distances(self.graph, classes, len(part_ids), limit=parameters.band)
        return LabelProblem(
            unary=leaving_costs(classes, distances, self.areas, parameters),
            edges=self.graph.pairs,
            weights=cut_costs(self.creases, self.lengths, parameters),
        )

    def filled(self, labels: Int[np.ndarray, " m"]) -> Int[np.ndarray, " m"]:
        """Each unlabelled face gets the part nearest along the surface, (m,) int64: where a pass starts.

        A piece of the mesh without labels gets, as one, that of the labelled face nearest to it in space. There must
        be a labelled face.
        """
        is_free = labels == NO_CLASS
        if not is_free.any():
            return labels.astype(np.int64)
        part_ids = np.unique(labels[~is_free])
        distances = np.stack([self.graph.from_faces(labels == part) for part in part_ids], axis=1)
        in_reach = is_free & np.isfinite(distances.min(axis=1))
        filled = np.where(in_reach, part_ids[np.argmin(distances, axis=1)], labels)
        known, left = np.flatnonzero(filled != NO_CLASS), np.flatnonzero(filled == NO_CLASS)
        if not len(left):
            return filled
        gap, nearest = map(np.asarray, cKDTree(self.centroids[known]).query(self.centroids[left]))
        order = np.lexsort((gap, self.piece[left]))  # the closest face of each piece comes first
        pieces, first = np.unique(self.piece[left][order], return_index=True)
        part_of_piece = filled[known[nearest[order[first]]]]
        filled[left] = part_of_piece[np.searchsorted(pieces, self.piece[left])]
        return filled

    def _check(self, name: str, labels: np.ndarray) -> None:
        m = len(self.areas)
        if labels.shape != (m,) or not np.issubdtype(labels.dtype, np.integer):
            raise LabelError(
                f"{name} must be {m} whole numbers but are {labels.shape} of {labels.dtype}; are they another mesh's?"
            )
        if int(labels.min()) < NO_CLASS:
            raise LabelError(f"{name} must be ≥ 0, or −1 where unlabelled, but one is {labels.min()}; map them first")


def refine_boundaries(
    mesh: TriMesh,
    labels: Int[np.ndarray, " m"],
    parameters: BoundaryParameters = _DEFAULTS,
    shape_diameter: np.ndarray | None = None,
    anchor: Int[np.ndarray, " m"] | None = None,
) -> Int[np.ndarray, " m"]:
    """Labels that minimise Σ D + λ·Σ φ_S approximately, and that no change to one label improves.

    Parameters
    ----------
    mesh : any mesh; several components are refined each by itself.
    labels : (m,) whole numbers, where to start; −1 is unlabelled and filled.
    parameters : `BoundaryParameters()` or `PAPER_BOUNDARY`.
    shape_diameter : (m,) float in [0, 1] or None; without, only angles count.
    anchor : (m,) whole numbers, the labels to stay near: those that a person last set. Faces that are −1 here are free.
        By default, `labels`. Given the same anchor, a second pass changes nothing; without one, each pass may move
        boundaries a little farther.

    Returns
    -------
    (m,) int64, a part id of `labels` or `anchor` for every face.

    Raises
    ------
    LabelError : not one whole number ≥ −1 per face, or no face is labelled.
    ParameterError : shape diameters that are not one finite value per face.

    Source: George et al. 2018. Differs: the default form measures creases at a fixed scale, tells concave from convex,
    weights by area, and lets the cost of leaving a label grow with distance; form = "paper" is the paper's, with costs
    in place of the printed probabilities, which minimised literally would swap labels.
    """
    return BoundaryRefiner.build(mesh, shape_diameter).refine(labels, parameters, anchor)
