"""The table, its pages, filters and orders; one shape; its revisions."""

import numpy as np
import pytest

from partwise.store.records import NewFailure, NewRevision, RevisionKind
from partwise.testing.workspaces import publish_meshes
from partwise_service.routes import shapes


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
    order = {"order": "entropy", "direction": "desc", "limit": 2}
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
        {"part": -1}, {"cluster": 2**40}, {"direction": "perhaps"}, {"failure": "A"},
        {"name": ""}, {"name": "n" * 201}, {"name": "a\0b"},
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
    for stage in ("refine", "any"):
        assert _keys(annotator.get(table, params={"failure": stage})) == ["a.off"]
    assert _keys(annotator.get(table, params={"failure": "mesh"})) == []


def test_filters_by_cluster(annotator, workspace, mugs, table) -> None:
    workspace.catalog.set_clusters(mugs.collection_id, {mugs.ids["a.off"]: 0, mugs.ids["b.off"]: 3})
    assert _keys(annotator.get(table, params={"cluster": 3})) == ["b.off"]
    assert annotator.get(table).json()["items"][0]["cluster"] == 0


def test_a_part_of_the_name_filters_pages_counts_and_jumps(annotator, workspace, mugs, table) -> None:
    workspace.catalog.set_clusters(mugs.collection_id, {mugs.ids["b.off"]: 1, mugs.ids["sub/c.off"]: 1})
    of_c = {"name": "SUB/"}
    for order in ("none", "name", "entropy"):
        assert _keys(annotator.get(table, params={**of_c, "order": order, "cluster": 1})) == ["sub/c.off"]
    assert _keys(annotator.get(table, params={**of_c, "cluster": 0})) == []
    assert annotator.get(f"{table}/count", params={"name": ".off"}).json() == {"n_shapes": 3}
    jumped = annotator.get(f"{table}/ranked", params={"name": ".off", "order": "name", "first_rank": 1}).json()
    assert (jumped["n_shapes"], [row["source_key"] for row in jumped["items"]]) == (3, ["b.off", "sub/c.off"])


@pytest.mark.parametrize("name", ["%", "_", "a_off", "*", "\\"])
def test_no_character_of_a_name_stands_for_others(annotator, table, name) -> None:
    assert _keys(annotator.get(table, params={"name": name})) == []


@pytest.mark.parametrize("direction", ["asc", "desc"])
def test_pages_in_order_of_names_follow_each_other(annotator, table, direction) -> None:
    order = {"order": "name", "direction": direction, "limit": 2}
    first = annotator.get(table, params=order)
    second = annotator.get(table, params={**order, "after": first.json()["next"]})
    assert _keys(first) + _keys(second) == sorted(["a.off", "b.off", "sub/c.off"], reverse=direction == "desc")


def test_a_row_says_all_that_its_tile_shows(annotator, ben_holds_b, workspace, mugs, table) -> None:
    revision_id = _label(workspace, mugs, "a.off", RevisionKind.HUMAN)
    a, b, _ = annotator.get(table).json()["items"]
    assert (a["revision_id"], a["author_name"], a["has_confirmed"], a["n_faces"]) == (revision_id, "eve", True, 4)
    assert (b["revision_id"], b["author_name"], b["has_confirmed"]) == (None, None, False)
    assert (a["predicted_version"], a["refined_version"], a["held_by"]) == (1, 1, [])
    assert [holder["name"] for holder in b["held_by"]] == ["ben"]


@pytest.fixture
def ben_holds_b(workspace, mugs) -> None:
    workspace.catalog.claim_shape(mugs.ids["b.off"], workspace.catalog.add_person("ben").id, 60)


def test_labels_on_a_former_mesh_are_not_shown(annotator, workspace, mugs, table) -> None:
    _label(workspace, mugs, "a.off", RevisionKind.HUMAN)
    publish_meshes(workspace, {mugs.ids["a.off"]: mugs.meshes["b.off"]}, "mesh-2")
    row = annotator.get(table).json()["items"][0]
    assert (row["has_confirmed"], row["predicted_version"], row["refined_version"]) == (False, None, None)


