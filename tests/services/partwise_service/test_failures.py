"""Quarantined shapes over HTTP: what failed and why, and trying it again."""

import pytest

from partwise.store.records import JobKind, NewFailure, Role


@pytest.fixture
def failed(workspace, mugs) -> None:
    """a.off ran out of memory in remesh, b.off out of time, c.off was refused by evaluate."""
    for key, stage, reason, detail in (
        ("a.off", "picture", "needs 9 GB", {"kind": "memory"}),
        ("b.off", "picture", "took too long", {"kind": "deadline"}),
        ("sub/c.off", "segment", "refused", {}),
    ):
        workspace.catalog.record_failure(NewFailure(mugs.ids[key], stage, "k9", reason, 2, 1.0, detail))


def _of(mugs, ending: str = "") -> str:
    return f"/collections/{mugs.collection_id}/failures{ending}"


def _shown(answer) -> list[str]:
    return [item["source_key"] for item in answer.json()["items"]]


def test_a_failure_says_what_happened(operator, mugs, failed) -> None:
    first = operator.get(_of(mugs)).json()["items"][0]
    assert first.pop("at")
    assert first == {
        "shape_id": mugs.ids["a.off"],
        "source_key": "a.off",
        "stage": "picture",
        "kind": "memory",
        "message": "needs 9 GB",
        "attempts": 2,
    }


def test_failures_by_kind_and_stage(operator, mugs, failed) -> None:
    assert _shown(operator.get(_of(mugs), params={"kind": "deadline"})) == ["b.off"]
    assert _shown(operator.get(_of(mugs), params={"stage": "segment"})) == ["sub/c.off"]
    assert _shown(operator.get(_of(mugs), params={"stage": "segment", "kind": "memory"})) == []


def test_pages_of_failures(operator, mugs, failed) -> None:
    first = operator.get(_of(mugs), params={"limit": 2})
    second = operator.get(_of(mugs), params={"limit": 2, "after": first.json()["next"]})
    assert (_shown(first), _shown(second)) == (["a.off", "b.off"], ["sub/c.off"])
    assert second.json()["next"] is None


@pytest.mark.parametrize(
    ("which", "left"),
    [
        ({"kind": "memory"}, ["b.off", "sub/c.off"]),
        ({"stage": "picture"}, ["sub/c.off"]),
        ({"text": "TOO LONG"}, ["a.off", "sub/c.off"]),
        ({}, []),
    ],
)
def test_failures_are_forgotten_and_preprocessed_again(operator, workspace, mugs, failed, which, left) -> None:
    answer = operator.post(_of(mugs, "/retry"), json=which)
    assert answer.status_code == 200
    assert answer.json()["n_retried"] == 3 - len(left)
    assert answer.json()["job"]["kind"] == "preprocess"
    assert _shown(operator.get(_of(mugs))) == left


def test_named_shapes_are_tried_again_by_one_job(operator, workspace, mugs, failed) -> None:
    jobs = [
        operator.post(_of(mugs, "/retry"), json={"shape_ids": [mugs.ids[key]]}).json()["job"]["id"]
        for key in ("a.off", "sub/c.off")
    ]
    assert jobs[0] == jobs[1]
    assert _shown(operator.get(_of(mugs))) == ["b.off"]


def test_failures_of_evaluation_are_evaluated_again(operator, workspace, mugs) -> None:
    workspace.catalog.record_failure(NewFailure(mugs.ids["a.off"], "evaluate", "k9", "died", detail={"kind": "crash"}))
    job = operator.post(_of(mugs, "/retry"), json={"stage": "evaluate"}).json()["job"]
    assert job["kind"] == "evaluate"


def test_nothing_to_forget_asks_for_nothing(operator, workspace, mugs) -> None:
    assert operator.post(_of(mugs, "/retry"), json={}).json() == {"n_retried": 0, "job": None}
    assert workspace.catalog.next_job(list(JobKind)) is None


def test_failures_are_for_operators(reviewer, mugs) -> None:
    assert reviewer.get(_of(mugs)).status_code == 403
    assert reviewer.post(_of(mugs, "/retry"), json={}).status_code == 403


def test_failures_of_foreign_collections_are_not_found(issue, mugs) -> None:
    caller = issue("olga", Role.OPERATOR, (mugs.collection_id,))
    path = f"/collections/{mugs.other_id}/failures"
    assert (caller.get(path).status_code, caller.post(f"{path}/retry", json={}).status_code) == (404, 404)
