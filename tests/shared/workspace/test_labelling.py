"""Committing labels: immutable revisions on kept meshes; a wrong file costs only itself."""

from pathlib import Path

import numpy as np
import pytest

from partwise.errors import ConflictError, FileFormatError, LabelError, NotFoundError, StoreError
from partwise.labels.schema import PartSchema
from partwise.mesh import TriMesh
from partwise.store.meshes import kept_mesh_key
from partwise.store.records import RevisionKind, ShapeState
from partwise.testing.expect import raises
from partwise.testing.workspaces import publish_meshes
from partwise.workspace.labelling import commit_labels, import_labels, keep_mesh, person_id, read_labels
from partwise.workspace.shapes import shape_mesh

LABELS = np.array([1, 1, 2, 0], dtype=np.uint16)
PSB = "body\n1 2\nhandle\n3\n"
SEG = "1\n1\n2\n0\n"


@pytest.fixture
def schema(filled) -> PartSchema:
    return filled.workspace.catalog.parts(filled.collection.id)


# One label file


@pytest.mark.parametrize(("name", "text"), [("a_labels.txt", PSB), ("a.seg", SEG), ("a.seg", "1 1 2 -1")])
def test_label_files_are_read_as_part_ids(tmp_path: Path, schema: PartSchema, name: str, text: str) -> None:
    (tmp_path / name).write_text(text)
    labels = read_labels(tmp_path / name, 4, schema)
    assert labels.dtype == np.uint16
    assert labels.tolist() == [1, 1, 2, 0]


@pytest.mark.parametrize(
    ("name", "text", "kind", "words"),
    [
        ("missing.seg", None, FileFormatError, "readable"),
        ("a.seg", "", FileFormatError, "empty"),
        ("a.seg", "1\nx\n", FileFormatError, "x"),
        ("a.seg", "1\n1\n", LabelError, "4 faces"),
        ("a.seg", "1\n1\n1\n1\n1\n", LabelError, "4 faces"),
        ("a.seg", "1\n1\n2\n7\n", LabelError, "part id 7"),
        ("a.seg", "1\n1\n2\n65537\n", LabelError, "part id 65537"),
        ("a_labels.txt", "body\n1 2\nhandel\n3\n", LabelError, "did you mean 'handle'"),
        ("a_labels.txt", "body\n1 9\n", LabelError, "face 9"),
        ("a_labels.txt", "body\n1 nan\n", LabelError, "nan"),
        ("a_labels.txt", "body\n1 2\nhandle\n2\n", LabelError, "face 2"),
    ],
)
def test_a_wrong_label_file_is_named(
    tmp_path: Path, schema: PartSchema, name: str, text: str | None, kind: type[Exception], words: str
) -> None:
    if text is not None:
        (tmp_path / name).write_text(text)
    with raises(kind, str(tmp_path / name), words):
        read_labels(tmp_path / name, 4, schema)


# Commits


def _commit(filled, labels=LABELS, kind: RevisionKind = RevisionKind.HUMAN, author: str = "ann", key: str = "a.off"):
    return commit_labels(filled.workspace, filled.collection, filled.shape(key), labels, kind, author)


def test_committed_labels_come_back(filled) -> None:
    filled.preprocessed()
    revision = _commit(filled)
    assert np.array_equal(filled.workspace.catalog.labels(revision.id), LABELS)
    assert revision.kind is RevisionKind.HUMAN
    assert filled.workspace.catalog.get_person("ann").id == revision.author_id


@pytest.mark.parametrize("kind", [RevisionKind.HUMAN, RevisionKind.IMPORTED])
def test_the_mesh_of_shown_labels_is_kept(filled, kind: RevisionKind) -> None:
    filled.preprocessed()
    revision = _commit(filled, kind=kind)
    mesh = shape_mesh(filled.workspace, filled.shape("a.off"))
    assert mesh.kept_key == kept_mesh_key(revision.mesh_hash)
    assert filled.workspace.arrays.exists(mesh.kept_key)


