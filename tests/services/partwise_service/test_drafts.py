"""Drafts: strokes acknowledged once they are committed, both sides of a conflict, and what is confirmed."""

import json
from contextlib import ExitStack
from dataclasses import asdict
from datetime import UTC, datetime
from uuid import uuid4

import numpy as np
import pytest
from safetensors.numpy import load

from partwise.labels.encoding import labels_sha256
from partwise.labels.label_delta import LabelDelta
from partwise.labels.operations import Paint
from partwise.labels.strokes import Stroke
from partwise.segmentation.paint import Brush
from partwise.store.records import NewRevision, RevisionKind, Role
from partwise.workspace import confirming
from partwise_service.app import MAX_REPLAYS
from partwise_service.routes.drafts import MAX_SEEDS, MAX_STROKES_OF_DRAFT

AT = "2026-11-22T12:00:00Z"
JSON = {"Content-Type": "application/json"}
_DIFFERENCE = LabelDelta.between(np.zeros(4, np.uint16), np.ones(4, np.uint16))
DELTA = {"kind": "delta", "source": "patches", "parameters": {}, **asdict(_DIFFERENCE)}


class Bench:
    """An annotator at a shape of four faces."""

    def __init__(self, caller, workspace, mugs, name: str, base_revision: int | None = None) -> None:
        self.caller = caller
        self.person_id = workspace.catalog.get_person(name).id
        self.shape_id = mugs.ids["a.off"]
        body = {"collection_id": mugs.collection_id, "shape_ids": [self.shape_id]}
        self.lease = caller.post("/queue/claim", json=body).json()["items"][0]
        self.base_revision = base_revision
        self.draft = self.open().json()
        self.path = f"/drafts/{self.draft['id']}"

    def open(self):
        return self.caller.post(f"/leases/{self.lease['id']}/draft", json={"base_revision": self.base_revision})

    def stroke(self, sequence: int, face: int = 0, label: int = 1) -> dict:
        return {
            "v": 1,
            "kind": "assign",
            "runs": [[face, 1]],
            "label": label,
            "id": str(uuid4()),
            "sequence": sequence,
            "base_revision": self.base_revision,
            "author_id": self.person_id,
            "at": AT,
        }

    def painted(self, sequence: int, n_seeds: int = 1) -> dict:
        """A stroke with a brush as wide as the shape, over what has no label."""
        return self._grown(sequence, kind="paint", seeds=[0] * n_seeds, radius=1.0, min_cosine=None, only_over=0)

    def filled(self, sequence: int) -> dict:
        return self._grown(sequence, kind="segment_wide", seed=0)

    def _grown(self, sequence: int, **fields) -> dict:
        stroke = {**self.stroke(sequence), **fields}
        del stroke["runs"]
        return stroke

    def send(self, *strokes: dict, expected: int | None = None):
        sequence = strokes[0]["sequence"] if expected is None else expected
        return self.caller.post(f"{self.path}/strokes", json={"expected_sequence": sequence, "strokes": list(strokes)})

    def confirm(self, n_strokes: int, **body):
        return self.caller.post(f"{self.path}/confirm", json=body, headers={"If-Match": f'"{n_strokes}"'})


@pytest.fixture
def bench(annotator, workspace, mugs) -> Bench:
    return Bench(annotator, workspace, mugs, "ann")


def _others_labels(workspace, mugs) -> int:
    mesh = mugs.meshes["a.off"]
    eve = workspace.catalog.add_person("eve")
    new = NewRevision(mugs.ids["a.off"], mesh.content_hash(), RevisionKind.HUMAN, eve.id, 1, np.full(mesh.n_faces, 2))
    return workspace.catalog.add_revision(new).id


def test_a_draft_keeps_its_mesh_for_good(bench, workspace) -> None:
    assert workspace.catalog.mesh(bench.shape_id, bench.draft["mesh_hash"]).kept_key is not None


