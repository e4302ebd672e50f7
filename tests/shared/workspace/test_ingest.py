"""Ingest: copies of files and their rows; a bad file costs only itself."""

import hashlib
import os
from pathlib import Path

import numpy as np
import pytest

from partwise.errors import NotFoundError, StoreError
from partwise.io.write import write_mesh
from partwise.mesh import TriMesh
from partwise.store.records import Collection, RevisionKind
from partwise.testing.expect import raises
from partwise.testing.workspaces import publish_meshes
from partwise.workspace import ingest as module
from partwise.workspace.ingest import IngestReport, ingest_folder, mesh_files, source_object
from partwise.workspace.labelling import commit_labels
from partwise.workspace.progress import RunProgress
from partwise.workspace.workspace import Workspace


@pytest.fixture
def folder(tmp_path: Path, tetrahedron: TriMesh) -> Path:
    """a.off and sub/b.obj."""
    write_mesh(tetrahedron, tmp_path / "in" / "a.off")
    write_mesh(tetrahedron, tmp_path / "in" / "sub" / "b.obj")
    return tmp_path / "in"


def _keys(workspace: Workspace, collection: Collection) -> list[str]:
    return [shape.source_key for shape in workspace.catalog.shapes(collection.id)]


def test_shapes_are_known_by_their_relative_path(workspace: Workspace, collection: Collection, folder: Path) -> None:
    assert ingest_folder(workspace, collection, folder) == IngestReport(2, 0, 0, ())
    assert _keys(workspace, collection) == ["a.off", "sub/b.obj"]


def test_the_file_is_copied_as_it_is(workspace: Workspace, collection: Collection, folder: Path) -> None:
    ingest_folder(workspace, collection, folder)
    shape = workspace.catalog.shape_by_key(collection.id, "a.off")
    data = (folder / "a.off").read_bytes()
    assert shape.source_hash == hashlib.sha256(data).hexdigest()
    assert workspace.arrays.get_bytes(source_object(shape.source_hash, shape.source_suffix)) == data


def test_a_second_time_changes_nothing(workspace: Workspace, collection: Collection, folder: Path) -> None:
    ingest_folder(workspace, collection, folder)
    before = workspace.catalog.shapes(collection.id)
    assert ingest_folder(workspace, collection, folder) == IngestReport(0, 2, 0, ())
    assert workspace.catalog.shapes(collection.id) == before


def test_new_files_are_added(workspace: Workspace, collection: Collection, folder: Path, tetrahedron: TriMesh) -> None:
    ingest_folder(workspace, collection, folder)
    write_mesh(tetrahedron, folder / "c.ply")
    assert ingest_folder(workspace, collection, folder) == IngestReport(1, 2, 0, ())


def test_a_changed_file_is_ingested_again(workspace: Workspace, collection: Collection, folder: Path) -> None:
    ingest_folder(workspace, collection, folder)
    (folder / "a.off").write_bytes((folder / "a.off").read_bytes() + b"# a remark\n")
    assert ingest_folder(workspace, collection, folder) == IngestReport(0, 1, 1, ())


def test_a_labelled_shape_keeps_its_file(
    workspace: Workspace, collection: Collection, folder: Path, tetrahedron: TriMesh
) -> None:
    ingest_folder(workspace, collection, folder)
    shape = workspace.catalog.shape_by_key(collection.id, "a.off")
    publish_meshes(workspace, {shape.id: tetrahedron})
    commit_labels(workspace, collection, shape, np.array([1, 1, 1, 2], dtype=np.uint16), RevisionKind.HUMAN, "ann")
    shape = workspace.catalog.shape(shape.id)
    (folder / "a.off").write_bytes(b"something else")
    report = ingest_folder(workspace, collection, folder)
    assert (report.n_unchanged, report.n_changed) == (1, 0)
    assert report.refused[0].reason.startswith("a.off: a labelled shape's file must stay as it is")
    assert workspace.catalog.shape(shape.id) == shape


def test_equal_files_share_one_copy(
    workspace: Workspace, collection: Collection, folder: Path, tetrahedron: TriMesh
) -> None:
    (folder / "again.off").write_bytes((folder / "a.off").read_bytes())
    ingest_folder(workspace, collection, folder)
    assert len(workspace.arrays.list("sources")) == 2


