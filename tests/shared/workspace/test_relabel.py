"""Labels follow their shape to another mesh; what people made stays as it was."""

from dataclasses import dataclass
from datetime import timedelta

import numpy as np
import pytest

from partwise.errors import StoreError
from partwise.mesh import TriMesh
from partwise.store.meshes import kept_mesh_key
from partwise.store.records import Collection, LabelRevision, RevisionKind, Shape, ShapeState
from partwise.store.reviews import ReviewOutcome, ReviewReason
from partwise.testing.spheres import ball, halves, speckles
from partwise.testing.workspaces import publish_meshes
from partwise.workspace import relabel as module
from partwise.workspace.garbage import collect_garbage
from partwise.workspace.labelling import commit_labels
from partwise.workspace.relabel import MIN_AGREEMENT, RELABEL, MoveReport, move_here, pending_moves
from partwise.workspace.workspace import Workspace

KEY = "a.off"


COARSE, MIDDLE, FINE = ball(1), ball(2), ball(3)


@dataclass
class Labelled:
    """A shape whose first mesh somebody labelled."""

    workspace: Workspace
    collection: Collection
    shape: Shape

    def publish(self, mesh: TriMesh, key: str) -> None:
        publish_meshes(self.workspace, {self.shape.id: mesh}, key)

    def label(self, labels: np.ndarray, kind: RevisionKind = RevisionKind.HUMAN) -> LabelRevision:
        return commit_labels(self.workspace, self.collection, self.shape, labels, kind, "ann")

    def move(self) -> MoveReport:
        return move_here(self.workspace, self.collection)

    def head(self, *kinds: RevisionKind) -> LabelRevision:
        head = self.workspace.catalog.head_revision(self.shape.id, *([kinds] if kinds else []))
        assert head is not None
        return head

    def labels(self) -> np.ndarray:
        return self.workspace.catalog.labels(self.head().id)

    def state(self) -> ShapeState:
        return self.workspace.catalog.shape_states([self.shape.id])[self.shape.id]


@pytest.fixture
def shape(filled) -> Labelled:
    """Without a mesh so far."""
    return Labelled(filled.workspace, filled.collection, filled.shape(KEY))


@pytest.fixture
def labelled(shape: Labelled) -> Labelled:
    """Its fine mesh is labelled by halves; its present mesh is coarser."""
    shape.publish(FINE, "fine")
    shape.label(halves(FINE))
    shape.publish(MIDDLE, "middle")
    return shape


@pytest.mark.parametrize("kind", list(RevisionKind))
def test_labels_come_along_as_a_child_of_the_same_kind_and_author(shape: Labelled, kind: RevisionKind) -> None:
    shape.publish(FINE, "fine")
    parent = shape.label(halves(FINE), kind)
    shape.publish(MIDDLE, "middle")
    assert shape.move() == MoveReport(1, 0, 0)
    child = shape.head(kind)
    assert (child.mesh_hash, child.parent_id) == (MIDDLE.content_hash(), parent.id)
    assert (child.kind, child.author_id, child.schema_version) == (kind, parent.author_id, parent.schema_version)
    np.testing.assert_array_equal(shape.workspace.catalog.labels(child.id), halves(MIDDLE))


def test_the_agreement_is_on_record(labelled: Labelled) -> None:
    parent = labelled.head()
    labelled.move()
    origin = labelled.head().origin
    assert origin is not None
    assert (origin.moved_from, origin.source_id) == (FINE.content_hash(), parent.id)
    assert MIN_AGREEMENT <= origin.agreement <= 1


def test_what_somebody_made_stays_as_it_was(labelled: Labelled) -> None:
    before = labelled.workspace.catalog.revisions(labelled.shape.id)
    labelled.move()
    assert labelled.workspace.catalog.revisions(labelled.shape.id)[:1] == before
    np.testing.assert_array_equal(labelled.workspace.catalog.labels(before[0].id), halves(FINE))