def test_strokes_are_on_record_as_they_were_sent(bench) -> None:
    strokes = [bench.stroke(0), bench.stroke(1, 2, 2)]
    answer = bench.send(*strokes)
    assert (answer.json()["n_strokes"], answer.headers["etag"]) == (2, '"2"')
    recorded = bench.caller.get(f"{bench.path}/strokes").json()
    assert [each["id"] for each in recorded["items"]] == [stroke["id"] for stroke in strokes]
    assert recorded["items"][0]["payload"]["runs"] == [[0, 1]]


def test_sending_again_adds_nothing(bench) -> None:
    stroke = bench.stroke(0)
    assert [bench.send(stroke).json()["n_strokes"] for _ in range(3)] == [1, 1, 1]


def test_an_overlapping_sending_adds_the_rest(bench) -> None:
    first, second = bench.stroke(0), bench.stroke(1)
    bench.send(first)
    assert bench.send(first, second).json()["n_strokes"] == 2


def test_the_log_comes_in_pages(bench) -> None:
    bench.send(*(bench.stroke(n) for n in range(3)))
    page = bench.caller.get(f"{bench.path}/strokes", params={"limit": 2}).json()
    assert ([each["sequence"] for each in page["items"]], page["next"]) == ([0, 1], 1)
    rest = bench.caller.get(f"{bench.path}/strokes", params={"after": page["next"]}).json()
    assert ([each["sequence"] for each in rest["items"]], rest["next"]) == ([2], None)


def test_a_stale_stroke_is_refused_with_both_sides(bench) -> None:
    here, elsewhere = bench.stroke(0), bench.stroke(0, 3)
    bench.send(elsewhere)
    answer = bench.send(here)
    problem = answer.json()
    assert (answer.status_code, problem["state"]["n_strokes"]) == (409, 1)
    assert [each["id"] for each in problem["recorded"]] == [elsewhere["id"]]
    assert problem["refused"] == [here]


def test_a_stroke_from_another_base_is_refused_with_both_sides(bench) -> None:
    stroke = {**bench.stroke(0), "base_revision": 7}
    answer = bench.send(stroke)
    assert (answer.status_code, answer.json()["refused"]) == (409, [stroke])
    assert answer.json()["state"]["base_revision"] is None


@pytest.mark.parametrize(
    "change", [{"author_id": 999}, {"kind": "guess"}, {"id": "one"}, {"sequence": 5}, {"label": 70_000}, {"more": 1}]
)
def test_a_malformed_stroke_is_refused_and_nothing_recorded(bench, change) -> None:
    assert bench.send({**bench.stroke(0), **change}, expected=0).status_code == 422
    assert bench.caller.get(bench.path).json()["n_strokes"] == 0


@pytest.mark.parametrize(
    "operation",
    [
        {"kind": "paint", "seeds": [0, 4], "radius": 0.1, "min_cosine": None, "label": 1, "only_over": None},
        {"kind": "assign", "runs": [[2, 3]], "label": 1},
        {"kind": "segment_wide", "seed": 4, "label": 1},
        {**DELTA, "n_faces": 5},
        {**DELTA, "payload": "AAAA"},
    ],
)
def test_a_stroke_that_could_not_be_replayed_is_refused(bench, operation) -> None:
    bare = {key: value for key, value in bench.stroke(0).items() if key not in ("runs", "label")}
    assert bench.send({**bare, **operation}).status_code == 422
    assert bench.caller.get(bench.path).json()["n_strokes"] == 0


def test_a_draft_is_replayed_whatever_was_undone(bench) -> None:
    bare = {key: value for key, value in bench.stroke(0).items() if key not in ("runs", "label")}
    undo, redo = {**bare, "kind": "undo"}, {**bare, "kind": "redo", "id": str(uuid4()), "sequence": 1}
    assert bench.send(undo, redo, *(bench.stroke(2 + face, face) for face in range(4))).json()["n_strokes"] == 6
    assert load(bench.caller.get(f"{bench.path}/labels").content)["labels"].tolist() == [1, 1, 1, 1]
    assert bench.confirm(6).status_code == 200