@pytest.mark.parametrize(
    ("name", "data", "words"),
    [
        ("empty.off", b"", "empty"),
        ("blank.off", b" \n\t\n", "empty"),
        ("line\nbreak.off", b"OFF", "printable"),
        (os.fsdecode(b"caf\xe9.off"), b"OFF", "UTF-8"),
    ],
)
def test_a_refused_file_costs_only_itself(
    workspace: Workspace, collection: Collection, folder: Path, name: str, data: bytes, words: str
) -> None:
    (folder / name).write_bytes(data)
    report = ingest_folder(workspace, collection, folder)
    assert report.n_added == 2
    (refused,) = report.refused
    assert words in refused.reason
    assert "\n" not in refused.reason


def test_a_file_over_the_limit_is_refused(
    workspace: Workspace, collection: Collection, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with (folder / "huge.stl").open("wb") as file:
        file.truncate(2**40)  # sparse: takes no room
    report = ingest_folder(workspace, collection, folder)
    assert report.n_added == 2
    assert "huge.stl" in report.refused[0].reason


def test_files_come_in_order_of_their_paths(tmp_path: Path) -> None:
    for name in ("b/z.off", "b.off", "a/c/x.stl", "a/c.ply", "a.off", "B.off", "a-b/y.off"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).touch()
    assert list(mesh_files(tmp_path)) == sorted(path for path in tmp_path.rglob("*") if path.is_file())


def test_links_and_hidden_files_are_passed_over(tmp_path: Path, folder: Path) -> None:
    (folder / "link.off").symlink_to(folder / "a.off")
    (folder / ".hidden.off").write_bytes(b"OFF")
    (folder / ".git").mkdir()
    (folder / ".git" / "x.off").write_bytes(b"OFF")
    (folder / "notes.txt").write_text("no mesh")
    (folder / "folder.off").mkdir()
    assert [path.relative_to(folder).as_posix() for path in mesh_files(folder)] == ["a.off", "sub/b.obj"]


def test_suffixes_may_be_upper_case(tmp_path: Path, workspace: Workspace, collection: Collection, folder: Path) -> None:
    (folder / "a.off").rename(folder / "A.OFF")
    ingest_folder(workspace, collection, folder)
    assert workspace.catalog.shape_by_key(collection.id, "A.OFF").source_suffix == ".off"


def test_the_workspaces_own_copies_are_not_ingested(
    path: Path, workspace: Workspace, collection: Collection, tetrahedron: TriMesh
) -> None:
    write_mesh(tetrahedron, path.parent / "a.off")
    for _ in range(2):
        ingest_folder(workspace, collection, path.parent)
    assert _keys(workspace, collection) == ["a.off"]


def test_a_missing_folder_is_named(workspace: Workspace, collection: Collection, tmp_path: Path) -> None:
    with raises(NotFoundError, str(tmp_path / "missing"), "check the path"):
        ingest_folder(workspace, collection, tmp_path / "missing")


def test_a_folder_without_meshes_names_the_formats(
    workspace: Workspace, collection: Collection, tmp_path: Path
) -> None:
    (tmp_path / "none").mkdir()
    with raises(NotFoundError, ".glb", ".off", str(tmp_path / "none")):
        ingest_folder(workspace, collection, tmp_path / "none")


def test_rows_are_committed_in_batches(
    workspace: Workspace, collection: Collection, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "BATCH", 1)
    assert ingest_folder(workspace, collection, folder).n_added == 2


def test_a_full_store_leaves_no_row_without_its_file(
    workspace: Workspace, collection: Collection, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(self: Path, *_: object, **__: object) -> None:
        raise OSError(28, "No space left on device", str(self))

    with monkeypatch.context() as disk:
        disk.setattr(os, "fsync", full)
        with raises(StoreError, "no room", "free some space"):
            ingest_folder(workspace, collection, folder)
    assert _keys(workspace, collection) == []
    assert workspace.arrays.list("sources") == []
    assert ingest_folder(workspace, collection, folder).n_added == 2


def test_progress_is_told_after_each_file(workspace: Workspace, collection: Collection, folder: Path) -> None:
    (folder / "empty.off").touch()
    told: list[RunProgress] = []
    report = ingest_folder(workspace, collection, folder, told.append)
    n_files = report.n_added + 1
    assert [run.n_done + run.n_failed for run in told] == list(range(1, n_files + 1))
    assert told[-1] == RunProgress(report.n_added, 1, n_files)
