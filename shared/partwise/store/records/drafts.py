"""Work in progress: drafts and their strokes."""

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from enum import StrEnum
from typing import Any

from partwise.store.records.leases import LeasePurpose


class DraftOutcome(StrEnum):
    """How a draft ended: its labels were confirmed, or the person threw it away."""

    CONFIRMED = "confirmed"
    DISCARDED = "discarded"


@dataclass(frozen=True, slots=True)
class NewDraft:
    """What a draft starts from.

    mesh_hash : one of the shape's meshes, which the strokes are on.
    base_revision : the revision whose labels it starts from, None for a blank shape.
    base_sha256 : checksum of those labels (`partwise.labels.encoding.labels_sha256`).
    schema_version : of the parts that the person sees.
    """

    mesh_hash: str
    base_revision: int | None
    base_sha256: str
    schema_version: int


@dataclass(frozen=True, slots=True)
class Draft:
    """A person's work on a shape: open while `closed_at` is None, whatever becomes of the lease.

    slot, round, purpose : of the person's last lease of the shape.
    n_strokes : strokes on record, which is the sequence of the next one.
    seen_revision : the shape's newest shown labels that the person knows of; newer ones refuse the confirmation.
    labels_sha256 : checksum of what was confirmed.
    active_s, n_clicks : what it had cost when it was confirmed: seconds at work, presses; None if nobody counted.
    """

    id: int
    collection_id: int
    shape_id: int
    slot: int
    round: int
    person_id: int
    purpose: LeasePurpose
    mesh_hash: str
    base_revision: int | None
    base_sha256: str
    seen_revision: int | None
    schema_version: int
    n_strokes: int
    created_at: datetime
    updated_at: datetime
    closed_at: datetime | None
    outcome: DraftOutcome | None
    labels_sha256: str | None
    active_s: float | None = None
    n_clicks: int | None = None


@dataclass(frozen=True, slots=True)
class StoredStroke:
    """A stroke as it was acknowledged. `payload` is the JSON object of `partwise.labels.stroke_json`."""

    sequence: int
    id: str
    payload: Mapping[str, Any]
    recorded_at: datetime
