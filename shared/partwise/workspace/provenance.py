"""How a shape came to be what it is: its source, what the original is like, what remeshing tried, each stage's result.

Read from what the stages put on record; nothing is computed. Key type: `ProvenanceCard`.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from partwise.geometry.manifold import ManifoldReport
from partwise.store.records import Shape, ShapeState, StageRun
from partwise.workspace.segmentations import MESH, REMESH
from partwise.workspace.status import STAGE_ORDER
from partwise.workspace.workspace import Workspace

LOG_LINES = 20
"""Of a failure's log, the last so many are on the card."""


@dataclass(frozen=True, slots=True)
class MeshCard:
    """A mesh on record: its content hash and its size."""

    mesh_hash: str
    n_vertices: int
    n_faces: int


@dataclass(frozen=True, slots=True)
class OriginalCard:
    """The mesh as read from the source, and what it is like."""

    mesh: MeshCard
    report: ManifoldReport


@dataclass(frozen=True, slots=True)
class AttemptCard:
    """One try at a closed surface, see `partwise.remesh.ladder.Attempt`: core_s in seconds, dropped_area a share."""

    method: str
    parameters: Mapping[str, float]
    core_s: float
    n_faces: int | None
    dropped_area: float
    distance: float | None
    refused: str | None


@dataclass(frozen=True, slots=True)
class LevelCard:
    """One resolution: faces asked for and reached, or why it is absent. core_s in seconds."""

    n_faces: int
    reached: int | None
    mesh_hash: str | None
    method: str
    distance: float | None
    absent: str | None
    core_s: float


@dataclass(frozen=True, slots=True)
class WorkingCard:
    """The mesh that is described and labelled.

    is_as_is : it is the original itself. working_faces : what the collection asked for. level : which of the levels
    it is, by the faces asked for; None where it is none of them. policy : "auto" or "never".
    """

    mesh: MeshCard
    is_as_is: bool
    policy: str
    working_faces: int
    level: int | None


@dataclass(frozen=True, slots=True)
class FailureCard:
    """Why a stage gave the shape up.

    kind : error, deadline, memory or crash; empty where it is not on record. log : its last lines.
    steps : (step, why) of those that had ended a process before.
    """

    reason: str
    kind: str
    steps: tuple[tuple[str, str], ...]
    log: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class StageCard:
    """A stage's newest run. seconds : of wall time. block : where its arrays are, with the shape's row.

    failure : why it failed; None where it is done. A stage that has a result may have failed later, under other
    parameters: then it has a card for each.
    """

    stage: str
    key: str
    seconds: float
    attempts: int
    finished_at: str
    block: str | None
    row: int | None
    failure: FailureCard | None


@dataclass(frozen=True, slots=True)
class ProvenanceCard:
    """All of it. Times are ISO 8601, in UTC. original, working : None where no such mesh was made yet.

    attempts : of the newest run of remeshing, refused as a whole or not.
    """

    shape_id: int
    source_key: str
    source_hash: str
    ingested_at: str
    state: str
    original: OriginalCard | None
    attempts: tuple[AttemptCard, ...]
    levels: tuple[LevelCard, ...]
    working: WorkingCard | None
    stages: tuple[StageCard, ...]


def provenance(workspace: Workspace, shape: Shape) -> ProvenanceCard:
    """The card of a shape. Reads the catalog only."""
    catalog, ids = workspace.catalog, [shape.id]
    done = {stage: catalog.stage_runs(ids, stage).get(shape.id) for stage in STAGE_ORDER}
    failed = {stage: catalog.failed_runs(ids, stage).get(shape.id) for stage in STAGE_ORDER}
    runs = [run for stage in STAGE_ORDER for run in (done[stage], failed[stage]) if run is not None]
    remesh, refused = done[REMESH], failed[REMESH]
    newest = max((run for run in (remesh, refused) if run is not None), key=lambda run: run.finished_at, default=None)
    return ProvenanceCard(
        shape_id=shape.id,
        source_key=shape.source_key,
        source_hash=shape.source_hash,
        ingested_at=_iso(shape.ingested_at),
        state=catalog.shape_states(ids).get(shape.id, ShapeState.NEW).value,
        original=_original(done[MESH]),
        attempts=tuple(AttemptCard(**each) for each in _entries(newest, "attempts")),
        levels=tuple(LevelCard(**each) for each in _entries(remesh, "levels")),
        working=_working(remesh),
        stages=tuple(_stage(run) for run in runs),
    )


def _entries(run: StageRun | None, name: str) -> Sequence[Mapping[str, Any]]:
    return () if run is None else run.summary.get(name, ())


def _original(run: StageRun | None) -> OriginalCard | None:
    if run is None or "report" not in run.summary:
        return None
    return OriginalCard(_mesh(run.summary), ManifoldReport(**run.summary["report"]))


def _working(run: StageRun | None) -> WorkingCard | None:
    if run is None or "policy" not in run.summary:
        return None
    made = run.summary
    return WorkingCard(_mesh(made), made["is_as_is"], made["policy"], made["working_faces"], made["working_level"])


def _mesh(summary: Mapping[str, Any]) -> MeshCard:
    return MeshCard(summary["mesh_hash"], summary["n_vertices"], summary["n_faces"])


def _stage(run: StageRun) -> StageCard:
    return StageCard(
        stage=run.stage,
        key=run.key,
        seconds=run.seconds,
        attempts=run.attempts,
        finished_at=_iso(run.finished_at),
        block=run.block_name,
        row=run.row,
        failure=None if run.reason is None else _failure(run),
    )


def _failure(run: StageRun) -> FailureCard:
    text = str(run.summary.get("log") or run.summary.get("traceback") or "")
    steps = tuple((str(step), str(why)) for step, why in run.summary.get("steps", {}).items())
    return FailureCard(run.reason or "", str(run.summary.get("kind", "")), steps, tuple(text.splitlines()[-LOG_LINES:]))


def _iso(time: datetime) -> str:
    return time.isoformat(timespec="seconds")
