"""Commands that say what to label next: select, queue."""

from typing import TYPE_CHECKING, Annotated

import typer

from partwise.store.records import ShapeState
from partwise.workspace.choices import ScoreName
from partwise_cli.arguments import CollectionOption, JsonOption, WorkspaceArgument
from partwise_cli.terminal import print_json, print_table

if TYPE_CHECKING:
    from partwise.workspace.queue import QueuedShape

MIN_SHARE = 0.01
"""Predicted parts below this share of the area are not worth a mention in the table."""


def register(app: typer.Typer) -> None:
    """Adds the commands of this module."""
    for command in (select, queue):
        app.command(rich_help_panel="What to label next")(command)


def select(
    ws: WorkspaceArgument,
    n_clusters: Annotated[int, typer.Option("-k", help="Clusters.", min=1)] = 5,
    n_per_cluster: Annotated[int, typer.Option("-n", help="Shapes nearest to each centre.", min=1)] = 2,
    seed: Annotated[int, typer.Option(help="Of the clustering.", min=0)] = 0,
    collection: CollectionOption = None,
    as_json: JsonOption = False,
) -> None:
    """Choose what to label first.  [dim]partwise select ws -k 5 -n 2[/dim]"""
    from partwise.workspace.first_shapes import select_first_shapes
    from partwise.workspace.ranking import bring_into_order
    from partwise.workspace.shapes import find_collection
    from partwise.workspace.workspace import open_workspace

    with open_workspace(ws) as workspace:
        found = find_collection(workspace, collection)
        firsts = select_first_shapes(workspace, found, n_clusters, n_per_cluster, seed)
        bring_into_order(workspace, found)
        shapes = workspace.catalog.shapes_by_id([first.shape_id for first in firsts])
    rows = [(first.cluster, shapes[first.shape_id].source_key) for first in firsts]
    if as_json:
        print_json([{"cluster": cluster, "shape": key} for cluster, key in rows])
        return
    print_table("Label these first", ("cluster", "shape"), [(str(cluster), key) for cluster, key in rows], (0,))


def queue(
    ws: WorkspaceArgument,
    limit: Annotated[int, typer.Option("--limit", "-l", help="Rows.", min=1)] = 20,
    score: Annotated[ScoreName, typer.Option(help="What to rank by.")] = ScoreName.ENTROPY,
    state: Annotated[ShapeState | None, typer.Option(help="Only shapes in this state.", show_default=False)] = None,
    collection: CollectionOption = None,
    as_json: JsonOption = False,
) -> None:
    """The ranked queue, least certain first.  [dim]partwise queue ws -l 20[/dim]"""
    from partwise.workspace.queue import ranked_queue
    from partwise.workspace.shapes import find_collection
    from partwise.workspace.workspace import open_workspace

    with open_workspace(ws) as workspace:
        found = find_collection(workspace, collection)
        rows = ranked_queue(workspace, found, score, limit, None if state is None else (state,))
        has_model = workspace.catalog.latest_model(found.id) is not None
    if as_json:
        print_json([_as_json(row) for row in rows])
    elif rows:
        columns = ("rank", "shape", "state", score.value.replace("_", " "), "predicted parts", "model")
        title = f"Queue of {found.name}" + ("" if has_model else ": the first shapes, as there is no model yet")
        print_table(title, columns, [_as_row(row) for row in rows], (0, 3, 5))
    else:
        typer.echo(_why_empty(has_model, state))


def _why_empty(has_model: bool, state: ShapeState | None) -> str:
    if state is not None:
        return f"no shape in state {state.value!r} is queued"
    if has_model:
        return "nothing is ranked yet: let the model see the shapes with `partwise evaluate`"
    return "nothing is queued yet: choose the first shapes with `partwise select`"


def _as_row(row: "QueuedShape") -> tuple[str, ...]:
    parts = ", ".join(f"{name} {share:.0%}" for name, share in row.parts if share >= MIN_SHARE)
    score = "–" if row.score is None else f"{row.score:.4f}"
    version = "–" if row.model_version is None else str(row.model_version)
    return str(row.rank), row.shape.source_key, row.state.value, score, parts or "–", version


def _as_json(row: "QueuedShape") -> dict[str, object]:
    return {
        "rank": row.rank,
        "shape": row.shape.source_key,
        "state": row.state.value,
        "score": row.score,
        "parts": dict(row.parts),
        "model_version": row.model_version,
    }
