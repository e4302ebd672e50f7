"""How right people are: against references, which nobody who is checked learns of, and against each other."""

from datetime import UTC, datetime
from uuid import uuid4

import numpy as np
import pytest
from safetensors.numpy import load

from partwise.labels.operations import Assign
from partwise.labels.strokes import Stroke
from partwise.store.records import NewClaim, NewRevision, RevisionKind, Role
from partwise.testing.workspaces import publish_picture
from partwise.workspace.confirming import begin_draft, confirm


@pytest.fixture
def collection(mugs) -> str:
    return f"/collections/{mugs.collection_id}"


@pytest.fixture
def handed_in(workspace, mugs):
    """Somebody gets a shape by this draw and hands in one part everywhere; its id: `handed_in("ann", 1, 0.9)`."""

    def done(name: str, part: int, draw: float) -> int:
        catalog = workspace.catalog
        person_id = next(each.id for each in catalog.list_people() if each.name == name)
        lease = catalog.claim_next(NewClaim(mugs.collection_id, person_id, 60, draw))
        draft = begin_draft(workspace, lease, lease.person_id)
        stroke = _everywhere(draft, catalog.mesh(draft.shape_id, draft.mesh_hash).n_faces, part)
        catalog.append_strokes(draft.id, person_id, 0, [stroke])
        confirm(workspace, draft.id, person_id, 1)
        return lease.shape_id

    return done


def _everywhere(draft, n_faces: int, part: int):
    at = datetime(2026, 1, 31, tzinfo=UTC)
    return Stroke(uuid4(), 0, draft.base_revision, draft.person_id, at, Assign(((0, n_faces),), part))


@pytest.fixture
def checked(annotator, workspace, mugs, handed_in) -> int:
    """ann, unknowing, labels a.off rightly; its id."""
    _know(workspace.catalog, mugs)
    shape_id = handed_in("ann", 1, 0.1)
    assert shape_id == mugs.ids["a.off"]
    return shape_id


def _know(catalog, mugs) -> None:
    """Puts on record what is true of a.off, with which half of the claims are checked."""
    mesh, truth = mugs.meshes["a.off"], catalog.add_person("truth").id
    labels = np.ones(mesh.n_faces, dtype=np.uint16)
    catalog.add_revision(NewRevision(mugs.ids["a.off"], mesh.content_hash(), RevisionKind.REFERENCE, truth, 1, labels))
    catalog.update_collection_settings(mugs.collection_id, {"honeypot_share": 0.5})


def test_blind_checks_are_listed(operator, collection, checked) -> None:
    (check,) = operator.get(f"{collection}/blind-checks").json()["items"]
    assert (check["person_name"], check["shape_id"]) == ("ann", checked)
    assert (check["area_agreement"], check["part_iou"], check["boundary_distance"]) == (1, 1, 0)


def test_reviewers_are_not_told_which_shapes_check(reviewer, collection, checked) -> None:
    (check,) = reviewer.get(f"{collection}/blind-checks").json()["items"]
    assert (check["person_name"], check["shape_id"]) == ("ann", None)


def test_nobody_sees_their_own_checks(issue, mugs, collection, checked) -> None:
    ann = issue("ann", Role.REVIEWER, (mugs.collection_id,))
    assert ann.get(f"{collection}/blind-checks").json()["items"] == []
    assert ann.get(f"{collection}/blind-checks/people").json()["items"] == []


def test_checks_of_one_person(operator, workspace, collection, checked) -> None:
    ann, truth = (workspace.catalog.get_person(name).id for name in ("ann", "truth"))
    found = [
        operator.get(f"{collection}/blind-checks", params={"person": each}).json()["items"] for each in (ann, truth)
    ]
    assert [len(each) for each in found] == [1, 0]


def test_people_are_measured_over_time(reviewer, collection, checked) -> None:
    (person,) = reviewer.get(f"{collection}/blind-checks/people").json()["items"]
    assert (person["person_name"], person["n_checks"], person["area_agreement"]) == ("ann", 1, 1)
    assert [(day["n_checks"], day["part_iou"]) for day in person["days"]] == [(1, 1)]


def test_blind_labels_are_nobodys_to_see(admin, workspace, checked) -> None:
    (answer,) = workspace.catalog.answers(checked)
    assert admin.get(f"/shapes/{checked}/answers/{answer.id}/labels").status_code == 404


@pytest.mark.parametrize("path", ["blind-checks", "blind-checks/people", "disagreements"])
def test_annotators_see_no_checks(annotator, collection, path) -> None:
    assert annotator.get(f"{collection}/{path}").status_code == 403


@pytest.fixture
def disputed(annotator, issue, workspace, mugs, handed_in) -> int:
    """ann and ben see different parts in a.off; its id."""
    issue("ben", Role.ANNOTATOR)
    workspace.catalog.update_collection_settings(mugs.collection_id, {"labels_per_shape": 2})
    workspace.catalog.fill_queue(mugs.collection_id)
    assert {handed_in("ann", 1, 0.9), handed_in("ben", 2, 0.9)} == {mugs.ids["a.off"]}
    return mugs.ids["a.off"]


def test_disagreements_are_listed_with_what_everyone_said(reviewer, collection, disputed) -> None:
    (found,) = reviewer.get(f"{collection}/disagreements").json()["items"]
    assert (found["shape_id"], found["source_key"], found["area_agreement"]) == (disputed, "a.off", 0)
    assert [each["person_name"] for each in found["answers"]] == ["ann", "ben"]
    assert [each["is_medoid"] for each in found["answers"]].count(True) == 1
    assert all(each["effort"].keys() == {"active_s", "n_clicks"} for each in found["answers"])
    labels = [
        set(load(reviewer.get(f"/shapes/{disputed}/answers/{each['id']}/labels").content)["labels"].tolist())
        for each in found["answers"]
    ]
    assert labels == [{1}, {2}]