def test_moving_again_changes_nothing(labelled: Labelled) -> None:
    labelled.move()
    before = labelled.workspace.catalog.revisions(labelled.shape.id)
    assert labelled.move() == MoveReport(0, 0, 0)
    assert labelled.workspace.catalog.revisions(labelled.shape.id) == before


def test_shapes_without_labels_have_nothing_to_move(shape: Labelled) -> None:
    shape.publish(FINE, "fine")
    shape.publish(MIDDLE, "middle")
    assert list(pending_moves(shape.workspace, shape.collection)) == []


def test_labels_wait_for_their_shape_to_have_a_mesh_again(shape: Labelled) -> None:
    shape.publish(FINE, "fine")
    shape.label(halves(FINE))
    assert shape.move() == MoveReport(0, 0, 0)


def test_labels_that_suffer_wait_for_a_review(shape: Labelled) -> None:
    shape.publish(FINE, "fine")
    shape.label(speckles(FINE))
    shape.publish(COARSE, "coarse")
    assert shape.move() == MoveReport(1, 1, 0)
    head = shape.head()
    assert head.origin is not None
    assert head.origin.agreement < MIN_AGREEMENT
    (review,) = shape.workspace.catalog.reviews(shape.shape.id)
    assert (review.reason, review.revision_id, review.outcome) == (ReviewReason.MAP_BACK, head.id, None)
    assert review.detail == {"agreement": head.origin.agreement, "moved_from": FINE.content_hash()}
    assert shape.state() is ShapeState.REVIEW


def test_reference_labels_that_suffer_are_not_reviewed(shape: Labelled) -> None:
    shape.publish(FINE, "fine")
    shape.label(speckles(FINE), RevisionKind.REFERENCE)
    shape.publish(COARSE, "coarse")
    assert shape.move() == MoveReport(1, 0, 0)
    origin = shape.head(RevisionKind.REFERENCE).origin
    assert origin is not None
    assert origin.agreement < MIN_AGREEMENT
    assert shape.workspace.catalog.reviews(shape.shape.id) == []


def test_errors_do_not_add_up(shape: Labelled) -> None:
    shape.publish(FINE, "fine")
    made = shape.label(speckles(FINE))
    for mesh, key in ((COARSE, "coarse"), (MIDDLE, "middle")):
        shape.publish(mesh, key)
        shape.move()
    head = shape.head()
    assert head.origin is not None
    assert head.origin.source_id == made.id
    superseded, opened = shape.workspace.catalog.reviews(shape.shape.id)
    assert (superseded.outcome, opened.outcome) == (ReviewOutcome.SUPERSEDED, None)


def test_labels_are_exact_again_where_they_were_made(shape: Labelled) -> None:
    shape.publish(FINE, "fine")
    shape.label(speckles(FINE))
    for mesh, key in ((COARSE, "coarse"), (FINE, "fine")):
        shape.publish(mesh, key)
        shape.move()
    np.testing.assert_array_equal(shape.labels(), speckles(FINE))
    assert shape.state() is ShapeState.CONFIRMED


def test_what_a_person_accepted_is_moved_from_there(shape: Labelled) -> None:
    shape.publish(FINE, "fine")
    made = shape.label(speckles(FINE))
    shape.publish(COARSE, "coarse")
    shape.move()
    accepted = shape.head()
    (review,) = shape.workspace.catalog.reviews(shape.shape.id)
    shape.workspace.catalog.accept_review(review.id, made.author_id)
    shape.publish(MIDDLE, "middle")
    shape.move()
    head = shape.head()
    assert head.origin is not None
    assert head.origin.source_id == accepted.id


def test_confirming_moved_labels_makes_them_a_persons_own(labelled: Labelled) -> None:
    labelled.move()
    moved = labelled.head()
    confirmed = labelled.label(labelled.labels())
    assert (confirmed.parent_id, confirmed.origin) == (moved.id, None)