@pytest.mark.parametrize(
    "change", [{"base_revision": 10**30}, {"base_revision": 2**31}, {"author_id": 10**30}, {"sequence": 2**31 - 1}]
)
def test_a_number_that_no_catalog_holds_is_refused(bench, change) -> None:
    stroke = {**bench.stroke(0), **change}
    assert bench.send(stroke, expected=min(stroke["sequence"], 2**31 - 1)).status_code == 422


@pytest.mark.parametrize("text", ["\ud800", "\0"])
def test_text_that_could_not_be_told_again_is_refused(bench, text) -> None:
    bare = {key: value for key, value in bench.stroke(0).items() if key not in ("runs", "label")}
    strokes = [{**bare, **DELTA, "parameters": {"model": text}}, {**bench.stroke(0), text: 1}]
    for stroke in strokes:
        body = json.dumps({"expected_sequence": 0, "strokes": [stroke]})
        answer = bench.caller.post(f"{bench.path}/strokes", content=body, headers=JSON)
        assert (answer.status_code, answer.json()["status"]) == (422, 422)
    assert bench.caller.get(f"{bench.path}/strokes").json()["items"] == []


def test_labels_of_a_draft(bench) -> None:
    bench.send(bench.stroke(0, 1, 2))
    answer = bench.caller.get(f"{bench.path}/labels")
    arrays = load(answer.content)
    assert (arrays["labels"].tolist(), arrays["base"].tolist()) == ([0, 2, 0, 0], [0, 0, 0, 0])
    held = {"If-None-Match": answer.headers["etag"]}
    assert bench.caller.get(f"{bench.path}/labels", headers=held).status_code == 304
    bench.send(bench.stroke(1, 2, 2))
    assert bench.caller.get(f"{bench.path}/labels", headers=held).status_code == 200


class TestTools:
    """Strokes that paint or fill are replayed in the tools' processes, where they hold up nobody else."""

    @pytest.fixture
    def calls(self, app, monkeypatch) -> list:
        """What the tools are asked; they answer with handles everywhere."""
        asked = []

        async def run(call, person_id: int) -> np.ndarray:
            asked.append((call, person_id))
            return np.full(call.mesh.n_faces, 2, dtype=np.uint16)

        monkeypatch.setattr(app.state.service.replaying, "run", run)
        return asked

    def test_labels_are_theirs(self, bench, calls) -> None:
        bench.send(bench.painted(0))
        assert load(bench.caller.get(f"{bench.path}/labels").content)["labels"].tolist() == [2, 2, 2, 2]
        [(call, person_id)] = calls
        assert (len(call.draft.log.strokes), person_id) == (1, bench.person_id)

    @pytest.mark.parametrize("how", ["confirm", "complete"])
    def test_what_they_leave_is_confirmed(self, bench, calls, workspace, how) -> None:
        bench.send(bench.filled(0))
        path, headers = f"{bench.path}/confirm", {"If-Match": '"1"'}
        answer = (
            bench.caller.post(path, json={}, headers=headers)
            if how == "confirm"
            else bench.caller.post(f"/leases/{bench.lease['id']}/complete", json={"n_strokes": 1})
        )
        assert (answer.status_code, len(calls)) == (200, 1)
        assert workspace.catalog.labels(workspace.catalog.head_revision(bench.shape_id).id).tolist() == [2, 2, 2, 2]

    def test_a_log_that_grows_no_region_needs_none(self, bench, calls) -> None:
        bench.send(*(bench.stroke(n, n) for n in range(4)))
        assert load(bench.caller.get(f"{bench.path}/labels").content)["labels"].tolist() == [1, 1, 1, 1]
        assert (bench.confirm(4).status_code, calls) == (200, [])

    def test_a_log_that_is_long_for_its_mesh_needs_them(self, bench, calls, monkeypatch) -> None:
        monkeypatch.setattr(confirming, "_QUICK", 7)
        bench.send(bench.stroke(0), bench.stroke(1, 1))
        assert load(bench.caller.get(f"{bench.path}/labels").content)["labels"].tolist() == [2, 2, 2, 2]

    def test_they_leave_what_the_strokes_say(self, bench, mugs) -> None:
        bench.send(bench.stroke(0, 3, 2), bench.painted(1))
        labels = load(bench.caller.get(f"{bench.path}/labels").content)["labels"]
        assert labels.tolist() == [1, 1, 1, 2]
        assert bench.confirm(2, labels_sha256=labels_sha256(labels)).json()["labels_sha256"] == labels_sha256(labels)

    def test_strokes_that_they_refuse_are_told(self, bench, workspace) -> None:
        strange = Stroke(uuid4(), 0, None, bench.person_id, datetime.now(UTC), Paint((99,), Brush(0.1), 1))
        workspace.catalog.append_strokes(bench.draft["id"], bench.person_id, 0, [strange])  # from before it was noticed
        assert bench.confirm(1).status_code == 422

    def test_one_person_has_few_drafts_read_at_once(self, bench, app) -> None:
        with ExitStack() as reading:
            for _ in range(MAX_REPLAYS):
                reading.enter_context(app.state.service.replays.one_more(bench.person_id))
            answer = bench.caller.get(f"{bench.path}/labels")
            assert (answer.status_code, "retry-after" in answer.headers) == (429, True)
        assert bench.caller.get(f"{bench.path}/labels").status_code == 200


