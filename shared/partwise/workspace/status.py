"""Where a collection stands: shapes by state, stages, the newest model, failures with their reasons."""

from dataclasses import dataclass

from partwise.store.records import Collection
from partwise.workspace.segmentations import DESCRIBE, EVALUATE, MESH, PICTURE, REFINE, REMESH
from partwise.workspace.workspace import Workspace

STAGE_ORDER = (MESH, REMESH, DESCRIBE, PICTURE, EVALUATE, REFINE)


@dataclass(frozen=True, slots=True)
class StageStatus:
    """Shapes with a present result of a stage, and shapes that failed at it."""

    stage: str
    n_done: int
    n_failed: int


@dataclass(frozen=True, slots=True)
class FailedShape:
    """A shape that a stage gave up on, and why."""

    source_key: str
    stage: str
    reason: str


@dataclass(frozen=True, slots=True)
class CollectionStatus:
    """states : (state, shapes). stages : in the order in which they run. failures : the first few."""

    collection: str
    states: tuple[tuple[str, int], ...]
    stages: tuple[StageStatus, ...]
    model_version: int | None
    failures: tuple[FailedShape, ...]


def collection_status(workspace: Workspace, collection: Collection, max_failures: int) -> CollectionStatus:
    """Reads the catalog only."""
    catalog = workspace.catalog
    model = catalog.latest_model(collection.id)
    return CollectionStatus(
        collection.name,
        tuple((state.value, n) for state, n in catalog.state_counts(collection.id).items()),
        tuple(
            StageStatus(count.stage, count.n_done, count.n_failed)
            for count in sorted(catalog.stage_counts(collection.id), key=lambda count: _position(count.stage))
        ),
        model.version if model else None,
        tuple(
            FailedShape(failure.source_key, failure.run.stage, failure.run.reason or "no reason on record")
            for failure in catalog.failures(collection.id, limit=max_failures)
        ),
    )


def _position(stage: str) -> int:
    return STAGE_ORDER.index(stage) if stage in STAGE_ORDER else len(STAGE_ORDER)