def test_everybodys_labels_have_a_picture(reviewer, annotator, collection, disputed, workspace, mugs) -> None:
    publish_picture(workspace, disputed, mugs.meshes["a.off"])
    (found,) = reviewer.get(f"{collection}/disagreements").json()["items"]
    paths = [f"/shapes/{disputed}/answers/{each['id']}/thumbnail" for each in found["answers"]]
    pictures = [reviewer.get(path) for path in paths]
    assert [each.headers["content-type"] for each in pictures] == ["image/png"] * 2
    assert pictures[0].content != pictures[1].content
    assert annotator.get(paths[0]).status_code == 403


def test_labels_of_answers_are_revalidated(reviewer, collection, disputed) -> None:
    (found,) = reviewer.get(f"{collection}/disagreements").json()["items"]
    path = f"/shapes/{disputed}/answers/{found['answers'][0]['id']}/labels"
    tag = reviewer.get(path).headers["etag"]
    assert reviewer.get(path, headers={"If-None-Match": tag}).status_code == 304


@pytest.mark.parametrize("place", [0, 1])
def test_a_reviewer_chooses(reviewer, workspace, collection, disputed, place) -> None:
    (found,) = reviewer.get(f"{collection}/disagreements").json()["items"]
    path = f"/shapes/{disputed}/reviews/{found['review_id']}/choose"
    chosen = reviewer.post(path, json={"answer_id": found["answers"][place]["id"]}).json()
    assert set(workspace.catalog.labels(chosen["id"]).tolist()) == {place + 1}
    assert chosen["author_id"] == found["answers"][place]["person_id"]
    assert reviewer.get(f"{collection}/disagreements").json()["items"] == []
    assert reviewer.post(path, json={"answer_id": found["answers"][place]["id"]}).status_code == 409


def test_a_reviewer_chooses_among_what_the_review_compares(reviewer, workspace, collection, mugs, disputed) -> None:
    (found,) = reviewer.get(f"{collection}/disagreements").json()["items"]
    path = f"/shapes/{disputed}/reviews/{found['review_id']}/choose"
    assert reviewer.post(path, json={"answer_id": 99}).status_code == 404
    foreign = path.replace(f"/shapes/{disputed}/", f"/shapes/{mugs.ids['b.off']}/")
    assert reviewer.post(foreign, json={"answer_id": found["answers"][0]["id"]}).status_code == 404
    assert [entry.action for entry in workspace.catalog.latest_audit(limit=1)] != ["choose labels"]


def test_a_reviewer_keeps_the_medoid_or_has_it_done_again(reviewer, collection, disputed) -> None:
    (found,) = reviewer.get(f"{collection}/disagreements").json()["items"]
    path = f"/shapes/{disputed}/reviews/{found['review_id']}"
    assert reviewer.post(f"{path}/reject", json={"note": "both are wrong"}).status_code == 200
    assert reviewer.get(f"{collection}/disagreements").json()["items"] == []


def test_answers_before_the_last_are_nobodys_to_see(reviewer, annotator, workspace, mugs, handed_in) -> None:
    workspace.catalog.update_collection_settings(mugs.collection_id, {"labels_per_shape": 2})
    workspace.catalog.fill_queue(mugs.collection_id)
    shape_id = handed_in("ann", 1, 0.9)
    (answer,) = workspace.catalog.answers(shape_id)
    assert reviewer.get(f"/shapes/{shape_id}/answers/{answer.id}/labels").status_code == 404


def test_reviews_of_one_reason(reviewer, collection, disputed) -> None:
    found = {
        reason: len(reviewer.get(f"{collection}/reviews", params={"reason": reason}).json()["items"])
        for reason in ("disagreement", "rework")
    }
    assert found == {"disagreement": 1, "rework": 0}


def test_the_table_and_the_lease_tell_its_holder_the_same_score(
    annotator, reviewer, workspace, mugs, collection
) -> None:
    _know(workspace.catalog, mugs)
    workspace.catalog.update_collection_settings(mugs.collection_id, {"honeypot_share": 1.0})
    known = mugs.ids["a.off"]
    workspace.catalog.set_ranks(mugs.collection_id, {known: 3, mugs.ids["b.off"]: 2, mugs.ids["sub/c.off"]: 1})
    (lease,) = annotator.post("/queue/claim", json={"collection_id": mugs.collection_id}).json()["items"]
    assert (lease["shape_id"], lease["score_name"]) == (known, "entropy")

    def scores(caller, name: str = "entropy") -> set[float | None]:
        """Of the shape, wherever the table tells it."""
        order = {"order": name}
        pages = [caller.get(f"{collection}/shapes{path}", params=order) for path in ("", "/ranked")]
        pages.append(caller.get(f"{collection}/shapes/rows", params={"id": known, **order}))
        return {row["score"] for page in pages for row in page.json()["items"] if row["id"] == known}

    assert scores(annotator) == {lease["score"]}
    assert scores(reviewer) == {workspace.catalog.scores([known], "entropy")[known].value}
    assert scores(reviewer) != scores(annotator)
    assert scores(annotator, "entropy_by_area") == {None}
    assert scores(reviewer, "entropy_by_area") != {None}