def test_a_stroke_may_have_many_seeds_but_not_any_number(bench) -> None:
    assert bench.send(bench.painted(0, MAX_SEEDS)).status_code == 200
    refused = bench.send(bench.painted(1, MAX_SEEDS + 1))
    assert (refused.status_code, "10,000 seeds" in refused.json()["detail"]) == (422, True)


def test_a_draft_may_have_many_strokes_but_not_any_number(bench) -> None:
    stale = bench.send(bench.stroke(MAX_STROKES_OF_DRAFT - 1))
    refused = bench.send(bench.stroke(MAX_STROKES_OF_DRAFT))
    assert (stale.status_code, refused.status_code) == (409, 422)
    assert "100,000 strokes" in refused.json()["detail"]


def test_confirming_makes_the_strokes_labels(bench) -> None:
    bench.send(*(bench.stroke(n, n) for n in range(4)))
    done = bench.confirm(4).json()
    labels = load(bench.caller.get(f"/shapes/{bench.shape_id}/labels").content)["labels"]
    assert labels.tolist() == [1, 1, 1, 1]
    assert done == {"draft_id": bench.draft["id"], "shape_id": bench.shape_id, "labels_sha256": labels_sha256(labels)}
    assert bench.caller.get("/leases").json()["items"] == []


def test_confirming_twice_is_confirming_once(bench, workspace) -> None:
    bench.send(*(bench.stroke(n, n) for n in range(4)))
    assert bench.confirm(4).json() == bench.confirm(4).json()
    assert len(workspace.catalog.revisions(bench.shape_id)) == 1


def test_completing_a_lease_confirms_its_draft(bench) -> None:
    bench.send(*(bench.stroke(n, n) for n in range(4)))
    answer = bench.caller.post(f"/leases/{bench.lease['id']}/complete", json={"n_strokes": 4})
    assert answer.json()["draft_id"] == bench.draft["id"]


def test_completing_a_lease_again_returns_the_same(bench) -> None:
    bench.send(*(bench.stroke(n, n) for n in range(4)))
    path, body = f"/leases/{bench.lease['id']}/complete", {"n_strokes": 4}
    first = bench.caller.post(path, json=body)
    assert (first.status_code, bench.caller.post(path, json=body).json()) == (200, first.json())