def test_the_mesh_of_reference_labels_is_not_kept(filled) -> None:
    filled.preprocessed()
    _commit(filled, kind=RevisionKind.REFERENCE)
    assert shape_mesh(filled.workspace, filled.shape("a.off")).kept_key is None


def test_reference_labels_confirm_nothing(filled) -> None:
    filled.described()
    _commit(filled, kind=RevisionKind.REFERENCE)
    states = filled.workspace.catalog.shape_states([filled.ids["a.off"]])
    assert states[filled.ids["a.off"]] is ShapeState.READY


def test_keeping_a_mesh_twice_is_keeping_it_once(filled) -> None:
    filled.preprocessed()
    for _ in range(2):
        keep_mesh(filled.workspace, shape_mesh(filled.workspace, filled.shape("a.off")))
    assert len(filled.workspace.arrays.list("kept/meshes")) == 1


def test_the_mesh_is_kept_before_labels_are_committed(filled, monkeypatch: pytest.MonkeyPatch) -> None:
    filled.preprocessed()
    monkeypatch.setattr(filled.workspace.arrays, "put_bytes", _full)
    with pytest.raises(StoreError):
        _commit(filled)
    assert list(filled.workspace.catalog.revisions(filled.ids["a.off"])) == []


def _full(key: str, data: bytes) -> None:
    raise StoreError(f"no room for {key}; free some space")


def test_the_same_labels_again_are_the_same_revision(filled) -> None:
    filled.preprocessed()
    assert _commit(filled) == _commit(filled, author="bob")


def test_other_labels_are_a_child_revision(filled) -> None:
    filled.preprocessed()
    first = _commit(filled)
    second = _commit(filled, np.array([2, 2, 2, 2], dtype=np.uint16))
    assert second.parent_id == first.id
    assert [revision.id for revision in filled.workspace.catalog.revisions(filled.ids["a.off"])] == [
        first.id,
        second.id,
    ]


def test_a_person_who_corrects_imported_labels_builds_on_them(filled) -> None:
    filled.preprocessed()
    imported = _commit(filled, kind=RevisionKind.IMPORTED)
    assert _commit(filled, np.array([2, 2, 2, 2], dtype=np.uint16)).parent_id == imported.id


def test_a_person_who_agrees_with_imported_labels_confirms_them(filled) -> None:
    filled.preprocessed()
    _commit(filled, kind=RevisionKind.IMPORTED)
    assert _commit(filled).kind is RevisionKind.HUMAN


def test_a_persons_labels_are_shown_even_if_they_said_so_before(filled) -> None:
    filled.preprocessed()
    _commit(filled)
    _commit(filled, np.array([2, 2, 2, 2], dtype=np.uint16), kind=RevisionKind.IMPORTED)
    again = _commit(filled)
    assert filled.workspace.catalog.head_revision(filled.ids["a.off"]) == again


def test_labels_on_a_newer_mesh_are_a_new_revision(filled, tetrahedron: TriMesh) -> None:
    filled.preprocessed()
    first = _commit(filled)
    moved = TriMesh(tetrahedron.vertices + 1, tetrahedron.faces)
    publish_meshes(filled.workspace, {filled.ids["a.off"]: moved}, key="mesh-2")
    second = _commit(filled)
    assert (second.parent_id, second.mesh_hash) == (first.id, moved.content_hash())


@pytest.mark.parametrize(
    ("labels", "words"), [([1, 1, 2], "3 labels for 4 faces"), ([1, 1, 2, 9], "part id 9"), ([[1, 1, 2, 2]], "shape")]
)
def test_labels_that_do_not_fit_are_refused(filled, labels: list[int], words: str) -> None:
    filled.preprocessed()
    with raises(LabelError, words):
        _commit(filled, np.array(labels, dtype=np.uint16))
    assert list(filled.workspace.catalog.revisions(filled.ids["a.off"])) == []


def test_a_shape_without_a_mesh_cannot_be_labelled(filled) -> None:
    with raises(ConflictError, "a.off", "partwise preprocess"):
        _commit(filled)


def test_a_person_is_added_once(filled) -> None:
    assert person_id(filled.workspace, "ann") == person_id(filled.workspace, "ann")
    assert [person.name for person in filled.workspace.catalog.list_people()] == ["ann"]


