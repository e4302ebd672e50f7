"""The table, its pages, filters and orders; one shape; its revisions."""

import numpy as np
import pytest

from partwise.store.records import NewFailure, NewRevision, RevisionKind


def _keys(answer) -> list[str]:
    return [row["source_key"] for row in answer.json()["items"]]


def _label(workspace, mugs, key: str, kind: RevisionKind, part_id: int = 1, author: str = "eve") -> int:
    catalog, shape_id = workspace.catalog, mugs.ids[key]
    mesh = catalog.meshes([shape_id])[shape_id]
    known = {person.name: person for person in catalog.list_people()}
    person = known.get(author) or catalog.add_person(author)
    labels = np.full(mesh.n_faces, part_id)
    return catalog.add_revision(NewRevision(shape_id, mesh.mesh_hash, kind, person.id, 1, labels)).id


@pytest.fixture
def table(mugs) -> str:
    return f"/collections/{mugs.collection_id}/shapes"


def test_shapes_are_listed_by_id(annotator, table) -> None:
    assert _keys(annotator.get(table)) == ["a.off", "b.off", "sub/c.off"]


def test_pages_follow_each_other_to_the_end(annotator, table) -> None:
    keys, after = [], None
    for _ in range(5):
        page = annotator.get(table, params={"limit": 1} | ({"after": after} if after else {}))
        keys += _keys(page)
        after = page.json()["next"]
        if after is None:
            break
    assert keys == ["a.off", "b.off", "sub/c.off"]


def test_pages_in_order_of_a_score_follow_each_other(annotator, table) -> None:
    order = {"order": "entropy", "descending": True, "limit": 2}
    first = annotator.get(table, params=order)
    second = annotator.get(table, params={**order, "after": first.json()["next"]})
    assert _keys(first) + _keys(second) == ["sub/c.off", "b.off", "a.off"]
    assert first.json()["items"][0]["model_version"] == 1
    assert first.json()["items"][0]["score"] > first.json()["items"][1]["score"]


@pytest.mark.parametrize(
    "query",
    [
        {"after": "x"}, {"after": "1~x"}, {"after": "1~nan"}, {"after": "1~inf"}, {"after": "-1"}, {"after": "9" * 12},
        {"after": "1" * 81}, {"limit": 0}, {"limit": 501}, {"state": "odd"}, {"order": "entropy; DROP TABLE shape"},
        {"part": -1}, {"cluster": 2**40}, {"descending": "perhaps"},
    ],
)  # fmt: skip
def test_a_query_out_of_range_is_refused(annotator, table, query) -> None:
    assert annotator.get(table, params=query).status_code == 422


def test_an_order_that_no_shape_has_a_score_for_is_empty(annotator, table) -> None:
    assert _keys(annotator.get(table, params={"order": "nothing"})) == []


def test_filters_by_state_part_and_author(annotator, workspace, mugs, table) -> None:
    _label(workspace, mugs, "b.off", RevisionKind.HUMAN, part_id=2)
    eve = workspace.catalog.get_person("eve").id
    for query in ({"state": "confirmed"}, {"part": 2}, {"author": eve}, {"state": "confirmed", "part": 2}):
        assert _keys(annotator.get(table, params=query)) == ["b.off"], query
    assert _keys(annotator.get(table, params={"part": 1})) == []


def test_filters_by_failure(annotator, workspace, mugs, table) -> None:
    workspace.catalog.record_failure(NewFailure(mugs.ids["a.off"], "refine", "k9", "why"))
    assert _keys(annotator.get(table, params={"failed_stage": "refine"})) == ["a.off"]


def test_filters_by_cluster(annotator, workspace, mugs, table) -> None:
    workspace.catalog.set_clusters(mugs.collection_id, {mugs.ids["a.off"]: 0, mugs.ids["b.off"]: 3})
    assert _keys(annotator.get(table, params={"cluster": 3})) == ["b.off"]
    assert annotator.get(table).json()["items"][0]["cluster"] == 0


def test_jumping_to_a_rank(annotator, workspace, mugs, table) -> None:
    assert annotator.get(f"{table}/ranked", params={"order": "entropy"}).status_code == 404
    ordering = workspace.catalog.begin_ordering(mugs.collection_id, "entropy")
    while workspace.catalog.extend_ordering(ordering.id):
        pass
    jumped = annotator.get(f"{table}/ranked", params={"order": "entropy", "first_rank": 1, "descending": True})
    assert (_keys(jumped), jumped.json()["n_shapes"]) == (["b.off", "a.off"], 3)


def test_a_shape_tells_how_it_came_to_be(annotator, mugs) -> None:
    shown = annotator.get(f"/shapes/{mugs.ids['a.off']}").json()
    assert (shown["source_key"], shown["state"], shown["mesh"]["n_faces"]) == ("a.off", "ready", 4)
    assert [stage["stage"] for stage in shown["provenance"]["stages"]] == ["mesh", "describe", "evaluate", "refine"]
    assert shown["head"] is None


def test_logs_of_failures_are_for_operators(annotator, operator, workspace, mugs) -> None:
    detail = {"kind": "crash", "log": "Traceback /srv/partwise/x.py"}
    workspace.catalog.record_failure(NewFailure(mugs.ids["a.off"], "remesh", "k9", "it crashed", detail=detail))
    path = f"/shapes/{mugs.ids['a.off']}"
    assert "/srv/partwise" in operator.get(path).text
    shown = annotator.get(path)
    assert "it crashed" in shown.text
    assert "/srv/partwise" not in shown.text


def test_the_newest_labels_are_the_head(annotator, workspace, mugs) -> None:
    revision_id = _label(workspace, mugs, "a.off", RevisionKind.HUMAN)
    shown = annotator.get(f"/shapes/{mugs.ids['a.off']}").json()
    assert (shown["head"]["id"], shown["state"]) == (revision_id, "confirmed")


def test_reference_labels_are_never_shown(admin, workspace, mugs) -> None:
    hidden = _label(workspace, mugs, "a.off", RevisionKind.REFERENCE)
    shown = _label(workspace, mugs, "a.off", RevisionKind.IMPORTED)
    path = f"/shapes/{mugs.ids['a.off']}"
    assert [each["id"] for each in admin.get(f"{path}/revisions").json()["items"]] == [shown]
    assert admin.get(f"{path}/labels", params={"revision": hidden}).status_code == 404
    assert "reference" not in admin.get(path).text
