"""Label revisions."""

from dataclasses import dataclass
from datetime import datetime
from enum import StrEnum

import numpy as np
from jaxtyping import Integer

from partwise.store.reviews import RevisionOrigin


class RevisionKind(StrEnum):
    """Who made labels. Reference labels are ground truth for experiments: never trained on, never shown."""

    HUMAN = "human"
    IMPORTED = "imported"
    REFERENCE = "reference"


@dataclass(frozen=True, slots=True, eq=False)
class NewRevision:
    """Labels to commit: (m,) part ids in the face order of the mesh `mesh_hash`, 0 = unlabelled.

    origin : of labels that were moved from another mesh, how; then `parent_id` is the newest revision of its kinds.
    """

    shape_id: int
    mesh_hash: str
    kind: RevisionKind
    author_id: int
    schema_version: int
    labels: Integer[np.ndarray, " m"]
    parent_id: int | None = None
    origin: RevisionOrigin | None = None


@dataclass(frozen=True, slots=True)
class LabelRevision:
    """An immutable revision without its labels; `sha256` is that of the raw uint16 labels.

    origin : None for labels as someone made them; else how they were moved to this mesh.
    """

    id: int
    shape_id: int
    mesh_hash: str
    kind: RevisionKind
    parent_id: int | None
    author_id: int
    schema_version: int
    n_faces: int
    sha256: str
    created_at: datetime
    origin: RevisionOrigin | None = None


@dataclass(frozen=True, slots=True)
class Effort:
    """What labels took whoever made them: seconds at work, without pauses, and presses."""

    active_s: float
    n_clicks: int