# Folders of label files


@pytest.fixture
def labels_folder(tmp_path: Path) -> Path:
    """Labels of a.off, 4 faces, and of sub/c.off, 4 faces; none of b.off."""
    folder = tmp_path / "labels"
    (folder / "sub").mkdir(parents=True)
    (folder / "a_labels.txt").write_text(PSB)
    (folder / "sub" / "c.seg").write_text(SEG)
    return folder


def _import(filled, folder: Path, kind: RevisionKind = RevisionKind.IMPORTED):
    return import_labels(filled.workspace, filled.collection, folder, kind, "import")


def test_a_folder_of_labels_is_imported(filled, labels_folder: Path) -> None:
    report = _import(filled.preprocessed(), labels_folder)
    assert (report.n_imported, report.n_unchanged, report.n_unlabelled, report.refused) == (2, 0, 1, ())
    for key in ("a.off", "sub/c.off"):
        head = filled.workspace.catalog.head_revision(filled.ids[key])
        assert np.array_equal(filled.workspace.catalog.labels(head.id), LABELS)


def test_a_second_import_changes_nothing(filled, labels_folder: Path) -> None:
    _import(filled.preprocessed(), labels_folder)
    report = _import(filled, labels_folder)
    assert (report.n_imported, report.n_unchanged) == (0, 2)
    assert len(filled.workspace.catalog.revisions(filled.ids["a.off"])) == 1


def test_reference_labels_are_imported_beside_the_others(filled, labels_folder: Path) -> None:
    _import(filled.preprocessed(), labels_folder)
    assert _import(filled, labels_folder, RevisionKind.REFERENCE).n_imported == 2


def test_a_wrong_file_costs_only_itself(filled, labels_folder: Path) -> None:
    (labels_folder / "sub" / "c.seg").write_text("1\n2\n")
    report = _import(filled.preprocessed(), labels_folder)
    assert report.n_imported == 1
    assert [refused.file for refused in report.refused] == [str(labels_folder / "sub" / "c.seg")]
    assert str(labels_folder / "sub" / "c.seg") in report.refused[0].reason


def test_labels_of_shapes_that_are_not_preprocessed_are_refused(filled, labels_folder: Path) -> None:
    report = _import(filled, labels_folder)
    assert report.n_imported == 0
    assert all("partwise preprocess" in refused.reason for refused in report.refused)
    assert all(refused.file in refused.reason for refused in report.refused)


def test_imported_labels_never_hide_a_persons(filled, labels_folder: Path) -> None:
    filled.preprocessed()
    mine = _commit(filled, np.array([2, 2, 2, 2], dtype=np.uint16))
    report = _import(filled, labels_folder)
    assert "a person confirmed" in report.refused[0].reason
    assert filled.workspace.catalog.head_revision(filled.ids["a.off"]) == mine


def test_labels_that_a_person_corrected_since_are_unchanged(filled, labels_folder: Path) -> None:
    _import(filled.preprocessed(), labels_folder)
    mine = _commit(filled, np.array([2, 2, 2, 2], dtype=np.uint16))
    assert _import(filled, labels_folder).n_unchanged == 2
    assert filled.workspace.catalog.head_revision(filled.ids["a.off"]) == mine


def test_a_full_store_ends_the_import(filled, labels_folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    filled.preprocessed()
    monkeypatch.setattr(filled.workspace.arrays, "put_bytes", _full)
    with pytest.raises(StoreError):
        _import(filled, labels_folder)


def test_importing_from_no_folder_is_refused(filled, tmp_path: Path) -> None:
    with raises(NotFoundError, str(tmp_path / "missing"), "check the path"):
        _import(filled, tmp_path / "missing")


def test_importing_from_a_folder_without_labels_says_what_they_are_called(filled, tmp_path: Path) -> None:
    (tmp_path / "none").mkdir()
    with raises(NotFoundError, "_labels.txt", ".seg", "none for the 3 shapes"):
        _import(filled, tmp_path / "none")
