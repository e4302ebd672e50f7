"""Events: what open pages are told."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime
from enum import StrEnum
from typing import Any


class EventKind(StrEnum):
    """What an event is about."""

    QUEUE = "queue"
    TRAINING = "training"
    STAGE = "stage"
    JOB = "job"
    PEOPLE = "people"
    SHAPE = "shape"


@dataclass(frozen=True, slots=True)
class NewEvent:
    """Something that happened; `payload` is small JSON. collection_id : None if it concerns them all."""

    kind: EventKind
    collection_id: int | None
    payload: Mapping[str, Any] = field(default_factory=dict)


REVOKED = NewEvent(EventKind.PEOPLE, None, {"what": "revoked"})
"""A token has ended before its time. It is for processes that trust tokens, all of them, and does not say whose."""


@dataclass(frozen=True, slots=True)
class Event:
    """An event on record. Ids grow in the order in which events become visible, so none is missed by reading on."""

    id: int
    at: datetime
    kind: EventKind
    collection_id: int | None
    payload: Mapping[str, Any]

    @property
    def is_revocation(self) -> bool:
        return (self.kind, self.payload) == (REVOKED.kind, REVOKED.payload)


@dataclass(frozen=True, slots=True)
class EventBounds:
    """The oldest and the newest event on record; 0 and 0 before the first.

    A reader whose last id is below `oldest` − 1 has missed some that were pruned and must read everything anew.
    """

    oldest: int
    newest: int