def test_a_refused_completion_has_both_sides(bench) -> None:
    unknown = bench.stroke(1, 1)
    bench.send(bench.stroke(0), unknown)
    answer = bench.caller.post(f"/leases/{bench.lease['id']}/complete", json={"n_strokes": 1})
    assert (answer.status_code, answer.json()["state"]["n_strokes"]) == (409, 2)
    assert [each["id"] for each in answer.json()["recorded"]] == [unknown["id"]]


def test_labels_that_were_sent_back_are_not_completed_by_the_draft_before(bench, workspace, reviewer, mugs) -> None:
    bench.send(*(bench.stroke(n, n) for n in range(4)))
    bench.confirm(4)
    sent_back = reviewer.post(f"/shapes/{bench.shape_id}/reject", json={"note": "the rim", "for_author": True})
    assert sent_back.status_code == 200
    body = {"collection_id": mugs.collection_id, "shape_ids": [bench.shape_id]}
    lease = bench.caller.post("/queue/claim", json=body).json()["items"][0]
    answer = bench.caller.post(f"/leases/{lease['id']}/complete", json={"n_strokes": 4})
    assert (answer.status_code, "open one first" in answer.json()["detail"]) == (409, True)
    assert [each["id"] for each in bench.caller.get("/leases").json()["items"]] == [lease["id"]]


def test_a_lease_without_a_draft_cannot_be_completed(annotator, mugs) -> None:
    lease = annotator.post("/queue/claim", json={"collection_id": mugs.collection_id}).json()["items"][0]
    assert annotator.post(f"/leases/{lease['id']}/complete", json={"n_strokes": 0}).status_code == 409


def test_strokes_that_the_person_did_not_know_of_are_not_confirmed(bench) -> None:
    unknown = bench.stroke(1, 1)
    bench.send(bench.stroke(0), unknown)
    answer = bench.confirm(1)
    assert (answer.status_code, answer.json()["state"]["n_strokes"]) == (409, 2)
    assert [each["id"] for each in answer.json()["recorded"]] == [unknown["id"]]


def test_other_labels_than_the_person_sees_are_not_confirmed(bench) -> None:
    bench.send(bench.stroke(0))
    assert bench.confirm(1, labels_sha256="0" * 64).status_code == 409


def test_a_confirmation_must_say_what_it_is_of(bench) -> None:
    assert bench.caller.post(f"{bench.path}/confirm", json={}).status_code == 422


def test_nobody_confirms_over_labels_they_have_not_seen(bench, workspace, mugs) -> None:
    bench.send(bench.stroke(0))
    revision_id = _others_labels(workspace, mugs)
    refused = bench.confirm(1)
    assert (refused.status_code, refused.json()["state"]["head_revision"]) == (409, revision_id)
    stale = bench.caller.post(f"{bench.path}/acknowledge", json={"revision_id": revision_id + 1})
    assert (stale.status_code, stale.json()["state"]["head_revision"]) == (409, revision_id)
    bench.caller.post(f"{bench.path}/acknowledge", json={"revision_id": revision_id})
    assert bench.confirm(1).status_code == 200


def test_a_draft_goes_on_where_it_was_left(bench) -> None:
    bench.send(bench.stroke(0))
    again = bench.open().json()
    assert (again["id"], again["n_strokes"]) == (bench.draft["id"], 1)
    assert bench.caller.get("/leases").json()["items"][0]["draft_id"] == bench.draft["id"]


def test_a_draft_outlives_its_lease(bench) -> None:
    bench.send(bench.stroke(0))
    bench.caller.post(f"/leases/{bench.lease['id']}/release")
    assert bench.send(bench.stroke(1)).json()["n_strokes"] == 2
    assert [each["id"] for each in bench.caller.get("/drafts").json()["items"]] == [bench.draft["id"]]
    assert bench.caller.get(f"/shapes/{bench.shape_id}/draft").json()["n_strokes"] == 2


