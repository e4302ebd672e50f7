"""Labels that wait for a second look."""

import numpy as np
import pytest

from partwise.store.records import NewRevision, RevisionKind, Role
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
