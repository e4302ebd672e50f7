"""Export: files and a manifest that verifies, whole or not at all."""

import os
from pathlib import Path

import numpy as np
import pytest

from partwise.errors import ConflictError, NotFoundError, ParameterError, StoreError
from partwise.exchange.coco import read_coco
from partwise.exchange.export_manifest import damaged_files, read_manifest
from partwise.exchange.glb_parts import read_glb_parts
from partwise.exchange.label_npz import read_npz
from partwise.exchange.labelled_points import read_points
from partwise.exchange.ply_labels import read_ply_labels
from partwise.exchange.seg import read_seg
from partwise.store.records import RevisionKind
from partwise.testing.expect import raises
from partwise.testing.workspaces import ingest, publish_meshes
from partwise.workspace.choices import ExportFormat, PointSampling, Segmentation
from partwise.workspace.export import MANIFEST, export_labels
from partwise.workspace.export_files import ENDINGS
from partwise.workspace.labelling import commit_labels, import_labels

LABELS = np.array([1, 1, 2, 0], dtype=np.uint16)


@pytest.fixture
def confirmed(filled):
    """a.off and sub/c.off are confirmed, b.off is not."""
    filled.preprocessed()
    for key in ("a.off", "sub/c.off"):
        commit_labels(filled.workspace, filled.collection, filled.shape(key), LABELS, RevisionKind.HUMAN, "ann")
    return filled


def _export(
    filled,
    out: Path,
    segmentation: Segmentation = Segmentation.CONFIRMED,
    file_format: ExportFormat = ExportFormat.SEG,
):
    return export_labels(filled.workspace, filled.collection, segmentation, file_format, out)


def _files(out: Path) -> list[str]:
    return sorted(path.relative_to(out).as_posix() for path in out.rglob("*") if path.is_file())


def test_each_shape_gets_a_file_where_its_source_was(confirmed, tmp_path: Path) -> None:
    report = _export(confirmed, tmp_path / "out")
    assert _files(tmp_path / "out") == ["a.seg", MANIFEST, "sub/c.seg"]
    assert (report.n_written, report.n_without, report.manifest) == (2, 1, tmp_path / "out" / MANIFEST)


def test_seg_files_hold_part_ids_and_minus_one_for_none(confirmed, tmp_path: Path) -> None:
    _export(confirmed, tmp_path)
    assert read_seg(tmp_path / "a.seg", 4).tolist() == [1, 1, 2, -1]


def test_ply_files_hold_the_mesh_and_the_labels(confirmed, tmp_path: Path) -> None:
    _export(confirmed, tmp_path, file_format=ExportFormat.PLY)
    labelled = read_ply_labels(tmp_path / "a.ply")
    assert labelled.labels.tolist() == [1, 1, 2, -1]
    assert labelled.mesh.content_hash() == confirmed.meshes["a.off"].content_hash()


@pytest.mark.parametrize(("file_format", "read"), [(ExportFormat.GLB, read_glb_parts), (ExportFormat.NPZ, read_npz)])
def test_glb_and_npz_files_say_what_they_are(confirmed, tmp_path: Path, file_format: ExportFormat, read) -> None:
    _export(confirmed, tmp_path, file_format=file_format)
    found = read(tmp_path / f"a.{file_format}")
    assert found.labelled.labels_on(confirmed.meshes["a.off"]).tolist() == [1, 1, 2, -1]
    assert found.parts.names == ("body", "handle")
    assert (found.provenance.source_key, found.provenance.kind) == ("a.off", "human")


def test_coco_is_one_file_for_all_shapes(confirmed, tmp_path: Path) -> None:
    _export(confirmed, tmp_path / "out", file_format=ExportFormat.COCO)
    assert _files(tmp_path / "out") == ["coco.json", MANIFEST]
    found = read_coco(tmp_path / "out/coco.json")
    assert [shape.name for shape in found.shapes] == ["a.off", "sub/c.off"]
    assert found.shapes[0].labels_on(confirmed.meshes["a.off"]).tolist() == [1, 1, 2, -1]


def test_points_are_drawn_as_the_manifest_says(confirmed, tmp_path: Path) -> None:
    for out in ("one", "two"):
        export_labels(
            confirmed.workspace,
            confirmed.collection,
            Segmentation.CONFIRMED,
            ExportFormat.SHAPENETPART,
            tmp_path / out,
            sampling=PointSampling(40, seed=7),
        )
    manifest = read_manifest(tmp_path / "one" / MANIFEST)
    assert (manifest.parameters["n_points"], manifest.parameters["seed"]) == (40, 7)
    points = read_points(tmp_path / "one/sub/c.txt")
    assert len(points.labels) == 40
    assert set(points.labels.tolist()) <= {1, 2, -1}
    assert (tmp_path / "one/a.txt").read_bytes() == (tmp_path / "two/a.txt").read_bytes()


@pytest.mark.parametrize("file_format", list(ExportFormat))
def test_the_manifest_verifies(confirmed, tmp_path: Path, file_format: ExportFormat) -> None:
    manifest = read_manifest(_export(confirmed, tmp_path, file_format=file_format).manifest)
    assert damaged_files(manifest, tmp_path) == ()
    damaged = "coco.json" if file_format is ExportFormat.COCO else f"a{ENDINGS[file_format]}"
    (tmp_path / damaged).write_bytes(b"1\n")
    assert damaged_files(manifest, tmp_path) == (damaged,)


