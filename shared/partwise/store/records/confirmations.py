"""Labels that people hand in, how well they agree, and how right they are where that is known."""

from dataclasses import dataclass
from datetime import date, datetime

import numpy as np
from jaxtyping import Integer

from partwise.errors import ParameterError
from partwise.labels.annotation_cost import AnnotationCost


@dataclass(frozen=True, slots=True)
class Closeness:
    """How close labels are to others on the same mesh.

    area_agreement : share of the area with the same label, [0, 1].
    part_iou : mean intersection over union of the parts, [0, 1].
    boundary_distance : mean distance of the boundaries, as a fraction of the bounding box's diagonal, [0, 1].

    Raises
    ------
    ParameterError : a value outside [0, 1].
    """

    area_agreement: float
    part_iou: float
    boundary_distance: float

    def __post_init__(self) -> None:
        for name in ("area_agreement", "part_iou", "boundary_distance"):
            if not 0 <= getattr(self, name) <= 1:  # also refuses NaN
                raise ParameterError(f"{name} must be in [0, 1] but is {getattr(self, name)}; measure it again")


@dataclass(frozen=True, slots=True)
class NewConsensus:
    """What independent labels of a shape, those being confirmed among them, come to.

    peers : answers that were compared with the labels being confirmed: all others of the round.
    closeness : mean over all pairs.
    medoid : the answer closest to the others; None for the labels being confirmed.
    """

    peers: tuple[int, ...]
    closeness: Closeness
    medoid: int | None


@dataclass(frozen=True, slots=True)
class Consensus:
    """A round of independent labels that is complete. `revision_id` is of the medoid's labels.

    is_agreed : the area agreement reached the collection's `agreement`; else the revision waits for a reviewer.
    """

    id: int
    shape_id: int
    round: int
    answer_ids: tuple[int, ...]
    closeness: Closeness
    is_agreed: bool
    medoid_id: int
    revision_id: int
    settled_at: datetime


@dataclass(frozen=True, slots=True)
class NewBlindCheck:
    """How close labels came to the reference revision of their shape."""

    reference_id: int
    closeness: Closeness


@dataclass(frozen=True, slots=True)
class BlindCheck:
    """A person's labels of a shape, measured against a reference without their knowing."""

    id: int
    collection_id: int
    shape_id: int
    person_id: int
    answer_id: int
    reference_id: int
    closeness: Closeness
    checked_at: datetime


@dataclass(frozen=True, slots=True)
class BlindCheckDay:
    """Means over the blind checks of a person on a day (UTC)."""

    person_id: int
    day: date
    n_checks: int
    mean: Closeness


@dataclass(frozen=True, slots=True)
class Answer:
    """Labels that were handed in but are not, or not by themselves, the shape's. Immutable; shown to nobody else."""

    id: int
    shape_id: int
    slot: int
    round: int
    person_id: int
    draft_id: int
    mesh_hash: str
    schema_version: int
    n_faces: int
    sha256: str
    created_at: datetime


@dataclass(frozen=True, slots=True, eq=False)
class NewConfirmation:
    """A draft to be confirmed with the labels (m,) that its `n_strokes` strokes leave, checked under a schema version.

    consensus : needed exactly when these are the last labels that an independent round waits for.
    blind_check : for a draft whose purpose is blind, if the reference is on the draft's mesh.
    cost : what the strokes took.
    """

    draft_id: int
    person_id: int
    n_strokes: int
    labels: Integer[np.ndarray, " m"]
    schema_version: int
    consensus: NewConsensus | None = None
    blind_check: NewBlindCheck | None = None
    cost: AnnotationCost | None = None


@dataclass(frozen=True, slots=True)
class Confirmation:
    """What became of confirmed labels. A person is told the checksum only: the rest says what the work was for.

    revision_id : of the shape's labels that this made, None while other people's are awaited or if it was blind.
    answer_id : of the labels put aside for comparison.
    review_id : of the review that the labels now wait in.
    """

    draft_id: int
    shape_id: int
    sha256: str
    revision_id: int | None
    answer_id: int | None
    review_id: int | None
