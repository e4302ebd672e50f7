"""Labels of models accepted in bulk, with a few shapes labelled unknowing, which says how many were wrong."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from partwise.errors import PartwiseError, StoreError
from partwise.store.meshes import keep_mesh
from partwise.store.queue_settings import queue_settings_of
from partwise.store.records import Collection, NewRevision, Recheck, RecheckResult, RevisionKind, Shape
from partwise.workspace.consensus import closeness
from partwise.workspace.segmentations import Segmentation, SegmentedShape, segment
from partwise.workspace.shapes import load_mesh
from partwise.workspace.workspace import Workspace

_PAGE = 100


@dataclass(frozen=True, slots=True)
class RefusedShape:
    """A shape that was not accepted, and why, in one line."""

    shape_id: int
    why: str


@dataclass(frozen=True, slots=True)
class AcceptReport:
    """accepted : ids of shapes whose labels they became. n_drawn : shapes that wait to be labelled unknowing."""

    batch_id: int
    accepted: tuple[int, ...]
    refused: tuple[RefusedShape, ...]
    n_drawn: int


def accept_in_bulk(
    workspace: Workspace,
    collection: Collection,
    shapes: Sequence[Shape],
    segmentation: Segmentation,
    person_id: int,
    n_rechecks: int,
    rng: np.random.Generator,
) -> AcceptReport:
    """Makes a model's labels the shapes', in the name of the person who accepts them.

    A random `n_rechecks` of those that could be accepted are not: they wait in the queue for somebody who labels them
    without knowing. Each shape is committed by itself, so that others at work wait for one at most.

    Raises
    ------
    StoreError : a store cannot be reached; what was accepted until then is.
    """
    agreement = queue_settings_of(collection.settings).agreement
    batch_id = workspace.catalog.begin_accept(collection.id, person_id, segmentation.value, agreement)
    shuffled = [shapes[place] for place in rng.permutation(len(shapes))]
    accepted: list[int] = []
    refused: list[RefusedShape] = []
    n_drawn = 0
    for shape in shuffled:
        try:
            found = next(segment(workspace, [shape], segmentation), None)
            if found is None:
                refused.append(RefusedShape(shape.id, f"it has no {segmentation.value} labels on its present mesh"))
            elif n_drawn < n_rechecks:
                _draw(workspace, collection, batch_id, found)
                n_drawn += 1
            else:
                _accept(workspace, collection, batch_id, found, person_id)
                accepted.append(shape.id)
        except StoreError:
            raise
        except PartwiseError as error:
            refused.append(RefusedShape(shape.id, str(error)))
    return AcceptReport(batch_id, tuple(sorted(accepted)), tuple(refused), n_drawn)


def _draw(workspace: Workspace, collection: Collection, batch_id: int, found: SegmentedShape) -> None:
    keep_mesh(workspace.catalog, workspace.arrays, found.mesh)
    workspace.catalog.draw_shape(
        batch_id, found.shape.id, found.mesh.mesh_hash, collection.schema_version, found.labels.astype(np.uint16)
    )


def _accept(workspace: Workspace, collection: Collection, batch_id: int, found: SegmentedShape, person_id: int) -> None:
    keep_mesh(workspace.catalog, workspace.arrays, found.mesh)
    labels = found.labels.astype(np.uint16)
    revision = NewRevision(
        found.shape.id, found.mesh.mesh_hash, RevisionKind.HUMAN, person_id, collection.schema_version, labels
    )
    workspace.catalog.accept_shape(batch_id, revision)


def settle_rechecks(workspace: Workspace, collection_id: int, shape_id: int | None = None) -> int:
    """Measures accepted labels against those that people have given since; how many. Safe to repeat."""
    n_settled, after = 0, 0
    while page := workspace.catalog.open_rechecks(collection_id, shape_id=shape_id, after=after, limit=_PAGE):
        n_settled += sum(_settle(workspace, drawn) for drawn in page)
        after = page[-1].id
    return n_settled


def _settle(workspace: Workspace, drawn: Recheck) -> bool:
    """Shapes are drawn before anybody labels them: whatever labels are on the same mesh came since."""
    head = workspace.catalog.head_revision(drawn.shape_id, (RevisionKind.HUMAN,))
    if head is None or head.mesh_hash != drawn.mesh_hash:
        return False
    mesh = load_mesh(workspace, workspace.catalog.mesh(drawn.shape_id, drawn.mesh_hash))
    measured = closeness(mesh, workspace.catalog.recheck_labels(drawn.id), workspace.catalog.labels(head.id))
    workspace.catalog.settle_recheck(RecheckResult(drawn.id, head.id, measured))
    return True
