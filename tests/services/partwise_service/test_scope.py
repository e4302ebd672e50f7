"""What is outside a caller's scope does not exist for them, whatever the path."""

import pytest

from partwise.store.records import Role

OF_A_COLLECTION = ["", "/parts", "/shapes", "/shapes/ranked", "/reviews", "/models", "/embedding", "/ops", "/skips"]
OF_A_SHAPE = ["", "/revisions", "/labels", "/uncertainty", "/thumbnail", "/reviews"]


@pytest.mark.parametrize("path", OF_A_COLLECTION)
def test_foreign_collections_are_not_found(issue, mugs, path) -> None:
    caller = issue("olga", Role.ADMIN, (mugs.collection_id,))
    answer = caller.get(f"/collections/{mugs.other_id}{path}")
    assert (answer.status_code, answer.json()["type"]) == (404, "urn:partwise:problem:not-found")


@pytest.mark.parametrize("path", OF_A_SHAPE)
def test_foreign_shapes_are_not_found(reviewer, mugs, path) -> None:
    foreign = reviewer.get(f"/shapes/{mugs.other_shape_id}{path}")
    unknown = reviewer.get(f"/shapes/999{path}")
    assert (foreign.status_code, unknown.status_code) == (404, 404)
    assert foreign.json()["detail"] == unknown.json()["detail"].replace("999", str(mugs.other_shape_id))


def test_meshes_of_foreign_shapes_are_not_found(annotator, operator, mugs) -> None:
    mesh_hash = mugs.meshes["a.off"].content_hash()  # the other collection's shape has the same mesh
    path = f"/meshes/{mesh_hash}"
    assert operator.get(path, params={"shape_id": mugs.other_shape_id}).status_code == 200
    assert annotator.get(path, params={"shape_id": mugs.other_shape_id}).status_code == 404
    assert annotator.get(path, params={"shape_id": mugs.ids["a.off"]}).status_code == 200


def test_a_mesh_of_another_shape_is_not_found(annotator, mugs) -> None:
    mesh_hash = mugs.meshes["b.off"].content_hash()
    assert annotator.get(f"/meshes/{mesh_hash}", params={"shape_id": mugs.ids["a.off"]}).status_code == 404


@pytest.mark.parametrize("path", ["/audit", "/tokens"])
def test_what_concerns_all_collections_takes_a_token_for_all(issue, mugs, path) -> None:
    assert issue("olga", Role.ADMIN, (mugs.collection_id,)).get(path).status_code == 403


@pytest.mark.parametrize(
    ("method", "path"),
    [
        ("GET", "/people"),
        ("POST", "/people"),
        ("GET", "/tokens"),
        ("POST", "/tokens"),
        ("GET", "/audit"),
        ("DELETE", "/tokens/999"),
    ],
)
def test_annotators_do_not_run_the_service(annotator, method, path) -> None:
    body = {"/people": {"name": "bob"}, "/tokens": {"person_id": 1, "role": "admin"}}.get(path)
    assert annotator.request(method, path, json=body if method == "POST" else None).status_code == 403
