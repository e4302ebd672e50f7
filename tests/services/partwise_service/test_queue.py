"""Claims, what is held, and how that ends."""

import numpy as np
import pytest

from partwise.store.records import NewRevision, RevisionKind, Role


@pytest.fixture
def claim(mugs):
    """Claims in a caller's name: `claim(annotator)`."""

    def claimed(caller, *shape_ids: int, is_prefetch: bool = False):
        body = {"collection_id": mugs.collection_id, "shape_ids": list(shape_ids), "is_prefetch": is_prefetch}
        return caller.post("/queue/claim", json=body)

    return claimed


@pytest.fixture
def ben(issue, mugs):
    return issue("ben", Role.ANNOTATOR, (mugs.collection_id,))


def _labels(workspace, mugs, key: str, author: str = "eve") -> int:
    mesh = mugs.meshes[key]
    known = {person.name: person for person in workspace.catalog.list_people()}
    person = known.get(author) or workspace.catalog.add_person(author)
    new = NewRevision(mugs.ids[key], mesh.content_hash(), RevisionKind.HUMAN, person.id, 1, np.full(mesh.n_faces, 1))
    return workspace.catalog.add_revision(new).id


def test_a_claim_says_what_was_claimed_and_how_unsure_which_model_is(annotator, claim) -> None:
    lease = claim(annotator).json()["items"][0]
    assert lease["outcome"] is None
    assert lease["score"] > 0
    assert (lease["model_version"], lease["draft_id"]) == (1, None)


def test_a_claim_never_says_what_it_is_for(annotator, claim) -> None:
    assert not {"purpose", "slot", "round"} & claim(annotator).json()["items"][0].keys()


def test_two_people_get_different_shapes(annotator, ben, claim) -> None:
    held = [claim(caller).json()["items"][0]["shape_id"] for caller in (annotator, ben)]
    assert len(set(held)) == 2


def test_nothing_left_is_no_error(annotator, ben, claim) -> None:
    for _ in range(3):
        claim(ben)
    assert claim(annotator).json() == {"items": [], "refused": []}


def test_after_a_reload_the_same_shapes_are_held(annotator, claim) -> None:
    first = claim(annotator).json()["items"]
    second = claim(annotator).json()["items"]
    assert annotator.get("/leases").json()["items"] == first + second


def test_claims_by_name(annotator, claim, mugs) -> None:
    wanted = [mugs.ids["b.off"], mugs.ids["a.off"]]
    assert [lease["shape_id"] for lease in claim(annotator, *wanted).json()["items"]] == wanted


def test_a_shape_that_another_has_is_named_as_refused(annotator, ben, claim, mugs) -> None:
    claim(ben, mugs.ids["a.off"])
    answer = claim(annotator, mugs.ids["a.off"], mugs.ids["b.off"]).json()
    assert [lease["shape_id"] for lease in answer["items"]] == [mugs.ids["b.off"]]
    assert [each["shape_id"] for each in answer["refused"]] == [mugs.ids["a.off"]]


def test_it_is_a_conflict_if_none_can_be_had(annotator, ben, claim, mugs) -> None:
    claim(ben, mugs.ids["a.off"])
    answer = claim(annotator, mugs.ids["a.off"])
    assert answer.status_code == 409
    assert answer.json()["detail"].startswith("a.off is with someone else now;")


def test_shapes_of_another_collection_cannot_be_named(operator, claim, mugs) -> None:
    assert claim(operator, mugs.other_shape_id).status_code == 404


def test_a_collection_outside_the_scope_does_not_exist(annotator, mugs) -> None:
    body = {"collection_id": mugs.other_id}
    assert annotator.post("/queue/claim", json=body).status_code == 404


def test_a_prefetched_shape_is_claimed_next(annotator, claim) -> None:
    ahead = claim(annotator, is_prefetch=True).json()["items"][0]
    assert ahead["is_prefetched"]
    assert claim(annotator).json()["items"][0]["id"] == ahead["id"]


def test_a_heartbeat_holds_for_longer(annotator, claim) -> None:
    lease = claim(annotator).json()["items"][0]
    renewed = annotator.post(f"/leases/{lease['id']}/heartbeat", json={}).json()
    assert renewed["expires_at"] > lease["expires_at"]


def test_who_begins_on_a_prefetched_shape_says_so(annotator, claim) -> None:
    ahead = claim(annotator, is_prefetch=True).json()["items"][0]
    renewed = annotator.post(f"/leases/{ahead['id']}/heartbeat", json={"is_prefetched": False}).json()
    assert not renewed["is_prefetched"]


def test_a_released_shape_is_free_again(annotator, ben, claim, mugs) -> None:
    lease = claim(annotator, mugs.ids["a.off"]).json()["items"][0]
    assert annotator.post(f"/leases/{lease['id']}/release").json()["outcome"] == "released"
    assert claim(ben, mugs.ids["a.off"]).status_code == 200


def test_a_released_lease_cannot_be_renewed(annotator, claim) -> None:
    lease = claim(annotator).json()["items"][0]
    annotator.post(f"/leases/{lease['id']}/release")
    assert annotator.post(f"/leases/{lease['id']}/heartbeat", json={}).status_code == 409


def test_a_skipped_shape_is_not_offered_to_them_again(annotator, claim) -> None:
    lease = claim(annotator).json()["items"][0]
    skipped = annotator.post(f"/leases/{lease['id']}/skip", json={"reason": "torn"}).json()
    assert (skipped["outcome"], skipped["reason"]) == ("skipped", "torn")
    others = {claim(annotator).json()["items"][0]["shape_id"] for _ in range(2)}
    assert lease["shape_id"] not in others


