"""Labels accepted in bulk and checked unknowing, shapes put first, labels sent back many at a time."""

from uuid import uuid4

import numpy as np
import pytest
from safetensors.numpy import save

from partwise.store.records import NewRevision, RevisionKind

N_SHAPES = 3


@pytest.fixture
def collection(mugs) -> str:
    return f"/collections/{mugs.collection_id}"


@pytest.fixture
def accept(reviewer, mugs, collection):
    """Accepts in the reviewer's name: `accept("a.off", recheck=1)`."""

    def accepted(*keys: str, recheck: int = 0, segmentation: str = "predicted"):
        body = {"shape_ids": [mugs.ids[key] for key in keys], "segmentation": segmentation, "recheck": recheck}
        return reviewer.post(f"{collection}/accept", json=body)

    return accepted


@pytest.fixture
def label_next(mugs):
    """Somebody claims the next shape and labels all of it: `label_next(annotator, part)`; the lease."""

    n_faces = {mugs.ids[key]: mesh.n_faces for key, mesh in mugs.meshes.items()}

    def labelled(caller, part: int):
        lease = caller.post("/queue/claim", json={"collection_id": mugs.collection_id}).json()["items"][0]
        draft = caller.post(f"/leases/{lease['id']}/draft", json={"base_revision": None}).json()
        stroke = {
            "v": 1, "kind": "assign", "runs": [[0, n_faces[draft["shape_id"]]]], "label": part,
            "id": str(uuid4()), "sequence": 0, "base_revision": None,
            "author_id": lease["person_id"], "at": "2026-11-22T12:00:00Z",
        }  # fmt: skip
        sent = caller.post(f"/drafts/{draft['id']}/strokes", json={"expected_sequence": 0, "strokes": [stroke]})
        assert sent.status_code == 200, sent.text
        confirmed = caller.post(f"/leases/{lease['id']}/complete", json={"n_strokes": 1})
        assert confirmed.status_code == 200, confirmed.text
        return lease

    return labelled


def _human(workspace, mugs, key: str) -> None:
    catalog, mesh = workspace.catalog, mugs.meshes[key]
    known = {person.name: person for person in catalog.list_people()}
    author = known.get("eve") or catalog.add_person("eve")
    labels = np.ones(mesh.n_faces, dtype=np.uint16)
    catalog.add_revision(NewRevision(mugs.ids[key], mesh.content_hash(), RevisionKind.HUMAN, author.id, 1, labels))


@pytest.mark.parametrize(("segmentation", "part"), [("predicted", 1), ("refined", 2)])
def test_accepted_labels_are_the_shapes(reviewer, workspace, mugs, accept, segmentation, part) -> None:
    answer = accept("a.off", "b.off", segmentation=segmentation).json()
    assert (answer["accepted"], answer["refused"], answer["rechecks"]) == (
        [mugs.ids["a.off"], mugs.ids["b.off"]],
        [],
        0,
    )
    head = workspace.catalog.head_revision(mugs.ids["a.off"])
    assert set(workspace.catalog.labels(head.id).tolist()) == {part}
    assert head.author_id == workspace.catalog.get_person("rita").id


def test_what_cannot_be_accepted_says_why(workspace, annotator, mugs, accept) -> None:
    _human(workspace, mugs, "a.off")
    annotator.post("/queue/claim", json={"collection_id": mugs.collection_id, "shape_ids": [mugs.ids["b.off"]]})
    answer = accept("a.off", "b.off", "sub/c.off").json()
    assert answer["accepted"] == [mugs.ids["sub/c.off"]]
    why = {each["shape_id"]: each["why"] for each in answer["refused"]}
    assert "is confirmed" in why[mugs.ids["a.off"]]
    assert "somebody works" in why[mugs.ids["b.off"]]


def test_shapes_without_such_labels_are_refused(operator, mugs) -> None:
    body = {"shape_ids": [mugs.other_shape_id], "segmentation": "predicted"}
    answer = operator.post(f"/collections/{mugs.other_id}/accept", json=body).json()
    assert "no predicted labels" in answer["refused"][0]["why"]


def test_some_are_drawn_to_be_checked(workspace, mugs, accept) -> None:
    answer = accept(*mugs.ids, recheck=2).json()
    assert (len(answer["accepted"]), answer["refused"], answer["rechecks"]) == (1, [], 2)
    assert workspace.catalog.queue_depth(mugs.collection_id).n_free == 2


def test_a_drawn_shape_is_not_accepted_again(accept) -> None:
    accept("a.off", recheck=1)
    assert "waits to be checked" in accept("a.off").json()["refused"][0]["why"]


def test_who_gets_a_drawn_shape_is_told_what_others_are(annotator, mugs, accept) -> None:
    accept("a.off", recheck=1)
    leases = [
        annotator.post("/queue/claim", json={"collection_id": mugs.collection_id}).json()["items"][0] for _ in range(3)
    ]
    assert leases[0]["shape_id"] == mugs.ids["a.off"]
    assert {(lease["rank"], lease["state"], lease["score_name"]) for lease in leases} == {(1, "ready", "entropy")}
    scores = [lease["score"] for lease in leases]
    assert min(scores[1:]) < scores[0] < max(scores[1:])


