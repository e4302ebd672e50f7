"""Labels that say which mesh they are for: imported onto it, refused elsewhere."""

from pathlib import Path

import numpy as np
import pytest

from partwise.exchange.label_npz import write_npz
from partwise.exchange.labelled_mesh import DescribedMesh, LabelledMesh
from partwise.exchange.labelled_points import LabelledPoints, sample_labelled_points, write_points
from partwise.exchange.parts import PartEntry, PartTable
from partwise.mesh import TriMesh
from partwise.store.records import RevisionKind
from partwise.workspace.labelling import import_labels

LABELS = np.array([1, 1, 2, -1])
# Ids differ from the collection's; names decide.
PARTS = PartTable(
    9, (PartEntry(2, "body", "#000000"), PartEntry(1, "handle", "#ffffff"), PartEntry(5, "lid", "#00ff00"))
)


@pytest.fixture
def meshed(filled):
    filled.preprocessed()
    return filled


def _import(filled, folder: Path):
    return import_labels(filled.workspace, filled.collection, folder, RevisionKind.IMPORTED, "import")


def _labels(filled, key: str) -> list[int]:
    catalog = filled.workspace.catalog
    head = catalog.head_revision(filled.shape(key).id)
    return catalog.labels(head.id).tolist()


def _points(filled, key: str, labels=LABELS) -> LabelledPoints:
    return sample_labelled_points(LabelledMesh(filled.meshes[key], labels), 800, np.random.default_rng(1))


def test_npz_parts_go_by_name(meshed, tmp_path: Path) -> None:
    write_npz(tmp_path / "a.npz", DescribedMesh(LabelledMesh(meshed.meshes["a.off"], LABELS), PARTS))
    assert _import(meshed, tmp_path).n_imported == 1
    assert _labels(meshed, "a.off") == [2, 2, 1, 0]


def test_an_npz_of_another_mesh_is_refused(meshed, tmp_path: Path) -> None:
    mesh = meshed.meshes["a.off"]
    other = TriMesh(mesh.vertices * 2, mesh.faces)
    write_npz(tmp_path / "a.npz", DescribedMesh(LabelledMesh(other, LABELS), PARTS))
    (refused,) = _import(meshed, tmp_path).refused
    assert "none of them" in refused.reason


def test_an_npz_with_a_part_that_the_schema_lacks_is_refused(meshed, tmp_path: Path) -> None:
    labels = np.array([5, 1, 2, -1])
    write_npz(tmp_path / "a.npz", DescribedMesh(LabelledMesh(meshed.meshes["a.off"], labels), PARTS))
    (refused,) = _import(meshed, tmp_path).refused
    assert "'lid'" in refused.reason


def test_points_label_the_faces_they_lie_on(meshed, tmp_path: Path) -> None:
    write_points(tmp_path / "a.txt", _points(meshed, "a.off"))
    assert _import(meshed, tmp_path).n_imported == 1
    assert _labels(meshed, "a.off") == [1, 1, 2, 0]


def test_normalised_points_are_fitted(meshed, tmp_path: Path) -> None:
    points = _points(meshed, "a.off")
    write_points(tmp_path / "a.txt", LabelledPoints(points.points * 0.1 + 3, points.normals, points.labels))
    _import(meshed, tmp_path)
    assert _labels(meshed, "a.off") == [1, 1, 2, 0]


def test_a_pair_of_files_is_not_taken_for_labels_of_faces(meshed, tmp_path: Path) -> None:
    points = _points(meshed, "a.off")
    np.savetxt(tmp_path / "a.pts", points.points)
    np.savetxt(tmp_path / "a.seg", points.labels, fmt="%d")
    _import(meshed, tmp_path)
    assert _labels(meshed, "a.off") == [1, 1, 2, 0]


@pytest.mark.parametrize("stranger", [0, 12])
def test_numbers_that_are_no_part_are_refused(meshed, tmp_path: Path, stranger: int) -> None:
    """0 is a part in ShapeNetPart, so that it is not taken for unlabelled."""
    write_points(tmp_path / "a.txt", _points(meshed, "a.off", np.array([1, 1, 2, stranger])))
    (refused,) = _import(meshed, tmp_path).refused
    assert refused.reason.startswith(str(tmp_path / "a.txt"))
    assert f"one is {stranger}" in refused.reason


def test_points_of_another_shape_are_refused(meshed, tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    points = LabelledPoints(rng.standard_normal((500, 3)), np.zeros((500, 3)), np.ones(500, dtype=np.int64))
    write_points(tmp_path / "a.txt", points)
    (refused,) = _import(meshed, tmp_path).refused
    assert "another mesh" in refused.reason
