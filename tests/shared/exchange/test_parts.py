"""The part table: a tree with distinct ids and names; labels and provenance that fit it."""

import dataclasses

import numpy as np
import pytest

from partwise.errors import FileFormatError, LabelError, ParameterError
from partwise.exchange.described_json import (
    load_json,
    parts_document,
    parts_from_document,
    provenance_document,
    provenance_from_document,
)
from partwise.exchange.labelled_mesh import DescribedMesh, LabelledMesh, Provenance
from partwise.exchange.parts import PartEntry, PartTable
from partwise.mesh import TriMesh

BASE = PartEntry(1, "base", "#010203", "what it stands on")
LEG = PartEntry(4, "leg", "#ff0000", parent_id=1)
TABLE = PartTable(2, (BASE, LEG))
MESH = TriMesh(np.eye(3), np.array([[0, 1, 2], [2, 1, 0]]))
PROVENANCE = Provenance("a.off", "0" * 64, "predicted", 3, "0.1")


def test_colours_are_bytes():
    assert TABLE.colours() == {1: (1, 2, 3), 4: (255, 0, 0)}


@pytest.mark.parametrize(
    ("version", "parts", "message"),
    [
        (-1, (), "not be negative"),
        (1, (BASE, dataclasses.replace(LEG, id=1, parent_id=None)), "ids must be distinct"),
        (1, (BASE, dataclasses.replace(LEG, name="base")), "names must be distinct"),
        (1, (LEG,), "but 1 is none of"),
        (1, (dataclasses.replace(BASE, parent_id=1),), "above itself"),
        (1, (dataclasses.replace(BASE, parent_id=4), LEG), "above itself"),
        (
            1,
            (BASE, LEG, PartEntry(7, "x", "#000000", parent_id=8), PartEntry(8, "y", "#000000", parent_id=7)),
            "itself",
        ),
    ],
)
def test_a_table_refuses(version, parts, message):
    with pytest.raises(ParameterError, match=message):
        PartTable(version, parts)


def test_labels_are_ids_or_minus_one():
    TABLE.check_labels(np.array([1, -1, 4]))
    with pytest.raises(LabelError, match="face 2 has 3"):
        TABLE.check_labels(np.array([1, 4, 3]))


def test_a_described_mesh_has_labels_of_its_schema():
    with pytest.raises(LabelError, match="face 1 has 2"):
        DescribedMesh(LabelledMesh(MESH, np.array([1, 2])), TABLE)


def test_labels_are_only_for_their_mesh():
    labelled = LabelledMesh(MESH, np.array([1, 4]))
    assert labelled.labels_on(TriMesh(MESH.vertices, MESH.faces)).tolist() == [1, 4]
    with pytest.raises(LabelError, match="of mesh"):
        labelled.labels_on(TriMesh(2 * MESH.vertices, MESH.faces))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"source_hash": "0" * 63}, "SHA-256"),
        ({"kind": "guessed"}, "kind of labels"),
        ({"kind": "human"}, "must name their model"),
        ({"model_version": None}, "must name their model"),
    ],
)
def test_provenance_refuses(changes, message):
    with pytest.raises(ParameterError, match=message):
        dataclasses.replace(PROVENANCE, **changes)


def test_json_and_back():
    assert parts_from_document(parts_document(TABLE)) == TABLE
    assert provenance_from_document(provenance_document(PROVENANCE)) == PROVENANCE
    assert provenance_from_document(provenance_document(None)) is None


@pytest.mark.parametrize(
    ("document", "message"),
    [
        ([], "must have the fields"),
        ({"version": 1}, "must have the fields"),
        ({"version": "1", "parts": []}, "version of the schema"),
        ({"version": True, "parts": []}, "version of the schema"),
        ({"version": 1, "parts": [7]}, "a part must have the fields"),
        ({"version": 1, "parts": [parts_document(TABLE)["parts"][1]]}, "parent of 'leg'"),
        ({"version": 1, "parts": [{**parts_document(TABLE)["parts"][0], "colour": "red"}]}, "colour"),
    ],
)
def test_documents_that_are_no_schema(document, message):
    with pytest.raises(FileFormatError, match=message):
        parts_from_document(document)


@pytest.mark.parametrize("changes", [{"kind": "guessed"}, {"kind": 7}, {"more": 1}])
def test_documents_that_are_no_provenance(changes):
    with pytest.raises(FileFormatError):
        provenance_from_document({**provenance_document(PROVENANCE), **changes})


@pytest.mark.parametrize("text", ["{", "[" * 100_000])
def test_what_is_no_json(text):
    with pytest.raises(FileFormatError, match="must be JSON"):
        load_json(text, "it")
