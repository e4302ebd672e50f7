"""Labels that wait for a second look."""

import numpy as np
import pytest

from partwise.store.records import NewRevision, RevisionKind, Role, ShapeState
from partwise.store.reviews import NewReview, ReviewReason


@pytest.fixture
def waiting(workspace, mugs) -> str:
    """A review of a.off; its path."""
    catalog, shape_id = workspace.catalog, mugs.ids["a.off"]
    author = catalog.add_person("eve")
    mesh_hash = mugs.meshes["a.off"].content_hash()
    revision = NewRevision(shape_id, mesh_hash, RevisionKind.HUMAN, author.id, 1, np.ones(4, dtype=np.uint16))
    catalog.add_revision(revision, NewReview(ReviewReason.CHECK))
    return f"/shapes/{shape_id}/reviews/{catalog.reviews(shape_id)[0].id}"


def test_what_waits_is_listed(reviewer, mugs, waiting) -> None:
    listed = reviewer.get(f"/collections/{mugs.collection_id}/reviews").json()
    assert [(each["shape_id"], each["reason"]) for each in listed["items"]] == [(mugs.ids["a.off"], "check")]


def test_what_waits_says_what_it_took_where_that_is_known(reviewer, mugs, waiting) -> None:
    path = f"/collections/{mugs.collection_id}/reviews"
    assert [each["effort"] for each in reviewer.get(path).json()["items"]] == [None]


def test_what_waits_is_counted_and_paged_by_reason(reviewer, mugs, waiting) -> None:
    path = f"/collections/{mugs.collection_id}/reviews"
    for reasons, n in ({"reason": ["check", "schema"]}, 1), ({"reason": ["rework", "schema"]}, 0), ({}, 1):
        assert reviewer.get(f"{path}/count", params=reasons).json() == {"n_reviews": n}
        assert len(reviewer.get(path, params=reasons).json()["items"]) == n
    assert reviewer.get(path, params={"reason": "boredom"}).status_code == 422


def test_accepting_resolves_a_review(reviewer, mugs, waiting) -> None:
    accepted = reviewer.post(f"{waiting}/accept").json()
    assert accepted["outcome"] == "accepted"
    assert reviewer.get(f"/collections/{mugs.collection_id}/reviews").json()["items"] == []
    assert reviewer.get(waiting.rpartition("/")[0]).json()["items"] == [accepted]


def test_a_review_is_resolved_once(reviewer, waiting) -> None:
    assert [reviewer.post(f"{waiting}/accept").status_code for _ in range(2)] == [200, 409]


def test_rejecting_sends_labels_back(reviewer, mugs, waiting) -> None:
    rejected = reviewer.post(f"{waiting}/reject", json={"note": "the handle is missing"})
    assert rejected.status_code == 200, rejected.text
    assert reviewer.get(waiting.rpartition("/")[0]).json()["items"][0]["outcome"] == "rejected"


def test_rejecting_takes_a_note(reviewer, waiting) -> None:
    assert reviewer.post(f"{waiting}/reject", json={}).status_code == 422


def test_a_review_of_another_shape_is_not_found(reviewer, mugs, waiting) -> None:
    path = waiting.replace(f"/shapes/{mugs.ids['a.off']}/", f"/shapes/{mugs.ids['b.off']}/")
    assert reviewer.post(f"{path}/accept").status_code == 404


def test_a_foreign_review_is_not_found(issue, mugs, waiting) -> None:
    stranger = issue("sam", Role.REVIEWER, (mugs.other_id,))
    assert stranger.post(f"{waiting}/accept").status_code == 404


def test_annotators_review_nothing(annotator, mugs, waiting) -> None:
    for path in ("reviews", "reviews/count"):
        assert annotator.get(f"/collections/{mugs.collection_id}/{path}").status_code == 403
    assert annotator.post(f"{waiting}/accept").status_code == 403
    assert annotator.post(f"{waiting}/reject", json={"note": "no"}).status_code == 403


def test_what_waits_for_one_reason_is_accepted_at_once(reviewer, workspace, mugs, waiting) -> None:
    collection = f"/collections/{mugs.collection_id}"
    workspace.catalog.add_part(mugs.collection_id, "lid")
    accepted = reviewer.post(f"{collection}/reviews/accept", json={"reason": "schema"})
    assert accepted.json() == {"n_accepted": 1}
    assert [each["reason"] for each in reviewer.get(f"{collection}/reviews").json()["items"]] == ["check"]
    assert reviewer.post(f"{collection}/reviews/accept", json={"reason": "rework"}).status_code == 422


def test_annotators_accept_nothing_at_once(annotator, mugs, waiting) -> None:
    path = f"/collections/{mugs.collection_id}/reviews/accept"
    assert annotator.post(path, json={"reason": "check"}).status_code == 403


@pytest.fixture
def confirmed(reviewer, waiting) -> int:
    """Labels of a.off that nobody has to look at; its id."""
    return reviewer.post(f"{waiting}/accept").json()["shape_id"]


def test_a_blank_note_sends_nothing_back(reviewer, workspace, mugs, confirmed) -> None:
    assert reviewer.post(f"/shapes/{confirmed}/reject", json={"note": "  "}).status_code == 422
    many = {"shape_ids": [mugs.ids["b.off"], confirmed], "note": " "}
    assert reviewer.post(f"/collections/{mugs.collection_id}/reject", json=many).status_code == 422
    assert workspace.catalog.shape_states([confirmed]) == {confirmed: ShapeState.CONFIRMED}


def test_what_somebody_works_on_is_not_sent_back_and_stays_confirmed(reviewer, workspace, confirmed) -> None:
    workspace.catalog.claim_shape(confirmed, workspace.catalog.get_person("eve").id, 60)
    assert reviewer.post(f"/shapes/{confirmed}/reject", json={"note": "no"}).status_code == 409
    assert workspace.catalog.shape_states([confirmed]) == {confirmed: ShapeState.CONFIRMED}
