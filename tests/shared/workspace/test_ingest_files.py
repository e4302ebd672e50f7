"""Ingest of a mesh or an archive that nobody vouches for."""

import tarfile
import zipfile
from dataclasses import replace

import pytest

from partwise.config import MeshConfig
from partwise.errors import FileFormatError
from partwise.io.off import format_off
from partwise.testing.meshes import subdivided
from partwise.workspace import ingest as module
from partwise.workspace.ingest_files import ingest_file


@pytest.fixture
def mesh(tetrahedron) -> bytes:
    return format_off(tetrahedron)


def zipped(path, files):
    with zipfile.ZipFile(path, "w") as made:
        for name, data in files.items():
            made.writestr(name, data)
    return path


def keys(workspace, collection):
    return [shape.source_key for shape in workspace.catalog.shapes(collection.id)]


def test_an_archives_meshes_are_known_by_their_paths_in_it(workspace, collection, tmp_path, mesh) -> None:
    path = zipped(tmp_path / "a.zip", {"a.off": mesh, "sub/b.off": mesh, "notes.txt": b"x"})
    report = ingest_file(workspace, collection, path)
    assert (report.n_added, report.refused) == (2, ())
    assert keys(workspace, collection) == ["a.off", "sub/b.off"]
    assert ingest_file(workspace, collection, path).n_unchanged == 2


def test_a_mesh_is_known_by_its_name(workspace, collection, tmp_path, mesh) -> None:
    (tmp_path / "a.off").write_bytes(mesh)
    assert ingest_file(workspace, collection, tmp_path / "a.off").n_added == 1
    assert keys(workspace, collection) == ["a.off"]


def test_bad_members_are_named_and_the_rest_goes_on(workspace, collection, tmp_path, mesh) -> None:
    files = {"a.off": mesh, "../b.off": mesh, "c.off": b"no mesh", "d.off": b" ", "e.obj": b"\x80\x04pickle"}
    report = ingest_file(workspace, collection, zipped(tmp_path / "a.zip", files))
    assert report.n_added == 1
    assert [each.source_key for each in report.refused] == ["../b.off", "c.off", "d.off", "e.obj"]
    assert all(each.reason.startswith(f"{each.source_key}: ") for each in report.refused)
    assert keys(workspace, collection) == ["a.off"]


def test_what_has_too_many_faces_is_refused(workspace, collection, tmp_path, tetrahedron, mesh) -> None:
    small = replace(workspace, config=replace(workspace.config, mesh=MeshConfig(max_faces=4)))
    files = {"a.off": mesh, "b.off": format_off(subdivided(tetrahedron))}
    report = ingest_file(small, collection, zipped(tmp_path / "a.zip", files))
    assert report.n_added == 1
    assert "4 faces" in report.refused[0].reason


def test_what_came_before_damage_stays(workspace, collection, tmp_path, mesh, monkeypatch) -> None:
    monkeypatch.setattr(module, "BATCH", 1)
    path = tmp_path / "a.tar.gz"
    (tmp_path / "m.off").write_bytes(mesh)
    (tmp_path / "bomb.off").write_bytes(bytes(8 << 20))
    with tarfile.open(path, "w:gz") as made:
        made.add(tmp_path / "m.off", "a.off")
        made.add(tmp_path / "bomb.off", "bomb.off")
    report = ingest_file(workspace, collection, path)
    assert (report.n_added, [each.source_key for each in report.refused]) == (1, ["a.tar.gz"])


@pytest.mark.parametrize("files", [{"notes.txt": b"x"}, {"a.off": b"no mesh", "b.off": b"nor this"}])
def test_an_archive_of_which_nothing_can_be_taken_fails(workspace, collection, tmp_path, files) -> None:
    with pytest.raises(FileFormatError, match=r"a\.zip"):
        ingest_file(workspace, collection, zipped(tmp_path / "a.zip", files))
