"""The experiment behind the acceptance threshold, and how much of a simulated collection keeps its labels.

Dirty simulated shapes are remeshed and compared with their own originals (good pairs) and with the other originals of
their category (wrong pairs); originals are compared with themselves less their smallest part (maimed pairs).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, UInt8

from partwise.errors import NotEnoughDataError
from partwise.features.light_field import light_field, light_field_distance
from partwise.geometry.faces import face_areas
from partwise.mesh import TriMesh
from partwise.remesh.ladder import remesh
from partwise.remesh.map_back import map_back
from partwise.remesh.parameters import RemeshParameters
from partwise.render.views import DepthRenderer


@dataclass(frozen=True, slots=True, eq=False)
class KnownShape:
    """A dirty mesh whose parts are known, and the clean mesh of the same design.

    labels : (m,) int, part of each face of `dirty`.
    """

    category: str
    name: str
    dirty: TriMesh
    labels: np.ndarray
    clean: TriMesh


@dataclass(frozen=True, slots=True)
class ShapeOutcome:
    """What remeshing did to one shape.

    own_distance : to its dirty original. clean_distance : to the clean mesh of its design.
    wrong_distances : to the other originals of its category.
    maimed_distance : of the original to itself without the part of least area.
    label_share : share of the original's area with its true label after the way there and back; n_faces : of the
    remeshed mesh. core_s : seconds of processor time of all attempts.
    """

    category: str
    name: str
    own_distance: float
    clean_distance: float
    wrong_distances: tuple[float, ...]
    maimed_distance: float
    label_share: float
    n_faces: int
    core_s: float


@dataclass(frozen=True, slots=True)
class Calibration:
    """All outcomes, and the threshold they suggest. `not_remeshed` names shapes of which every attempt was refused."""

    outcomes: tuple[ShapeOutcome, ...]
    not_remeshed: tuple[str, ...]

    @property
    def greatest_good(self) -> float:
        """The greatest distance of a remeshed shape to its own original."""
        return max(outcome.own_distance for outcome in self.outcomes)

    @property
    def least_wrong(self) -> float:
        """The least distance of a remeshed shape to another shape of its category."""
        return min(min(outcome.wrong_distances) for outcome in self.outcomes)

    @property
    def suggested_distance(self) -> float:
        """A fifth of the way from the greatest good to the least wrong distance.

        Near the good side: a good surface refused costs one more attempt, a bad one accepted costs labels.

        Raises
        ------
        NotEnoughDataError : they overlap, so that no threshold separates them.
        """
        if self.greatest_good >= self.least_wrong:
            raise NotEnoughDataError(
                f"good pairs must lie closer than wrong ones but reach {self.greatest_good:.3f} where wrong ones start "
                f"at {self.least_wrong:.3f}; look at the shapes that overlap"
            )
        return self.greatest_good + 0.2 * (self.least_wrong - self.greatest_good)


def calibrate(
    shapes: Sequence[KnownShape], parameters: RemeshParameters, n_faces: int, renderer: DepthRenderer
) -> Calibration:
    """Remeshes every shape and compares. Seconds per shape; give `parameters` a `max_distance` that refuses nothing.

    Parameters
    ----------
    shapes : at least two of every category. n_faces : of the working meshes that labels travel through.

    Raises
    ------
    NotEnoughDataError : a category has one shape only, or nothing could be remeshed.
    """
    originals = [light_field(shape.dirty, renderer) for shape in shapes]
    outcomes: list[ShapeOutcome] = []
    not_remeshed: list[str] = []
    for index, shape in enumerate(shapes):
        others = [originals[k] for k, other in enumerate(shapes) if k != index and other.category == shape.category]
        if not others:
            raise NotEnoughDataError(
                f"wrong pairs need two shapes a category but {shape.category} has one; add another"
            )
        outcome = _outcome(shape, originals[index], others, parameters, n_faces, renderer)
        if outcome is None:
            not_remeshed.append(f"{shape.category} {shape.name}")
        else:
            outcomes.append(outcome)
    if not outcomes:
        raise NotEnoughDataError(f"none of {len(shapes)} shapes could be remeshed; look at their attempts")
    return Calibration(tuple(outcomes), tuple(not_remeshed))


def round_trip_share(dirty: TriMesh, labels: np.ndarray, remeshed: TriMesh) -> float:
    """Share of the dirty mesh's area that has its label again after the way to the remeshed mesh and back."""
    maps = map_back(dirty, remeshed)
    returned = maps.to_original.labels(maps.to_remeshed.labels(labels))
    areas = face_areas(dirty)
    return float(areas[returned == labels].sum() / areas.sum())


def _outcome(
    shape: KnownShape,
    original: UInt8[np.ndarray, " 208080"],
    others: list[np.ndarray],
    parameters: RemeshParameters,
    n_faces: int,
    renderer: DepthRenderer,
) -> ShapeOutcome | None:
    result = remesh(shape.dirty, parameters, renderer)
    mesh = result.working_mesh(n_faces)
    if mesh is None:
        return None
    own = light_field(mesh, renderer)
    return ShapeOutcome(
        category=shape.category,
        name=shape.name,
        own_distance=light_field_distance(own, original),
        clean_distance=light_field_distance(own, light_field(shape.clean, renderer)),
        wrong_distances=tuple(light_field_distance(own, other) for other in others),
        maimed_distance=light_field_distance(light_field(without_smallest_part(shape), renderer), original),
        label_share=round_trip_share(shape.dirty, shape.labels, mesh),
        n_faces=mesh.n_faces,
        core_s=sum(attempt.core_s for attempt in result.attempts),
    )


def without_smallest_part(shape: KnownShape) -> TriMesh:
    """The dirty mesh without the part of least area: what a remeshing that loses something would look like."""
    areas = np.bincount(shape.labels, weights=face_areas(shape.dirty))
    present = np.flatnonzero(areas > 0)
    smallest = present[areas[present].argmin()]
    return TriMesh(shape.dirty.vertices, shape.dirty.faces[shape.labels != smallest])


def percentiles(values: Sequence[float]) -> Float[np.ndarray, "5"]:
    """0th, 5th, 50th, 95th and 100th percentile, (5,) float64."""
    return np.percentile(np.asarray(values, dtype=np.float64), [0, 5, 50, 95, 100])


def table(calibration: Calibration) -> str:
    """The distances by category as a Markdown table."""
    header = "| category | shapes | own original | clean design | own without a part | other shapes | labels kept |"
    rows = [header, "|---|---|---|---|---|---|---|"]
    for category in sorted({outcome.category for outcome in calibration.outcomes}):
        chosen = [outcome for outcome in calibration.outcomes if outcome.category == category]
        own, clean, maimed = (
            percentiles([getattr(outcome, name) for outcome in chosen])
            for name in ("own_distance", "clean_distance", "maimed_distance")
        )
        wrong = percentiles([distance for outcome in chosen for distance in outcome.wrong_distances])
        kept = percentiles([outcome.label_share for outcome in chosen])
        rows.append(
            f"| {category} | {len(chosen)} | {own[2]:.3f} (≤ {own[4]:.3f}) | {clean[2]:.3f} (≤ {clean[4]:.3f}) "
            f"| {maimed[2]:.3f} (≥ {maimed[0]:.3f}) | {wrong[2]:.3f} (≥ {wrong[0]:.3f}) "
            f"| {kept[2]:.1%} (≥ {kept[0]:.1%}) |"
        )
    return "\n".join(rows)
