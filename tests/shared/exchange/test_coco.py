"""COCO-style JSON beyond the suite: several shapes, what the fields hold, and files that contradict themselves."""

import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from partwise.errors import FileFormatError, LabelError, ParameterError
from partwise.exchange.coco import CocoDataset, CocoPart, CocoShape, coco_shape, read_coco, write_coco
from partwise.exchange.labelled_mesh import DescribedMesh, LabelledMesh
from partwise.exchange.run_lengths import mask_of, run_lengths
from partwise.testing.label_formats import labelled_strip, parts_named, with_labels

PARTS = parts_named("chair", "seat", "leg")
SHAPES = tuple(labelled_strip(n, PARTS, seed=n) for n in (7, 12))
HASH = "0" * 64


@pytest.fixture
def document(tmp_path):
    shapes = tuple(coco_shape(f"{k}.off", described) for k, described in enumerate(SHAPES))
    write_coco(tmp_path / "a.json", CocoDataset(PARTS, shapes))
    return json.loads((tmp_path / "a.json").read_text())


@given(st.lists(st.booleans(), max_size=30))
@settings(max_examples=60, deadline=None)
def test_runs_and_masks_are_the_same_thing(marked):
    mask = np.array(marked, dtype=bool)
    runs = run_lengths(mask)
    np.testing.assert_array_equal(mask_of(runs), mask)
    assert (runs[1:] > 0).all()  # only the first may be empty, as COCO's are


@pytest.mark.parametrize(
    ("mask", "runs"), [([0, 0, 1, 1, 0], [2, 2, 1]), ([1, 0], [0, 1, 1]), ([0, 0], [2]), ([1], [0, 1]), ([], [])]
)
def test_runs_begin_with_the_unmarked(mask, runs):
    assert run_lengths(np.array(mask, dtype=bool)).tolist() == runs


def test_every_shape_comes_back(tmp_path, document):
    found = read_coco(tmp_path / "a.json")
    assert found.parts == PARTS
    assert [shape.name for shape in found.shapes] == ["0.off", "1.off"]
    for shape, described in zip(found.shapes, SHAPES, strict=True):
        np.testing.assert_array_equal(shape.labels_on(described.mesh), described.labels)
        assert shape.provenance == described.provenance


def test_no_shapes_and_no_parts(tmp_path):
    write_coco(tmp_path / "a.json", CocoDataset(parts_named(), ()))
    assert read_coco(tmp_path / "a.json").shapes == ()


def test_a_category_names_its_parent(document):
    assert [(found["name"], found["supercategory"], found["parent_id"]) for found in document["categories"]] == [
        ("chair", "", None),
        ("seat", "chair", 1),
        ("leg", "", None),
    ]


def test_an_image_is_a_row_of_faces(document):
    assert [(found["width"], found["height"]) for found in document["images"]] == [(7, 1), (12, 1)]
    assert document["images"][0]["mesh_hash"] == SHAPES[0].mesh.content_hash()


def test_an_annotation_marks_a_parts_faces():
    mesh = SHAPES[0]
    part = coco_shape("a", with_labels(mesh, np.array([-1, 3, 3, -1, 3, -1, -1]))).parts[0]
    assert part.runs.tolist() == [1, 2, 1, 1, 2]


def test_annotations_say_area_and_box(tmp_path):
    described = with_labels(SHAPES[0], np.array([-1, 3, 3, -1, 3, -1, -1]))
    write_coco(tmp_path / "a.json", CocoDataset(PARTS, (coco_shape("a", described),)))
    (annotation,) = json.loads((tmp_path / "a.json").read_text())["annotations"]
    assert (annotation["area"], annotation["bbox"], annotation["iscrowd"]) == (3, [1, 0, 4, 1], 0)
    assert annotation["segmentation"]["size"] == [1, 7]


def test_shares_of_area_sum_to_one_where_all_is_labelled():
    described = with_labels(SHAPES[0], np.array([1, 3, 3, 5, 3, 1, 5]))
    assert sum(part.area_share for part in coco_shape("a", described).parts) == pytest.approx(1, abs=1e-8)


def test_a_mesh_without_area():
    flat = type(SHAPES[0].mesh)(np.zeros((3, 3)), np.array([[0, 1, 2]]))
    shape = coco_shape("a", DescribedMesh(LabelledMesh(flat, np.array([1])), PARTS))
    assert shape.parts[0].area_share == 0


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        (("", HASH, 1, ()), ParameterError, "a name and faces"),
        (("a", HASH, 0, ()), ParameterError, "a name and faces"),
        (("a", "x", 1, ()), ParameterError, "SHA-256"),
        (("a", HASH, 5_000_001, ()), FileFormatError, "5000000 faces"),
        (("a", HASH, 3, ([3],)), LabelError, "two or more"),
        (("a", HASH, 3, ([-1, 4],)), LabelError, "from 0 to its 3"),
        (("a", HASH, 3, ([0, 2**62, 2**62],)), LabelError, "from 0 to its 3"),
        (("a", HASH, 3, ([1, 1],)), LabelError, "cover its 3 faces but cover 2"),
        (("a", HASH, 3, ([1, 1, 1], [0, 2, 1])), LabelError, "face 1 of a has two"),
    ],
)
def test_a_shape_refuses(arguments, error, message):
    *rest, runs = arguments
    parts = tuple(CocoPart(k, np.array(found), 0.0) for k, found in enumerate(runs))
    with pytest.raises(error, match=message):
        CocoShape(*rest, parts)


def test_a_dataset_has_only_parts_of_its_schema():
    with pytest.raises(LabelError, match="has 7"):
        CocoDataset(PARTS, (CocoShape("a", HASH, 1, (CocoPart(7, np.array([0, 1]), 1.0),)),))


@pytest.mark.parametrize(
    ("place", "key", "value", "error", "message"),
    [
        (("info",), "format", "coco", FileFormatError, "images of pixels"),
        (("info",), "format_version", 2, FileFormatError, "must say"),
        (("info",), "schema_version", -1, FileFormatError, "schema version"),
        ((), "images", None, FileFormatError, "TypeError"),
        (("images", 1), "id", 1, FileFormatError, "comes twice"),
        (("images", 0), "n_faces", 8, LabelError, "cover its 8 faces"),
        (("images", 0), "n_faces", 10**12, FileFormatError, "5000000 faces"),
        (("images", 0), "mesh_hash", "?", FileFormatError, "SHA-256"),
        (("images", 0), "provenance", {}, FileFormatError, "the provenance"),
        (("categories", 1), "parent_id", 99, FileFormatError, "but 99 is none"),
        (("annotations", 0), "image_id", 9, FileFormatError, "KeyError"),
        (("annotations", 0), "category_id", 9, LabelError, "has 9"),
        (("annotations", 0, "segmentation"), "counts", "0b2", FileFormatError, "decompress"),
        (("annotations", 0, "segmentation"), "counts", [1.5, 5.5], FileFormatError, "whole numbers"),
        (("annotations", 0, "segmentation"), "counts", [2**70], FileFormatError, "OverflowError"),
    ],
)
def test_reading_refuses(document, place, key, value, error, message):
    found = document
    for step in place:
        found = found[step]
    found[key] = value
    with pytest.raises(error, match=message) as caught:
        read_coco("a.json", json.dumps(document).encode())
    assert str(caught.value).startswith("a.json: ")


def test_overlapping_annotations_are_refused(document):
    document["annotations"].append({**document["annotations"][0], "id": 99})
    with pytest.raises(LabelError, match="has two"):
        read_coco("a.json", json.dumps(document).encode())
