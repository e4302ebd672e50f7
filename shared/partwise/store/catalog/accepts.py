"""Labels of models, accepted in bulk."""

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from jaxtyping import UInt16

from partwise.store.records import AcceptBatch, LabelRevision, NewRevision, Recheck, RecheckResult


class AcceptCatalog(Protocol):
    """Bulk acceptance and its re-checks.

    A drawn shape waits in the queue like any other, first: whoever gets it is told nothing. Their labels become the
    shape's, and show whether those that were to be accepted are right.
    """

    def begin_accept(self, collection_id: int, person_id: int, segmentation: str, agreement: float) -> int:
        """A batch without shapes; its id."""
        ...

    def accept_shape(self, batch_id: int, revision: NewRevision) -> LabelRevision:
        """Commit accepted labels, which takes the shape out of the queue.

        Raises `ConflictError` for a shape that does not just wait: held, labelled already, or being checked; errors of
        `add_revision`.
        """
        ...

    def draw_shape(
        self, batch_id: int, shape_id: int, mesh_hash: str, schema_version: int, labels: UInt16[np.ndarray, " m"]
    ) -> Recheck:
        """Put the shape first in the queue instead, to be labelled unknowing. Errors as `accept_shape`."""
        ...

    def open_rechecks(
        self, collection_id: int, *, shape_id: int | None = None, after: int = 0, limit: int = 100
    ) -> Sequence[Recheck]:
        """A page of what was drawn and has no result yet, by id; of one shape if given."""
        ...

    def recheck_labels(self, recheck_id: int) -> UInt16[np.ndarray, " m"]:
        """The labels that were to be accepted, checked against their checksum."""
        ...

    def settle_recheck(self, result: RecheckResult) -> bool:
        """Record a result; whether the labels were wrong. One that has a result keeps it."""
        ...

    def accept_batches(
        self, collection_id: int, *, before: int | None = None, limit: int = 100
    ) -> Sequence[AcceptBatch]:
        """A page of batches, newest first; `before` is the last id of the page before."""
        ...

    def put_first(self, collection_id: int, shape_ids: Sequence[int], person_id: int) -> Sequence[int]:
        """Have those of the shapes that wait handed out before all others; their ids. No ranking changes that."""
        ...