@pytest.mark.parametrize(
    ("query", "n"),
    [({}, 3), ({"state": "ready"}, 3), ({"state": "confirmed"}, 0), ({"order": "entropy"}, 3), ({"order": "bald"}, 0)],
)
def test_rows_are_counted(annotator, table, query, n) -> None:
    assert annotator.get(f"{table}/count", params=query).json() == {"n_shapes": n}


def test_jumping_to_a_rank(annotator, table) -> None:
    order = {"order": "entropy", "first_rank": 1, "direction": "desc"}
    jumped = annotator.get(f"{table}/ranked", params=order)
    assert (_keys(jumped), jumped.json()["n_shapes"]) == (["b.off", "a.off"], 3)
    assert [row["rank"] for row in jumped.json()["items"]] == [1, 2]
    assert jumped.json()["built_at"] is None


@pytest.mark.parametrize(("first_rank", "limit"), [(0, 2), (0, 3), (0, 100), (2, 100), (3, 100), (9, 1)])
def test_a_jump_says_how_many_there_are_wherever_it_goes(annotator, table, first_rank, limit) -> None:
    jumped = annotator.get(f"{table}/ranked", params={"first_rank": first_rank, "limit": limit}).json()
    assert (jumped["n_shapes"], len(jumped["items"])) == (3, max(0, min(limit, 3 - first_rank)))


@pytest.mark.parametrize("order", ["none", "name", "entropy"])
def test_jumps_take_filters(annotator, workspace, mugs, table, order) -> None:
    workspace.catalog.set_clusters(mugs.collection_id, {mugs.ids["a.off"]: 3, mugs.ids["sub/c.off"]: 3})
    jumped = annotator.get(f"{table}/ranked", params={"order": order, "first_rank": 1, "cluster": 3})
    assert (_keys(jumped), jumped.json()["n_shapes"]) == (["sub/c.off"], 2)


def test_jumps_in_a_large_collection_are_into_an_order_made_beforehand(
    annotator, workspace, mugs, table, monkeypatch
) -> None:
    monkeypatch.setattr(shapes, "LIVE_UP_TO", 2)
    ordering = workspace.catalog.begin_ordering(mugs.collection_id, "entropy")
    while workspace.catalog.extend_ordering(ordering.id):
        pass
    query = {"order": "entropy", "first_rank": 1, "direction": "desc"}
    jumped = annotator.get(f"{table}/ranked", params=query)
    assert (_keys(jumped), jumped.json()["built_at"] is None) == (["b.off", "a.off"], False)


def test_the_orders_that_exist(annotator, mugs) -> None:
    orders = annotator.get(f"/collections/{mugs.collection_id}/orders").json()["items"]
    assert [order["name"] for order in orders] == ["none", "name", "entropy", "entropy_by_area"]
    assert (orders[2]["label"], orders[2]["direction_default"], orders[2]["is_queues"]) == ("Entropy", "desc", True)


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


def test_rows_of_shapes_by_name_of_their_ids_in_that_order(annotator, mugs, table) -> None:
    ids = [mugs.ids["sub/c.off"], mugs.ids["a.off"], mugs.ids["sub/c.off"]]
    shown = annotator.get(f"{table}/rows", params={"id": ids, "order": "entropy"})
    assert _keys(shown) == ["sub/c.off", "a.off"]
    assert all(row["score"] is not None for row in shown.json()["items"])


def test_rows_of_shapes_that_are_not_there_are_refused(annotator, mugs, table) -> None:
    assert annotator.get(f"{table}/rows", params={"id": [mugs.ids["a.off"], 9_999]}).status_code == 404
    assert annotator.get(f"{table}/rows").status_code == 422
