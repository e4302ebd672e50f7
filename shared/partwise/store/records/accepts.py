"""Labels of models that were accepted in bulk, and the few that people label again to see how many are wrong."""

from dataclasses import dataclass
from datetime import datetime

from partwise.store.records.confirmations import Closeness


@dataclass(frozen=True, slots=True)
class AcceptBatch:
    """What was accepted at once.

    segmentation : which labels. agreement : share of the area on which people's labels must agree with accepted ones,
        or else these were wrong.
    n_accepted : shapes whose labels they became. n_drawn : others that were put into the queue to be labelled anew.
    n_rechecked : of those, the ones that were. n_false : of these, the ones whose accepted labels were wrong.
    """

    id: int
    collection_id: int
    person_id: int
    person_name: str
    segmentation: str
    agreement: float
    n_accepted: int
    n_drawn: int
    n_rechecked: int
    n_false: int
    accepted_at: datetime


@dataclass(frozen=True, slots=True)
class Recheck:
    """Accepted labels of a shape that waits to be labelled by somebody who does not know of them."""

    id: int
    batch_id: int
    collection_id: int
    shape_id: int
    mesh_hash: str
    agreement: float


@dataclass(frozen=True, slots=True)
class RecheckResult:
    """How close people's labels, a revision, came to the accepted ones."""

    recheck_id: int
    revision_id: int
    closeness: Closeness