def test_both_meshes_are_kept_and_never_swept(labelled: Labelled) -> None:
    labelled.move()
    labelled.publish(COARSE, "coarse")
    collect_garbage(labelled.workspace, timedelta(0))
    collect_garbage(labelled.workspace, timedelta(0))
    for mesh in (FINE, MIDDLE):
        assert labelled.workspace.arrays.exists(kept_mesh_key(mesh.content_hash()))


class PowerCut(BaseException):
    """Not an error: the end of the process."""


def test_a_run_that_was_killed_before_the_commit_is_completed_by_the_next(
    labelled: Labelled, monkeypatch: pytest.MonkeyPatch
) -> None:
    def end(*_: object) -> None:
        raise PowerCut

    with monkeypatch.context() as dying:
        dying.setattr(labelled.workspace.catalog, "add_revision", end)
        with pytest.raises(PowerCut):
            labelled.move()
    assert labelled.workspace.arrays.exists(kept_mesh_key(MIDDLE.content_hash()))
    assert labelled.head().mesh_hash == FINE.content_hash()
    assert labelled.move() == MoveReport(1, 0, 0)
    np.testing.assert_array_equal(labelled.labels(), halves(MIDDLE))


def test_labels_that_a_person_commits_meanwhile_are_never_hidden(
    labelled: Labelled, monkeypatch: pytest.MonkeyPatch
) -> None:
    compute = module.compute_move

    def slow(*arguments: object) -> object:
        labelled.label(speckles(MIDDLE))
        return compute(*arguments)  # type: ignore[arg-type]

    monkeypatch.setattr(module, "compute_move", slow)
    assert labelled.move() == MoveReport(0, 0, 0)
    np.testing.assert_array_equal(labelled.labels(), speckles(MIDDLE))


def test_a_shape_that_cannot_be_moved_is_named_and_tried_again(
    labelled: Labelled, monkeypatch: pytest.MonkeyPatch
) -> None:
    key = kept_mesh_key(FINE.content_hash())
    kept = labelled.workspace.arrays.get_bytes(key)
    labelled.workspace.arrays.put_bytes(key, b"damaged")
    assert labelled.move() == MoveReport(0, 0, 1)
    (failure,) = labelled.workspace.catalog.failures(labelled.collection.id)
    assert (failure.source_key, failure.run.stage) == (KEY, RELABEL)
    assert "safetensors" in str(failure.run.reason)
    labelled.workspace.arrays.put_bytes(key, kept)
    assert labelled.move() == MoveReport(1, 0, 0)
    assert labelled.workspace.catalog.failures(labelled.collection.id) == []


def test_a_store_that_is_down_is_no_shapes_fault(labelled: Labelled, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise StoreError("the array store refused; is it reachable?")

    for name in ("get_bytes", "read_many", "stage"):
        monkeypatch.setattr(labelled.workspace.arrays, name, refuse)
    with pytest.raises(StoreError, match="is it reachable"):
        labelled.move()
    assert labelled.workspace.catalog.failures(labelled.collection.id) == []


def test_a_shape_that_is_back_on_the_mesh_of_its_labels_is_not_named_any_more(labelled: Labelled) -> None:
    key = kept_mesh_key(FINE.content_hash())
    kept = labelled.workspace.arrays.get_bytes(key)
    labelled.workspace.arrays.put_bytes(key, b"damaged")
    assert labelled.move().n_failed == 1
    labelled.workspace.arrays.put_bytes(key, kept)
    labelled.publish(FINE, "fine again")
    assert labelled.move() == MoveReport(0, 0, 0)
    assert labelled.workspace.catalog.failures(labelled.collection.id) == []


def test_progress_is_told(labelled: Labelled) -> None:
    told: list[tuple[int, int, int]] = []
    move_here(labelled.workspace, labelled.collection, lambda p: told.append((p.n_done, p.n_failed, p.n_total)))
    assert told == [(0, 0, 1), (1, 0, 1)]
