"""Labels follow their shape to another mesh: as a child revision, with a review where too little of them came along.

A shape gets another mesh when it is preprocessed with other parameters or at another resolution; and labels that come
with a file belong to the file's own faces, not to the working mesh. What somebody made is never changed: it stays as
the parent. Labels are moved from what a person made or accepted, never from what was merely moved before, so that
errors do not add up.
"""

import uuid
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import UInt16

from partwise.errors import ConflictError, PartwiseError, StoreError
from partwise.remesh.moved_labels import MovedLabels, moved_labels
from partwise.store.array_store import ArrayStore
from partwise.store.catalog import SHOWN_KINDS, LabelCatalog
from partwise.store.meshes import keep_mesh, read_mesh
from partwise.store.records import Collection, LabelRevision, Mesh, NewFailure, NewRevision, RevisionKind, Shape
from partwise.store.reviews import NewReview, ReviewOutcome, ReviewReason, RevisionOrigin
from partwise.workspace.progress import OnRunProgress, RunProgress
from partwise.workspace.shapes import pages_of_shapes
from partwise.workspace.workspace import Workspace

MIN_AGREEMENT = 0.98
"""Share of the labelled area that must survive the way there and back; labels that fall below wait for a review."""

RELABEL = "relabel"
"""Under this name, as if it were a stage, the catalog lists shapes whose labels could not be moved."""

_GROUPS: tuple[tuple[RevisionKind, ...], ...] = (SHOWN_KINDS, (RevisionKind.REFERENCE,))


@dataclass(frozen=True, slots=True)
class PendingMove:
    """A shape whose newest labels of some kinds, `head`, are on another mesh than its present working mesh.

    source : the labels to move, which somebody made or accepted: the head, or what the head was moved from.
    """

    shape: Shape
    head: LabelRevision
    source: LabelRevision
    old_mesh: Mesh
    new_mesh: Mesh


@dataclass(frozen=True, slots=True)
class MoveReport:
    """How many labels were moved, how many of those wait for a review, and how many could not be moved."""

    n_moved: int
    n_in_review: int
    n_failed: int


def pending_moves(workspace: Workspace, collection: Collection) -> Iterator[PendingMove]:
    """Every move that the collection lacks, by shape id."""
    for page in pages_of_shapes(workspace.catalog, collection.id):
        yield from moves_of(workspace, page)


def moves_of(workspace: Workspace, shapes: Sequence[Shape]) -> Iterator[PendingMove]:
    """The moves that these shapes lack, in their order."""
    catalog, ids = workspace.catalog, [shape.id for shape in shapes]
    meshes = catalog.meshes(ids)
    heads = [catalog.head_revisions(ids, kinds) for kinds in _GROUPS]
    for shape in shapes:
        new_mesh = meshes.get(shape.id)
        for head in (of_group.get(shape.id) for of_group in heads):
            if head is not None and new_mesh is not None and head.mesh_hash != new_mesh.mesh_hash:
                source = _source(workspace, head, new_mesh.mesh_hash)
                yield PendingMove(shape, head, source, catalog.mesh(shape.id, source.mesh_hash), new_mesh)


def compute_move(arrays: ArrayStore, old_mesh: Mesh, new_mesh: Mesh, labels: UInt16[np.ndarray, " n"]) -> MovedLabels:
    """Reads both meshes and moves the labels; on one and the same mesh they stay as they are.

    Raises
    ------
    NotFoundError : a mesh is stored nowhere any more.
    StoreError : the store cannot be read, or holds another mesh than the record says.
    """
    if old_mesh.mesh_hash == new_mesh.mesh_hash:
        return MovedLabels(labels, 1.0)
    return moved_labels(read_mesh(arrays, old_mesh), read_mesh(arrays, new_mesh), labels)


