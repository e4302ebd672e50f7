"""From strokes to labels: what becomes of a confirmed draft."""

import uuid
from datetime import UTC, datetime

import numpy as np
import pytest

from partwise.errors import ConflictError, StaleDraftError
from partwise.labels.encoding import labels_sha256
from partwise.labels.operations import Assign
from partwise.labels.strokes import Stroke
from partwise.store.records import Confirmation, Draft, NewClaim, RevisionKind
from partwise.store.reviews import ReviewReason
from partwise.workspace.confirming import begin_draft, confirm, confirm_labels, draft_work, work_to_confirm
from partwise.workspace.labelling import commit_labels


def _begun(filled, name: str, base_revision: int | None = None, draw: float = 0.99) -> Draft:
    """A draft of the next shape by a person of this name."""
    catalog = filled.workspace.catalog
    person = catalog.add_person(name)
    lease = catalog.claim_next(NewClaim(filled.collection.id, person.id, 60, draw))
    assert lease is not None
    return begin_draft(filled.workspace, lease, lease.person_id, base_revision)


def _paint(filled, draft: Draft, labels: list[int]) -> Draft:
    """One stroke for each face."""
    at = datetime(2026, 1, 31, 12, tzinfo=UTC)
    new = [
        Stroke(uuid.uuid4(), face, draft.base_revision, draft.person_id, at, Assign(((face, 1),), label))
        for face, label in enumerate(labels)
    ]
    return filled.workspace.catalog.append_strokes(draft.id, draft.person_id, 0, new)


def _confirmed(filled, draft: Draft, labels: list[int]) -> Confirmation:
    painted = _paint(filled, draft, labels)
    sha256 = labels_sha256(np.array(labels, dtype=np.uint16))
    return confirm(filled.workspace, draft.id, draft.person_id, painted.n_strokes, sha256)


def test_strokes_become_labels_on_a_mesh_that_is_kept(filled) -> None:
    draft = _begun(filled.described(), "ann")
    confirmation = _confirmed(filled, draft, [1, 1, 2, 2])
    catalog = filled.workspace.catalog
    assert confirmation.revision_id is not None
    assert catalog.labels(confirmation.revision_id).tolist() == [1, 1, 2, 2]
    assert catalog.mesh(draft.shape_id, draft.mesh_hash).kept_key is not None


def test_a_draft_starts_from_labels(filled) -> None:
    shape = filled.described().shape("a.off")
    base = commit_labels(
        filled.workspace, filled.collection, shape, np.array([1, 1, 1, 1], np.uint16), RevisionKind.HUMAN, "ann"
    )
    lease = filled.workspace.catalog.claim_shape(shape.id, base.author_id, 60)
    draft = begin_draft(filled.workspace, lease, lease.person_id, base.id)
    assert draft_work(filled.workspace, draft).base_labels.tolist() == [1, 1, 1, 1]
    confirmation = _confirmed(filled, draft, [2, 1, 1, 1])
    assert confirmation.revision_id is not None
    assert filled.workspace.catalog.revision(confirmation.revision_id).parent_id == base.id


def test_labels_that_the_person_did_not_see_are_not_confirmed(filled) -> None:
    draft = _paint(filled, _begun(filled.described(), "ann"), [1, 1, 2])
    with pytest.raises(ConflictError, match="saw"):
        confirm(filled.workspace, draft.id, draft.person_id, 3, "0" * 64)
    with pytest.raises(StaleDraftError, match="has 3, not 2"):
        confirm(filled.workspace, draft.id, draft.person_id, 2)
    assert filled.workspace.catalog.revisions(draft.shape_id) == []


def test_a_stroke_that_comes_while_the_log_is_replayed_is_not_confirmed_unseen(filled) -> None:
    draft = _paint(filled, _begun(filled.described(), "ann"), [1, 1])
    work = work_to_confirm(filled.workspace, draft)
    at = datetime(2026, 1, 31, 12, tzinfo=UTC)
    late = Stroke(uuid.uuid4(), 2, None, draft.person_id, at, Assign(((2, 1),), 2))
    filled.workspace.catalog.append_strokes(draft.id, draft.person_id, 2, [late])
    with pytest.raises(StaleDraftError, match="had 2, not 3") as refused:
        confirm_labels(filled.workspace, work, work.replayed(), draft.person_id, 3)
    assert (refused.value.state["draft_id"], refused.value.state["n_strokes"]) == (draft.id, 2)
    assert filled.workspace.catalog.revisions(draft.shape_id) == []


def test_confirming_again_is_confirming_once(filled) -> None:
    draft = _begun(filled.described(), "ann")
    first = _confirmed(filled, draft, [1, 1, 2, 2])
    assert confirm(filled.workspace, draft.id, draft.person_id, 4) == first


def test_a_discarded_draft_is_not_confirmed(filled) -> None:
    draft = _begun(filled.described(), "ann")
    filled.workspace.catalog.discard_draft(draft.id, draft.person_id)
    with pytest.raises(ConflictError, match="discarded"):
        confirm(filled.workspace, draft.id, draft.person_id, 0)


@pytest.mark.parametrize(("theirs", "is_agreed"), [([1, 1, 2, 2], True), ([2, 2, 1, 1], False)])
def test_independent_labels_are_compared(filled, theirs: list[int], is_agreed: bool) -> None:
    catalog = filled.workspace.catalog
    catalog.update_collection_settings(filled.collection.id, {"labels_per_shape": 2})
    first, second = (_begun(filled.described() if name == "ann" else filled, name) for name in ("ann", "bob"))
    assert first.shape_id == second.shape_id
    assert _confirmed(filled, first, [1, 1, 2, 2]).revision_id is None
    confirmation = _confirmed(filled, second, theirs)
    assert confirmation.revision_id is not None
    assert catalog.consensus_of(first.shape_id)[0].is_agreed == is_agreed
    reasons = [review.reason for review in catalog.open_reviews(filled.collection.id)]
    assert reasons == ([] if is_agreed else [ReviewReason.DISAGREEMENT])


def test_blind_labels_are_measured(filled) -> None:
    catalog = filled.workspace.catalog
    catalog.update_collection_settings(filled.collection.id, {"honeypot_share": 1.0})
    shape = filled.described().shape("a.off")
    truth = np.array([1, 1, 2, 2], np.uint16)
    commit_labels(filled.workspace, filled.collection, shape, truth, RevisionKind.REFERENCE, "truth")
    draft = _begun(filled, "ann", draw=0.5)
    assert draft.shape_id == shape.id
    assert _confirmed(filled, draft, [1, 1, 2, 2]).revision_id is None
    (check,) = catalog.blind_checks(filled.collection.id)
    assert (check.closeness.area_agreement, check.closeness.part_iou, check.closeness.boundary_distance) == (1, 1, 0)
    assert catalog.head_revision(shape.id) is None