def test_a_draft_says_nothing_of_labels_that_it_may_not_start_from(annotator, workspace, mugs) -> None:
    """Neither which revisions there are, nor what a reference or another collection's labels are."""
    eve = workspace.catalog.add_person("eve")
    body = {"collection_id": mugs.collection_id, "shape_ids": [mugs.ids["a.off"]]}
    lease = annotator.post("/queue/claim", json=body).json()["items"][0]
    secrets = [(mugs.ids["a.off"], "a.off", RevisionKind.REFERENCE), (mugs.other_shape_id, "a.off", RevisionKind.HUMAN)]
    ids = [10**6]
    for shape_id, name, kind in secrets:
        mesh = mugs.meshes[name]
        new = NewRevision(shape_id, mesh.content_hash(), kind, eve.id, 1, np.full(mesh.n_faces, 1))
        ids.append(workspace.catalog.add_revision(new).id)
    answers = [annotator.post(f"/leases/{lease['id']}/draft", json={"base_revision": each}) for each in ids]
    told = {
        (answer.status_code, answer.text.replace(f"revision {each} ", ""))
        for answer, each in zip(answers, ids, strict=True)
    }
    assert len(told) == 1
    assert answers[0].status_code == 422


def test_a_draft_may_start_from_labels(annotator, workspace, mugs) -> None:
    revision_id = _others_labels(workspace, mugs)
    bench = Bench(annotator, workspace, mugs, "ann", revision_id)
    assert bench.draft["base_revision"] == revision_id
    bench.send(bench.stroke(0, 0, 1))
    assert load(annotator.get(f"{bench.path}/labels").content)["labels"].tolist() == [1, 2, 2, 2]


def test_a_discarded_draft_takes_no_more_strokes(bench) -> None:
    bench.send(bench.stroke(0))
    assert bench.caller.post(f"{bench.path}/discard").json()["outcome"] == "discarded"
    assert bench.send(bench.stroke(1)).status_code == 409
    assert len(bench.caller.get(f"{bench.path}/strokes").json()["items"]) == 1
    assert bench.confirm(1).status_code == 409


def test_strokes_on_record_may_be_sent_again_to_a_closed_draft(bench) -> None:
    strokes = [bench.stroke(n, n) for n in range(4)]
    bench.send(*strokes)
    bench.confirm(4)
    again = bench.send(*strokes)
    assert (again.status_code, again.json()["outcome"]) == (200, "confirmed")
    late = bench.stroke(4)
    refused = bench.send(*strokes[2:], late)
    assert (refused.status_code, refused.json()["state"]["outcome"]) == (409, "confirmed")
    assert [each["id"] for each in refused.json()["recorded"]] == [each["id"] for each in strokes[2:]]
    assert refused.json()["refused"] == [*strokes[2:], late]


def test_another_persons_draft_does_not_exist(bench, issue, mugs) -> None:
    ben = issue("ben", Role.ANNOTATOR, (mugs.collection_id,))
    paths = [bench.path, f"{bench.path}/strokes", f"{bench.path}/labels", f"/shapes/{bench.shape_id}/draft"]
    assert {ben.get(path).status_code for path in paths} == {404}
    bench.caller = ben
    assert {bench.send(bench.stroke(0)).status_code, bench.confirm(0).status_code} == {404}


def test_an_operator_may_look_at_a_draft_but_not_add_to_it(bench, operator) -> None:
    assert operator.get(bench.path).json()["id"] == bench.draft["id"]
    bench.caller = operator
    assert bench.send(bench.stroke(0)).status_code == 422
    assert bench.confirm(0).status_code == 409


def test_nobody_opens_a_draft_in_anothers_name(annotator, operator, mugs) -> None:
    lease = annotator.post("/queue/claim", json={"collection_id": mugs.collection_id}).json()["items"][0]
    assert operator.post(f"/leases/{lease['id']}/draft", json={}).status_code == 409
    assert annotator.get("/drafts").json()["items"] == []


def test_there_is_no_draft_of_an_untouched_shape(annotator, mugs) -> None:
    assert annotator.get(f"/shapes/{mugs.ids['b.off']}/draft").status_code == 404
