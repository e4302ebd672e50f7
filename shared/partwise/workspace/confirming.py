"""Confirming a draft: its strokes folded into labels, compared where the collection asks for it, then committed."""

from dataclasses import dataclass
from functools import partial

import numpy as np
from jaxtyping import UInt16

from partwise.errors import ConflictError, NotFoundError, StaleDraftError
from partwise.labels.annotation_cost import annotation_cost
from partwise.labels.encoding import labels_sha256
from partwise.labels.fold import FoldedLog, checked_fold
from partwise.labels.operations import Paint, SegmentWide
from partwise.labels.replay import replay
from partwise.labels.stroke_json import stroke_from_document
from partwise.labels.strokes import Stroke, StrokeLog
from partwise.mesh import TriMesh
from partwise.store.meshes import keep_mesh
from partwise.store.records import (
    Closeness,
    Confirmation,
    Draft,
    DraftOutcome,
    Lease,
    LeasePurpose,
    Mesh,
    NewBlindCheck,
    NewConfirmation,
    NewConsensus,
    NewDraft,
    RevisionKind,
)
from partwise.workspace.accepting import settle_rechecks
from partwise.workspace.consensus import closeness, compared
from partwise.workspace.shapes import load_mesh, shape_mesh
from partwise.workspace.workspace import Workspace

_PAGE = 10_000
_QUICK = 50_000_000  # faces, counted again for each stroke: any may touch all
_TRIES = 5  # each fails only if another of the shape's labels came in while this was compared


@dataclass(frozen=True, slots=True, eq=False)
class DraftWork:
    """A draft with its mesh, the labels (m,) it starts from and its strokes: all that replaying it takes.

    stored : where the mesh is.
    """

    draft: Draft
    stored: Mesh
    mesh: TriMesh
    base_labels: UInt16[np.ndarray, " m"]
    log: StrokeLog

    @property
    def is_quickly_replayed(self) -> bool:
        """Whether replaying takes no region that must be grown, and is over in a fraction of a second."""
        is_grown = any(isinstance(stroke.operation, Paint | SegmentWide) for stroke in self.log.strokes)
        return not is_grown and len(self.log.strokes) * self.log.n_faces <= _QUICK

    def replayed(self) -> UInt16[np.ndarray, " m"]:
        """The labels that the strokes leave. Raises as `replay`."""
        return replay(self.mesh, self.base_labels, self.log)


def begin_draft(workspace: Workspace, lease: Lease, person_id: int, base_revision: int | None = None) -> Draft:
    """The person's open draft of a shape that they hold, or a new one on the shape's present mesh.

    base_revision : labels to start from; None for none.

    Raises
    ------
    ConflictError : the lease has ended or is another person's, or the shape has no mesh.
    LabelError : the base is not labels of the shape's present mesh, or there is no such revision.
    """
    mesh = shape_mesh(workspace, workspace.catalog.shape(lease.shape_id))
    schema = workspace.catalog.parts(lease.collection_id)
    if base_revision is None:
        sha256 = labels_sha256(np.zeros(mesh.n_faces, dtype=np.uint16))
    else:
        try:
            sha256 = workspace.catalog.revision(base_revision).sha256
        except NotFoundError:  # refused as one of another shape is: which ids there are is not told
            sha256 = ""
    new = NewDraft(mesh.mesh_hash, base_revision, sha256, schema.version)
    return workspace.catalog.open_draft(lease.id, person_id, new)


def draft_work(workspace: Workspace, draft: Draft) -> DraftWork:
    """Reads what a draft consists of.

    Raises
    ------
    NotFoundError, StoreError : the mesh or the labels it starts from cannot be read.
    """
    stored = workspace.catalog.mesh(draft.shape_id, draft.mesh_hash)
    mesh = load_mesh(workspace, stored)
    if draft.base_revision is None:
        base = np.zeros(mesh.n_faces, dtype=np.uint16)
    else:
        base = workspace.catalog.labels(draft.base_revision)
    strokes = tuple(_strokes(workspace, draft))
    log = StrokeLog(draft.mesh_hash, mesh.n_faces, draft.base_revision, draft.base_sha256, strokes)
    return DraftWork(draft, stored, mesh, base, log)


def confirm(
    workspace: Workspace, draft_id: int, person_id: int, n_strokes: int, expected_sha256: str | None = None
) -> Confirmation:
    """Folds the draft's strokes and commits the labels: see `DraftCatalog.confirm_draft` for what becomes of them.

    Parameters
    ----------
    n_strokes : strokes that the person had done when confirming; more on record are another window's.
    expected_sha256 : checksum of the labels that the person saw.

    Raises
    ------
    StaleDraftError : the draft or the shape went on elsewhere. ConflictError : another person's draft, one that is
        closed, other labels than the person saw, or the shape is with someone else.
    LabelError : strokes that cannot be replayed, or a part that the schema has lost.
    """
    work = work_to_confirm(workspace, workspace.catalog.draft(draft_id))
    return confirm_labels(workspace, work, work.replayed(), person_id, n_strokes, expected_sha256)