def test_a_skip_needs_a_reason(annotator, claim) -> None:
    lease = claim(annotator).json()["items"][0]
    assert annotator.post(f"/leases/{lease['id']}/skip", json={"reason": ""}).status_code == 422


@pytest.mark.parametrize("what", ["heartbeat", "release", "skip", "complete", "draft"])
def test_another_persons_lease_does_not_exist(annotator, ben, claim, what) -> None:
    lease = claim(ben).json()["items"][0]
    bodies = {"skip": {"reason": "x"}, "complete": {"n_strokes": 0}}
    assert annotator.post(f"/leases/{lease['id']}/{what}", json=bodies.get(what, {})).status_code == 404


def test_an_operator_takes_a_shape_from_whoever_holds_it(annotator, operator, claim) -> None:
    lease = claim(annotator).json()["items"][0]
    assert operator.post(f"/leases/{lease['id']}/clear").json()["outcome"] == "cleared"
    assert annotator.get("/leases").json()["items"] == []


def test_whose_shape_was_taken_away_is_told_so_by_the_next_heartbeat(annotator, operator, claim) -> None:
    lease = claim(annotator).json()["items"][0]
    operator.post(f"/leases/{lease['id']}/clear")
    refused = annotator.post(f"/leases/{lease['id']}/heartbeat", json={})
    assert (refused.status_code, refused.json()["outcome"]) == (409, "cleared")


def test_annotators_clear_nothing(annotator, claim) -> None:
    lease = claim(annotator).json()["items"][0]
    assert annotator.post(f"/leases/{lease['id']}/clear").status_code == 403


def test_operators_see_who_holds_what(annotator, operator, claim, mugs) -> None:
    lease = claim(annotator).json()["items"][0]
    page = operator.get(f"/collections/{mugs.collection_id}/leases", params={"limit": 1}).json()
    assert ([each["id"] for each in page["items"]], page["next"]) == ([lease["id"]], str(lease["id"]))


def test_the_depth_of_the_queue_is_kept_for_some_seconds(annotator, claim, mugs, clock) -> None:
    def depth() -> tuple[int, int, int]:
        shown = annotator.get(f"/collections/{mugs.collection_id}/queue").json()
        return shown["n_free"], shown["n_held"], shown["n_assigned"]

    assert depth() == (3, 0, 0)
    claim(annotator)
    assert depth() == (3, 0, 0)
    clock.now_s += 60
    assert depth() == (2, 1, 0)


def test_an_assigned_shape_comes_first_for_its_person(annotator, operator, workspace, claim, mugs) -> None:
    person_id = workspace.catalog.get_person("ann").id
    body = {"shape_ids": [mugs.ids["sub/c.off"]], "person_id": person_id}
    assert operator.post(f"/collections/{mugs.collection_id}/queue/assign", json=body).json() == {"n_places": 1}
    assert claim(annotator).json()["items"][0]["shape_id"] == mugs.ids["sub/c.off"]


def test_only_shapes_of_the_collection_are_assigned(operator, mugs) -> None:
    body = {"shape_ids": [mugs.other_shape_id], "person_id": None}
    assert operator.post(f"/collections/{mugs.collection_id}/queue/assign", json=body).status_code == 404


def test_a_labelled_shape_can_be_put_into_the_queue_again(operator, workspace, claim, mugs) -> None:
    for key in mugs.ids:
        _labels(workspace, mugs, key)
    assert claim(operator).json()["items"] == []
    assert operator.post(f"/shapes/{mugs.ids['b.off']}/reopen", json={}).status_code == 204
    assert claim(operator).json()["items"][0]["shape_id"] == mugs.ids["b.off"]


def test_rejected_labels_go_back_to_their_author(annotator, reviewer, operator, workspace, claim, mugs) -> None:
    _labels(workspace, mugs, "a.off", author="ann")
    body = {"note": "the handle is missing", "for_author": True}
    review = reviewer.post(f"/shapes/{mugs.ids['a.off']}/reject", json=body).json()
    assert review["reason"] == "rework"
    assert claim(annotator).json()["items"][0]["shape_id"] == mugs.ids["a.off"]


def test_what_waits_for_rework_is_not_rejected_twice(reviewer, workspace, mugs) -> None:
    _labels(workspace, mugs, "a.off")
    path = f"/shapes/{mugs.ids['a.off']}/reject"
    assert reviewer.post(path, json={"note": "no"}).status_code == 200
    assert reviewer.post(path, json={"note": "no"}).status_code == 409


def test_there_must_be_labels_to_reject(reviewer, mugs) -> None:
    assert reviewer.post(f"/shapes/{mugs.ids['a.off']}/reject", json={"note": "no"}).status_code == 404


def test_annotators_reject_nothing(annotator, mugs) -> None:
    assert annotator.post(f"/shapes/{mugs.ids['a.off']}/reject", json={"note": "no"}).status_code == 403


def test_an_expired_lease_is_free_for_others(annotator, ben, workspace, claim, mugs) -> None:
    workspace.catalog.claim_shape(mugs.ids["a.off"], workspace.catalog.get_person("ann").id, 1e-6)
    assert claim(ben, mugs.ids["a.off"]).status_code == 200
    assert annotator.get("/leases").json()["items"] == []
