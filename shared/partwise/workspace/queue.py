"""The ranked queue: what to look at next, the least certain first."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from partwise.store.records import Collection, QueueAnchor, QueueRow, Shape, ShapeState
from partwise.workspace.segmentations import EVALUATE
from partwise.workspace.shapes import PAGE
from partwise.workspace.workspace import Workspace


@dataclass(frozen=True, slots=True)
class QueuedShape:
    """One row. `score` and `model_version` are None before a model has seen the shape.

    parts : (name, share of the area in [0, 1]) as predicted, largest first.
    """

    rank: int
    shape: Shape
    state: ShapeState
    score: float | None
    model_version: int | None
    parts: tuple[tuple[str, float], ...]


def ranked_queue(
    workspace: Workspace,
    collection: Collection,
    score_name: str,
    limit: int,
    states: Sequence[ShapeState] | None = None,
) -> list[QueuedShape]:
    """Shapes of the given states by falling score.

    Before any model exists: the first shapes, in the order they were selected.
    """
    rows = workspace.catalog.queue(collection.id, score_name, limit=limit, states=states)
    if not rows and workspace.catalog.latest_model(collection.id) is None:
        return _selection_order(workspace, collection, limit, states)
    names = {part.id: part.name for part in workspace.catalog.parts(collection.id).parts}
    runs = workspace.catalog.stage_runs([row.shape.id for row in rows], EVALUATE)
    return [
        QueuedShape(
            rank,
            row.shape,
            row.state,
            row.value,
            row.model_version,
            _parts(runs[row.shape.id].summary.get("area_share", {}) if row.shape.id in runs else {}, names),
        )
        for rank, row in enumerate(rows, start=1)
    ]


def all_ranked(workspace: Workspace, collection: Collection, score_name: str) -> Iterator[QueueRow]:
    """Every scored shape by falling score, a page at a time."""
    anchor: QueueAnchor | None = None
    while page := workspace.catalog.queue(collection.id, score_name, limit=PAGE, after=anchor):
        yield from page
        anchor = page[-1].anchor


def _selection_order(
    workspace: Workspace, collection: Collection, limit: int, states: Sequence[ShapeState] | None
) -> list[QueuedShape]:
    ids = [first.shape_id for first in workspace.catalog.first_shapes(collection.id)]
    shapes, state_of = workspace.catalog.shapes_by_id(ids), workspace.catalog.shape_states(ids)
    wanted = [shape_id for shape_id in ids if states is None or state_of[shape_id] in states]
    return [
        QueuedShape(rank, shapes[shape_id], state_of[shape_id], None, None, ())
        for rank, shape_id in enumerate(wanted[:limit], start=1)
    ]


def _parts(area_share: dict[str, float], names: dict[int, str]) -> tuple[tuple[str, float], ...]:
    shares = [(names.get(int(part_id), f"part {part_id}"), share) for part_id, share in area_share.items() if share > 0]
    return tuple(sorted(shares, key=lambda item: -item[1]))
