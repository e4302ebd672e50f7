"""What must hold after any load, read from the database's own log: no shape twice, no acknowledged stroke lost."""

from collections import defaultdict
from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TypeVar

from sqlalchemy import Engine, select

from partwise.store import tables as t
from partwise.store.engine import reading
from partwise_cli.bench.load_people import Hold

Subject = TypeVar("Subject", bound=Hashable)


@dataclass(frozen=True, slots=True)
class LoadChecks:
    """Each list is empty if all is well, else says what is wrong. n_leases, n_strokes : that were looked at."""

    n_leases: int
    n_strokes: int
    slots_leased_twice: list[str]
    given_to_one_person_twice: list[str]
    seen_by_two_people: list[str]
    strokes_lost_or_twice: list[str]

    @property
    def is_sound(self) -> bool:
        return not (
            self.slots_leased_twice
            or self.given_to_one_person_twice
            or self.seen_by_two_people
            or self.strokes_lost_or_twice
        )


def check_load(
    engine: Engine, collection_id: int, holds: Iterable[Hold], acknowledged: Mapping[int, Sequence[str]]
) -> LoadChecks:
    """Reads leases and strokes of the collection and compares them with what the people saw.

    Leases of one (shape, slot) must not overlap, on record and as the people saw them; nobody must be given a shape
    twice, as nobody skips, releases or loses one under this load; the strokes on record must be those acknowledged.
    """
    with reading(engine) as connection:
        lease = t.lease.c
        columns = (lease.shape_id, lease.slot, lease.person_id, lease.acquired_at, lease.released_at)
        leases = connection.execute(select(*columns).where(lease.collection_id == collection_id)).all()
        stroke = t.stroke.c
        recorded: dict[int, list[str]] = defaultdict(list)
        query = select(stroke.draft_id, stroke.id).order_by(stroke.draft_id, stroke.sequence)
        of_collection = select(t.draft.c.id).where(t.draft.c.collection_id == collection_id)
        for row in connection.execute(query.where(stroke.draft_id.in_(of_collection))):
            recorded[row.draft_id].append(row.id)
    spans = [
        ((row.shape_id, row.slot), row.acquired_at.timestamp(), _end(row.released_at and row.released_at.timestamp()))
        for row in leases
    ]
    counts: dict[tuple[int, int], int] = defaultdict(int)
    for lease_row in leases:
        counts[lease_row.person_id, lease_row.shape_id] += 1
    return LoadChecks(
        len(leases),
        sum(map(len, recorded.values())),
        [f"shape {shape_id}, slot {slot}" for shape_id, slot in _overlapping(spans)],
        [f"person {person}, shape {shape}: {n} times" for (person, shape), n in counts.items() if n > 1],
        [f"shape {shape_id}" for shape_id in _overlapping((h.shape_id, h.since_s, h.until_s) for h in holds)],
        _differing(recorded, acknowledged),
    )


def _end(released_s: float | None) -> float:
    return float("inf") if released_s is None else released_s


def _overlapping(spans: Iterable[tuple[Subject, float, float]]) -> list[Subject]:
    """What has two intervals that overlap. spans : (whose or what, since, until), in seconds of one clock."""
    by_subject: dict[Subject, list[tuple[float, float]]] = defaultdict(list)
    for subject, since, until in spans:
        by_subject[subject].append((since, until))
    return [
        subject
        for subject, own in by_subject.items()
        if any(following[0] < earlier[1] for earlier, following in pairwise(sorted(own)))
    ]


def _differing(recorded: Mapping[int, Sequence[str]], acknowledged: Mapping[int, Sequence[str]]) -> list[str]:
    return [
        f"draft {draft_id}: {len(acknowledged.get(draft_id, ()))} acknowledged, {len(recorded.get(draft_id, ()))} there"
        for draft_id in sorted({*recorded, *acknowledged})
        if list(recorded.get(draft_id, ())) != list(acknowledged.get(draft_id, ()))
    ]
