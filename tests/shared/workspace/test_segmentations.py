"""Labels by where they come from, always on the shape's present mesh."""

import numpy as np
import pytest

from partwise.mesh import TriMesh
from partwise.store.records import NewRevision, RevisionKind
from partwise.store.reviews import RevisionOrigin
from partwise.testing.workspaces import publish_meshes
from partwise.workspace.choices import Segmentation
from partwise.workspace.labelling import commit_labels
from partwise.workspace.relabel import MIN_AGREEMENT
from partwise.workspace.segmentations import reference_labels, segment, segmented_shapes
from partwise.workspace.shapes import shape_mesh

LABELS = np.array([1, 1, 2, 0], dtype=np.uint16)


def _commit(filled, key: str, kind: RevisionKind) -> None:
    commit_labels(filled.workspace, filled.collection, filled.shape(key), LABELS, kind, "ann")


def _segmented(filled, segmentation: Segmentation):
    return {each.shape.source_key: each for each in segmented_shapes(filled.workspace, filled.collection, segmentation)}


@pytest.mark.parametrize("segmentation", list(Segmentation))
def test_nothing_is_segmented_at_first(filled, segmentation: Segmentation) -> None:
    assert _segmented(filled.preprocessed(), segmentation) == {}


@pytest.mark.parametrize("kind", [RevisionKind.HUMAN, RevisionKind.IMPORTED])
def test_confirmed_labels_are_those_of_people(filled, kind: RevisionKind) -> None:
    _commit(filled.preprocessed(), "a.off", kind)
    found = _segmented(filled, Segmentation.CONFIRMED)
    assert list(found) == ["a.off"]
    assert np.array_equal(found["a.off"].labels, LABELS)
    assert found["a.off"].model_version is None


def test_reference_labels_are_never_shown(filled) -> None:
    _commit(filled.preprocessed(), "a.off", RevisionKind.REFERENCE)
    assert _segmented(filled, Segmentation.CONFIRMED) == {}
    assert np.array_equal(
        reference_labels(filled.workspace, shape_mesh(filled.workspace, filled.shape("a.off"))), LABELS
    )


@pytest.mark.parametrize(("agreement", "is_truth"), [(MIN_AGREEMENT, True), (MIN_AGREEMENT - 0.001, False)])
def test_ground_truth_that_suffered_on_the_way_is_none(filled, agreement: float, is_truth: bool) -> None:
    _commit(filled.preprocessed(), "a.off", RevisionKind.REFERENCE)
    shape, catalog = filled.shape("a.off"), filled.workspace.catalog
    head = catalog.head_revision(shape.id, (RevisionKind.REFERENCE,))
    origin = RevisionOrigin(head.mesh_hash, head.id, agreement)
    catalog.add_revision(
        NewRevision(shape.id, head.mesh_hash, head.kind, head.author_id, 1, LABELS, parent_id=head.id, origin=origin)
    )
    assert (reference_labels(filled.workspace, shape_mesh(filled.workspace, shape)) is not None) == is_truth


def test_a_shape_without_ground_truth_has_none(filled) -> None:
    filled.preprocessed()
    assert reference_labels(filled.workspace, shape_mesh(filled.workspace, filled.shape("a.off"))) is None


def test_predicted_labels_are_the_likeliest_parts(filled) -> None:
    model = filled.described().evaluated()
    found = _segmented(filled, Segmentation.PREDICTED)
    assert sorted(found) == ["a.off", "b.off", "sub/c.off"]
    assert found["b.off"].labels.tolist() == [1] * 16
    assert found["b.off"].model_version == model.version


def test_refined_labels_are_those_of_the_cut(filled) -> None:
    model = filled.described().evaluated()
    filled.refined(model)
    found = _segmented(filled, Segmentation.REFINED)
    assert found["b.off"].labels.tolist() == [2] * 16
    assert found["b.off"].labels.dtype == np.uint16


@pytest.mark.parametrize("n_faces_differ", [False, True])
def test_labels_of_an_older_mesh_are_left_out(filled, tetrahedron: TriMesh, n_faces_differ: bool) -> None:
    filled.described()
    _commit(filled, "a.off", RevisionKind.HUMAN)
    filled.refined(filled.evaluated())
    faces = tetrahedron.faces[:3] if n_faces_differ else tetrahedron.faces
    publish_meshes(filled.workspace, {filled.ids["a.off"]: TriMesh(tetrahedron.vertices + 1, faces)}, key="mesh-2")
    for segmentation in Segmentation:
        assert "a.off" not in _segmented(filled, segmentation)


def test_shapes_come_in_the_order_asked_for(filled) -> None:
    filled.described().evaluated()
    shapes = [filled.shape(key) for key in ("sub/c.off", "a.off")]
    assert [each.shape for each in segment(filled.workspace, shapes, Segmentation.PREDICTED)] == shapes