def commit_move(workspace: Workspace, move: PendingMove, moved: MovedLabels) -> LabelRevision | None:
    """Keeps the bytes of both meshes, then commits the child revision and, below `MIN_AGREEMENT`, its review.

    Reference labels, which nobody is shown, are not reviewed; their agreement is on record all the same. Returns None,
    and commits nothing, where somebody has committed newer labels meanwhile: those are then the ones to move.

    Raises
    ------
    StoreError : a store cannot be reached or written.
    """
    for mesh in (move.old_mesh, move.new_mesh):
        keep_mesh(workspace.catalog, workspace.arrays, mesh)
    head, source = move.head, move.source
    child = NewRevision(
        shape_id=head.shape_id,
        mesh_hash=move.new_mesh.mesh_hash,
        kind=head.kind,
        author_id=head.author_id,
        schema_version=head.schema_version,
        labels=moved.labels,
        parent_id=head.id,
        origin=RevisionOrigin(source.mesh_hash, source.id, moved.agreement),
    )
    is_doubtful = moved.agreement < MIN_AGREEMENT and head.kind in SHOWN_KINDS
    detail = {"agreement": moved.agreement, "moved_from": source.mesh_hash}
    review = NewReview(ReviewReason.MAP_BACK, detail) if is_doubtful else None
    try:
        return workspace.catalog.add_revision(child, review)
    except ConflictError:
        return None


def record_failed_move(workspace: Workspace, move: PendingMove, reason: str) -> None:
    """Names the shape and the reason, one line, among the failures; the next preprocessing tries again."""
    workspace.catalog.record_failure(NewFailure(move.shape.id, RELABEL, move.new_mesh.mesh_hash, reason))


def forget_failed_moves(workspace: Workspace, collection: Collection) -> None:
    """Before all missing moves are tried again: shapes that need none any more are not named as failed for ever."""
    workspace.catalog.clear_failures(collection.id, RELABEL)


def move_here(workspace: Workspace, collection: Collection, on_progress: OnRunProgress = lambda _: None) -> MoveReport:
    """Makes the collection's missing moves one after the other in this process; a shape that fails costs only itself.

    Raises
    ------
    StoreError : a store is full or cannot be reached.
    """
    forget_failed_moves(workspace, collection)
    n_total = sum(1 for _ in pending_moves(workspace, collection))
    n_moved = n_in_review = n_failed = 0
    for move in pending_moves(workspace, collection):
        on_progress(RunProgress(n_moved, n_failed, n_total))
        try:
            labels = workspace.catalog.labels(move.source.id)
            moved = compute_move(workspace.arrays, move.old_mesh, move.new_mesh, labels)
        except PartwiseError as error:
            if isinstance(error, StoreError):
                require_store(workspace.arrays)
            record_failed_move(workspace, move, str(error))
            n_failed += 1
            continue
        committed = commit_move(workspace, move, moved)
        if committed is not None:
            n_moved += 1
            n_in_review += waits_for_review(committed)
    if n_total:
        on_progress(RunProgress(n_moved, n_failed, n_total))
    return MoveReport(n_moved, n_in_review, n_failed)


def require_store(arrays: ArrayStore) -> None:
    """Tells a store that is down, which raises StoreError here, from one damaged object."""
    probe = f"probe/{uuid.uuid4().hex}"
    arrays.stage(probe, {"probe": np.zeros(1, dtype=np.uint8)})
    arrays.delete_staged(probe)


def waits_for_review(moved: LabelRevision) -> bool:
    """Whether a review came with a moved revision."""
    return moved.origin is not None and moved.origin.agreement < MIN_AGREEMENT and moved.kind in SHOWN_KINDS


def origin_on(catalog: LabelCatalog, head: LabelRevision, mesh_hash: str) -> LabelRevision | None:
    """The revision on this mesh that is the head or that the head was moved from; None if none of them is on it."""
    return next((each for each in with_origins(catalog, head) if each.mesh_hash == mesh_hash), None)


def with_origins(catalog: LabelCatalog, head: LabelRevision) -> Iterator[LabelRevision]:
    """The head, what it was moved from, and so on back to what somebody made."""
    yield head
    while head.origin is not None:
        head = catalog.revision(head.origin.source_id)
        yield head


def _source(workspace: Workspace, head: LabelRevision, mesh_hash: str) -> LabelRevision:
    """What of the head's origins to move: that on the very mesh wanted, else the latest that a person vouches for."""
    if head.origin is None:
        return head
    catalog = workspace.catalog
    exact = origin_on(catalog, head, mesh_hash)
    if exact is not None:
        return exact
    accepted = {
        review.revision_id for review in catalog.reviews(head.shape_id) if review.outcome is ReviewOutcome.ACCEPTED
    }
    return next(each for each in with_origins(catalog, head) if each.origin is None or each.id in accepted)