def work_to_confirm(workspace: Workspace, draft: Draft) -> DraftWork:
    """What a draft that is about to be confirmed consists of. Raises ConflictError if it is discarded."""
    if draft.outcome is DraftOutcome.DISCARDED:
        raise ConflictError(f"a draft must be open to be confirmed but draft {draft.id} is discarded; open another")
    return draft_work(workspace, draft)


def confirm_labels(
    workspace: Workspace,
    work: DraftWork,
    labels: UInt16[np.ndarray, " m"],
    person_id: int,
    n_strokes: int,
    expected_sha256: str | None = None,
) -> Confirmation:
    """Commits the labels that the draft's strokes leave, which may have taken a while; all else as `confirm`."""
    confirmation = _confirmed(workspace, work, labels, person_id, n_strokes, expected_sha256)
    if confirmation.revision_id is not None:
        settle_rechecks(workspace, work.draft.collection_id, confirmation.shape_id)
    return confirmation


def _confirmed(
    workspace: Workspace,
    work: DraftWork,
    labels: UInt16[np.ndarray, " m"],
    person_id: int,
    n_strokes: int,
    expected_sha256: str | None,
) -> Confirmation:
    draft = work.draft
    _refuse_later_strokes(workspace, work, n_strokes)
    schema = workspace.catalog.parts(draft.collection_id)
    folded = checked_fold(work.log, labels, schema, expected_sha256)
    keep_mesh(workspace.catalog, workspace.arrays, work.stored)
    cost = annotation_cost(work.log.strokes, opened_at=draft.created_at)
    new = partial(NewConfirmation, draft.id, person_id, n_strokes, folded.labels, folded.schema_version, cost=cost)
    if draft.purpose is LeasePurpose.BLIND:
        return workspace.catalog.confirm_draft(new(blind_check=_blind_check(workspace, work, folded)))
    if draft.purpose is LeasePurpose.LABEL or draft.outcome is not None:
        return workspace.catalog.confirm_draft(new())
    return _confirm_one_of_several(workspace, work, folded, new)


def _refuse_later_strokes(workspace: Workspace, work: DraftWork, n_strokes: int) -> None:
    """Strokes that came on record after the log was read are in no labels, so that they cannot be confirmed with it."""
    draft, n_read = work.draft, len(work.log.strokes)
    if draft.outcome is not None or n_strokes <= n_read:
        return
    head = workspace.catalog.head_revision(draft.shape_id)
    state = {
        "draft_id": draft.id,
        "n_strokes": n_read,
        "base_revision": draft.base_revision,
        "seen_revision": draft.seen_revision,
        "head_revision": None if head is None else head.id,
        "mesh_hash": draft.mesh_hash,
        "outcome": None,
    }
    message = f"all strokes are confirmed but draft {draft.id} had {n_read}, not {n_strokes}; send them and try again"
    raise StaleDraftError(message, state)


def _confirm_one_of_several(
    workspace: Workspace, work: DraftWork, folded: FoldedLog, new: "partial[NewConfirmation]"
) -> Confirmation:
    """The last labels of a round come with how all of them compare; whether they are last is known at the commit."""
    for left in reversed(range(_TRIES)):
        try:
            return workspace.catalog.confirm_draft(new(consensus=_consensus(workspace, work, folded)))
        except StaleDraftError as error:
            if not left or error.state["n_strokes"] != folded.n_strokes or _is_unseen_head(error):
                raise
    raise ConflictError(f"draft {work.draft.id} could not be compared, as others came in each time; confirm it again")


def _is_unseen_head(error: StaleDraftError) -> bool:
    return error.state["head_revision"] not in (error.state["seen_revision"], error.state["base_revision"])


def _consensus(workspace: Workspace, work: DraftWork, folded: FoldedLog) -> NewConsensus | None:
    """How the round's labels compare if these complete it; labels on another mesh are as far from them as can be."""
    peers, n_awaited = workspace.catalog.awaited_answers(work.draft.id)
    if n_awaited:
        return None
    if any(peer.mesh_hash != work.draft.mesh_hash for peer in peers):
        return NewConsensus(tuple(peer.id for peer in peers), Closeness(0.0, 0.0, 1.0), None)
    labels = [(peer.id, workspace.catalog.answer_labels(peer.id)) for peer in peers]
    return compared(work.mesh, labels, folded.labels)


def _blind_check(workspace: Workspace, work: DraftWork, folded: FoldedLog) -> NewBlindCheck | None:
    """How close the labels come to the reference; None if that has gone or is of another mesh."""
    reference = workspace.catalog.head_revision(work.draft.shape_id, (RevisionKind.REFERENCE,))
    if reference is None or reference.mesh_hash != work.draft.mesh_hash:
        return None
    return NewBlindCheck(reference.id, closeness(work.mesh, folded.labels, workspace.catalog.labels(reference.id)))


def _strokes(workspace: Workspace, draft: Draft) -> list[Stroke]:
    found: list[Stroke] = []
    while len(found) < draft.n_strokes:
        page = workspace.catalog.strokes(draft.id, after=len(found) - 1, limit=_PAGE)
        found.extend(stroke_from_document(stroke.payload) for stroke in page)
        if not page:
            break
    return found[: draft.n_strokes]