def test_the_manifest_says_what_was_exported(confirmed, tmp_path: Path) -> None:
    manifest = read_manifest(_export(confirmed, tmp_path).manifest)
    assert (manifest.collection, manifest.segmentation, manifest.schema_version) == ("mugs", "confirmed", 1)
    assert [(part.id, part.name) for part in manifest.parts] == [(1, "body"), (2, "handle")]
    first = manifest.shapes[0]
    assert first.source_key == "a.off"
    assert first.source_hash == confirmed.shape("a.off").source_hash
    assert first.mesh_hash == confirmed.meshes["a.off"].content_hash()
    assert first.faces_per_part == {-1: 1, 1: 2, 2: 1}


@pytest.mark.parametrize(("segmentation", "part"), [(Segmentation.PREDICTED, 1), (Segmentation.REFINED, 2)])
def test_what_a_model_says_names_the_model(filled, tmp_path: Path, segmentation: Segmentation, part: int) -> None:
    model = filled.described().evaluated()
    filled.refined(model)
    manifest = read_manifest(_export(filled, tmp_path, segmentation).manifest)
    assert {shape.model_version for shape in manifest.shapes} == {model.version}
    assert read_seg(tmp_path / "a.seg", 4).tolist() == [part] * 4


def test_exported_labels_can_be_imported_again(confirmed, tmp_path: Path) -> None:
    _export(confirmed, tmp_path)
    report = import_labels(confirmed.workspace, confirmed.collection, tmp_path, RevisionKind.REFERENCE, "export")
    assert (report.n_imported, report.refused) == (2, ())


def test_shapes_that_differ_in_their_suffix_get_a_file_each(confirmed, tmp_path: Path) -> None:
    mesh = confirmed.meshes["b.off"]
    ids = ingest(confirmed.workspace, confirmed.collection, {"a.obj": mesh})
    publish_meshes(confirmed.workspace, {ids["a.obj"]: mesh})
    labels = np.full(16, 2, dtype=np.uint16)
    shape = confirmed.workspace.catalog.shape(ids["a.obj"])
    commit_labels(confirmed.workspace, confirmed.collection, shape, labels, RevisionKind.HUMAN, "ann")
    manifest = read_manifest(_export(confirmed, tmp_path).manifest)
    assert damaged_files(manifest, tmp_path) == ()
    assert read_seg(tmp_path / "a.obj.seg", 16).tolist() == [2] * 16
    report = import_labels(confirmed.workspace, confirmed.collection, tmp_path, RevisionKind.REFERENCE, "export")
    assert report.refused == ()


def test_names_that_clash_all_the_same_are_refused(confirmed, tmp_path: Path) -> None:
    mesh = confirmed.meshes["a.off"]
    for key in ("a.obj.off", "a.obj"):
        ids = ingest(confirmed.workspace, confirmed.collection, {key: mesh})
        publish_meshes(confirmed.workspace, ids and {ids[key]: mesh}, key=key)
        shape = confirmed.workspace.catalog.shape(ids[key])
        commit_labels(confirmed.workspace, confirmed.collection, shape, LABELS, RevisionKind.HUMAN, "ann")
    with raises(ConflictError, "a.obj", "rename it"):
        _export(confirmed, tmp_path)


@pytest.mark.parametrize("segmentation", list(Segmentation))
def test_an_empty_export_is_refused_and_leaves_nothing(filled, tmp_path: Path, segmentation: Segmentation) -> None:
    with raises(NotFoundError, segmentation.value, "'mugs'", "partwise status"):
        _export(filled, tmp_path / "out", segmentation)
    assert not (tmp_path / "out").exists()


def test_a_disk_that_is_full_leaves_the_older_export(
    confirmed, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    manifest = read_manifest(_export(confirmed, tmp_path).manifest)
    before = _files(tmp_path)
    commit_labels(
        confirmed.workspace, confirmed.collection, confirmed.shape("a.off"), LABELS[::-1].copy(), "human", "b"
    )
    real, calls = os.fsync, iter(range(100))

    def fsync(descriptor: int) -> None:
        if next(calls) >= 1:  # the second file finds no room
            raise OSError(28, "No space left on device")
        real(descriptor)

    monkeypatch.setattr(os, "fsync", fsync)
    with raises(StoreError, "No space left", "free space"):
        _export(confirmed, tmp_path)
    assert _files(tmp_path) == before
    assert damaged_files(manifest, tmp_path) == ()


def test_an_export_over_an_older_one_replaces_it(confirmed, tmp_path: Path) -> None:
    _export(confirmed, tmp_path)
    commit_labels(
        confirmed.workspace, confirmed.collection, confirmed.shape("a.off"), LABELS[::-1].copy(), "human", "b"
    )
    manifest = read_manifest(_export(confirmed, tmp_path).manifest)
    assert damaged_files(manifest, tmp_path) == ()
    assert read_seg(tmp_path / "a.seg", 4).tolist() == [-1, 2, 1, 1]


def test_a_file_in_the_way_is_named(confirmed, tmp_path: Path) -> None:
    (tmp_path / "out").write_text("")
    with raises(StoreError, str(tmp_path / "out"), "choose another"):
        _export(confirmed, tmp_path / "out")


def test_a_folder_in_the_place_of_a_file_is_named(confirmed, tmp_path: Path) -> None:
    (tmp_path / "a.seg").mkdir()
    with raises(StoreError, "a.seg", "empty folder"):
        _export(confirmed, tmp_path)


def test_labels_with_a_part_that_was_removed_since_are_refused(filled, tmp_path: Path) -> None:
    filled.refined(filled.described().evaluated())
    filled.workspace.catalog.remove_part(filled.collection.id, 2)
    with raises(ParameterError, "a.off", "[2]"):
        _export(filled, tmp_path / "out", Segmentation.REFINED)
    assert not (tmp_path / "out").exists()