@pytest.mark.parametrize(("part", "n_false", "rate"), [(1, 0, 0.0), (2, 1, 1.0)])
def test_the_false_accept_rate_is_what_people_find(
    annotator, reviewer, collection, accept, label_next, part, n_false, rate
) -> None:
    accept("a.off", "b.off", recheck=1)
    before = reviewer.get(f"{collection}/accepts").json()["items"][0]
    assert (before["n_accepted"], before["n_rechecks"], before["n_rechecked"]) == (1, 1, 0)
    assert (before["false_accept_rate"], before["interval"]) == (None, None)
    label_next(annotator, part)
    batch = reviewer.get(f"{collection}/accepts").json()["items"][0]
    assert (batch["n_rechecked"], batch["n_false"], batch["false_accept_rate"]) == (1, n_false, rate)
    assert batch["interval"][0] <= rate <= batch["interval"][1]
    assert (batch["person_name"], batch["agreement"]) == ("rita", 0.9)


def test_batches_come_newest_first_in_pages(reviewer, collection, accept) -> None:
    ids = [accept(key).json()["batch_id"] for key in ("a.off", "b.off")]
    first = reviewer.get(f"{collection}/accepts", params={"limit": 1}).json()
    second = reviewer.get(f"{collection}/accepts", params={"limit": 1, "before": first["next"]}).json()
    assert [page["items"][0]["id"] for page in (first, second)] == ids[::-1]


def test_selected_shapes_come_first(annotator, reviewer, mugs, collection) -> None:
    body = {"shape_ids": [mugs.ids["sub/c.off"]]}
    assert reviewer.post(f"{collection}/queue/select", json=body).json() == {"shape_ids": [mugs.ids["sub/c.off"]]}
    lease = annotator.post("/queue/claim", json={"collection_id": mugs.collection_id}).json()["items"][0]
    assert lease["shape_id"] == mugs.ids["sub/c.off"]


def test_a_new_ranking_leaves_selected_shapes_first(reviewer, workspace, mugs, collection, annotator) -> None:
    reviewer.post(f"{collection}/queue/select", json={"shape_ids": [mugs.ids["sub/c.off"]]})
    workspace.catalog.set_ranks(mugs.collection_id, {mugs.ids["sub/c.off"]: 9, mugs.ids["a.off"]: 1})
    lease = annotator.post("/queue/claim", json={"collection_id": mugs.collection_id}).json()["items"][0]
    assert lease["shape_id"] == mugs.ids["sub/c.off"]


def test_what_does_not_wait_is_not_selected(reviewer, workspace, mugs, collection) -> None:
    _human(workspace, mugs, "a.off")
    body = {"shape_ids": [mugs.ids["a.off"], mugs.ids["b.off"]]}
    assert reviewer.post(f"{collection}/queue/select", json=body).json() == {"shape_ids": [mugs.ids["b.off"]]}


def test_so_many_are_selected_far_apart_on_the_map(reviewer, workspace, mugs, collection) -> None:
    ids = np.array([mugs.ids[key] for key in ("a.off", "b.off", "sub/c.off")], dtype=np.int64)
    points = np.array([[0.0, 0.0], [0.1, 0.0], [9.0, 0.0]], dtype=np.float32)
    key = f"embeddings/{mugs.collection_id}/{'ef' * 32}.safetensors"
    workspace.arrays.put_bytes(key, save({"points": points, "shape_ids": ids}))
    workspace.catalog.set_embedding(mugs.collection_id, key)
    chosen = reviewer.post(f"{collection}/queue/select", json={"shape_ids": ids.tolist(), "k": 2}).json()["shape_ids"]
    assert (len(chosen), mugs.ids["sub/c.off"] in chosen) == (2, True)


def test_many_labels_are_sent_back(reviewer, workspace, mugs, collection) -> None:
    for key in ("a.off", "b.off"):
        _human(workspace, mugs, key)
    body = {"shape_ids": list(mugs.ids.values()), "note": "the handles are missing"}
    answer = reviewer.post(f"{collection}/reject", json=body).json()
    assert answer["rejected"] == [mugs.ids["a.off"], mugs.ids["b.off"]]
    assert "no labels" in answer["refused"][0]["why"]


@pytest.mark.parametrize("path", ["accept", "queue/select", "reject"])
def test_shapes_of_other_collections_are_not_there(operator, mugs, collection, path) -> None:
    extra = {"accept": {"segmentation": "predicted"}, "reject": {"note": "no"}}.get(path, {})
    answer = operator.post(f"{collection}/{path}", json={"shape_ids": [mugs.other_shape_id], **extra})
    assert answer.status_code == 404


@pytest.mark.parametrize("path", ["accept", "queue/select", "reject"])
def test_annotators_decide_nothing(annotator, mugs, collection, path) -> None:
    extra = {"accept": {"segmentation": "predicted"}, "reject": {"note": "no"}}.get(path, {})
    body = {"shape_ids": [mugs.ids["a.off"]], **extra}
    assert annotator.post(f"{collection}/{path}", json=body).status_code == 403
    assert annotator.get(f"{collection}/accepts").status_code == 403


@pytest.mark.parametrize("body", [{"shape_ids": []}, {"segmentation": "confirmed"}, {"recheck": -1}, {"recheck": 501}])
def test_a_wish_out_of_range_is_refused(reviewer, mugs, collection, body) -> None:
    whole = {"shape_ids": [mugs.ids["a.off"]], "segmentation": "predicted", **body}
    assert reviewer.post(f"{collection}/accept", json=whole).status_code == 422
