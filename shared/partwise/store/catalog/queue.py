"""The queue: who works on which shape."""

from collections.abc import Collection as SizedIterable
from collections.abc import Mapping, Sequence
from typing import Protocol

from partwise.store.records import Lease, LeasedShape, NewClaim, QueueDepth, SkippedShape


class QueueCatalog(Protocol):
    """Hands shapes to people so that none is in two people's hands. A lease's purpose is never told to its holder.

    A shape goes into the queue when it becomes ready, with a place for each label it is to get, and leaves it when
    those are in or labels come from elsewhere. A lease that was not renewed stays its holder's until another claim
    finds it expired.
    """

    def claim_next(self, claim: NewClaim) -> Lease | None:
        """Lease the first free shape: kept for this person, then by rank. None if nothing is left for them.

        A person gets no shape that they labelled or skipped since it went into the queue. While a shape is prefetched,
        the next claim in its collection takes that one, and another prefetch returns it again. One is prefetched at a
        time: a prefetch in another collection gives it back. A blind check that they did not do and get once more, this
        way or by name, is one again.

        Raises `ConflictError` if the person holds `MAX_HELD` shapes already.
        """
        ...

    def claim_shape(self, shape_id: int, person_id: int, lease_s: float) -> Lease:
        """Lease a shape by name, labelled already or not; the person's own lease is renewed and returned.

        Raises `ConflictError` if it is with someone else, if the person holds `MAX_HELD` shapes already, or if their
        label of it is among those that are still being compared.
        """
        ...

    def lease(self, lease_id: int) -> Lease: ...

    def leases_of(self, person_id: int) -> Sequence[Lease]:
        """What a person holds, oldest first: the same after a reload. Expired ones too, unless others took them."""
        ...

    def leased_by(self, person_id: int) -> Sequence[LeasedShape]:
        """As `leases_of`, with what is leased."""
        ...

    def leased_shapes(self, lease_ids: SizedIterable[int]) -> Mapping[int, LeasedShape]:
        """Leases with what is leased, ended or not; unknown ids are left out."""
        ...

    def active_leases(self, collection_id: int, *, after: int = 0, limit: int = 1000) -> Sequence[Lease]:
        """A page of the leases that have not ended, by id."""
        ...

    def skips(self, collection_id: int, *, before: int | None = None, limit: int = 1000) -> Sequence[SkippedShape]:
        """A page of the shapes that people gave back for good, by lease id, those that were handed out last first."""
        ...

    def held_shapes(self, shape_ids: SizedIterable[int]) -> Mapping[int, Sequence[Lease]]:
        """The leases that have not ended of each shape; shapes without one are left out."""
        ...

    def renew_lease(self, lease_id: int, person_id: int, lease_s: float, *, is_prefetched: bool | None = None) -> Lease:
        """Let it expire `lease_s` from now. `is_prefetched` False: the person now works on it; None leaves it.

        Raises `ConflictError` if it has ended or is another person's, or if the person holds `MAX_HELD` others.
        """
        ...

    def release_lease(self, lease_id: int, person_id: int) -> Lease:
        """Give the shape back to the queue, at its rank; the draft stays. As it is if it has ended already.

        Raises `ConflictError` if it is another person's.
        """
        ...

    def skip_lease(self, lease_id: int, person_id: int, reason: str) -> Lease:
        """Give it back for good, saying why: this person does not get it again from the queue.

        Raises `ConflictError` if it has ended or is another person's, `ParameterError` without a reason.
        """
        ...

    def clear_lease(self, lease_id: int, operator_id: int) -> Lease:
        """Take a shape from whoever holds it, which goes on the audit trail; the draft stays."""
        ...

    def reopen_shape(self, shape_id: int, operator_id: int, *, for_person_id: int | None = None) -> None:
        """Put a shape first in the queue for another round, for one person or anyone. Leases that expired end.

        Raises `ConflictError` while somebody works on it, or it has no surface to label yet.
        """
        ...

    def assign_shapes(self, shape_ids: Sequence[int], person_id: int | None, operator_id: int) -> int:
        """Keep the free labels of shapes that wait for one person, or with None for anyone again; how many there are.

        Shapes that are not in the queue are left as they are.
        """
        ...

    def set_ranks(self, collection_id: int, ranks: Mapping[int, int]) -> int:
        """Give shapes that wait their ranks, lowest first; how many labels that moved.

        Held ones, those that are just being claimed and what a person put first are not disturbed. Call it with some
        thousand at a time: others wait while it writes.
        """
        ...

    def record_ranking(self, collection_id: int, score_name: str) -> None:
        """Put on record by which score the queue is ranked: leases tell that one."""
        ...

    def ranking_score(self, collection_id: int) -> str:
        """The score by which the queue was ranked last, `DEFAULT_RANKING` if it never was."""
        ...

    def fill_queue(self, collection_id: int, *, after: int = 0, limit: int = 1000) -> int | None:
        """Bring a page of shapes in line with `labels_per_shape`, by id; the last id of it, None after the last.

        For after the setting was changed: free places that are too many go, missing ones come.
        """
        ...

    def queue_depth(self, collection_id: int) -> QueueDepth: ...
