"""/collections/…/parts: versions, and what is refused."""

import json

import numpy as np
import pytest

from partwise.store.records import NewRevision, RevisionKind


def _path(mugs, ending: str = "") -> str:
    return f"/collections/{mugs.collection_id}/parts{ending}"


def test_parts_come_in_order_with_their_colours(annotator, mugs) -> None:
    shown = annotator.get(_path(mugs)).json()
    assert [(part["id"], part["name"]) for part in shown["parts"]] == [(1, "body"), (2, "handle")]
    assert shown["parts"][0]["colour"].startswith("#")


def test_adding_a_part_makes_the_next_version(reviewer, mugs) -> None:
    added = reviewer.post(_path(mugs), json={"name": "lid", "gloss": "on top"})
    assert (added.status_code, added.json()["version"], added.json()["parts"][-1]["id"]) == (201, 2, 3)
    assert [part["name"] for part in reviewer.get(_path(mugs), params={"version": 1}).json()["parts"]] == [
        "body",
        "handle",
    ]


def test_renaming_a_part_keeps_the_version(reviewer, mugs) -> None:
    changed = reviewer.patch(_path(mugs, "/2"), json={"name": "ear", "colour": "#102030"}).json()
    assert (changed["version"], changed["parts"][1]["name"], changed["parts"][1]["colour"]) == (1, "ear", "#102030")


def test_an_unused_part_can_be_removed(reviewer, mugs) -> None:
    assert [part["id"] for part in reviewer.delete(_path(mugs, "/2")).json()["parts"]] == [1]


def test_a_part_that_labels_use_cannot_be_removed(reviewer, mugs, workspace) -> None:
    catalog, shape_id = workspace.catalog, mugs.ids["a.off"]
    mesh = catalog.meshes([shape_id])[shape_id]
    author = catalog.add_person("eve")
    catalog.add_revision(NewRevision(shape_id, mesh.mesh_hash, RevisionKind.HUMAN, author.id, 1, np.full(4, 2)))
    assert reviewer.delete(_path(mugs, "/2")).status_code == 409


def test_a_name_is_taken_once(reviewer, mugs) -> None:
    answer = reviewer.post(_path(mugs), json={"name": "body"})
    assert (answer.status_code, answer.json()["type"]) == (409, "urn:partwise:problem:conflict")


@pytest.mark.parametrize(
    "body",
    [{}, {"name": ""}, {"name": "x" * 65}, {"name": "lid", "colour": "red"}, {"name": "lid", "id": 3}, {"name": 7}, []],
)
def test_what_is_no_part_is_refused(reviewer, mugs, body) -> None:
    assert reviewer.post(_path(mugs), json=body).status_code == 422


@pytest.mark.parametrize("gloss", ["\0", "\ud800", "x" * 2_001])
def test_text_that_cannot_be_kept_is_refused(reviewer, mugs, gloss) -> None:
    body = json.dumps({"name": "lid", "gloss": gloss})  # json escapes what no encoding has
    headers = {"Content-Type": "application/json"}
    assert reviewer.post(_path(mugs), content=body, headers=headers).status_code == 422


def test_a_version_that_never_was_is_not_found(annotator, mugs) -> None:
    assert annotator.get(_path(mugs), params={"version": 9}).status_code in (404, 422)


def test_annotators_change_no_parts(annotator, mugs) -> None:
    assert annotator.post(_path(mugs), json={"name": "lid"}).status_code == 403
    assert annotator.patch(_path(mugs, "/1"), json={"name": "lid"}).status_code == 403
    assert annotator.delete(_path(mugs, "/1")).status_code == 403


def test_changes_are_on_the_audit_trail(reviewer, mugs, workspace) -> None:
    reviewer.post(_path(mugs), json={"name": "lid"})
    newest = workspace.catalog.audit()[-1]
    assert (newest.actor, newest.action) == ("rita", "add part")
