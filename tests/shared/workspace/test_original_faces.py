"""Labels of the file's own faces: they come in with it, move to the working mesh, and go out again."""

from pathlib import Path

import numpy as np
import pytest

from partwise.errors import StoreError
from partwise.exchange.export_manifest import ManifestShape, read_manifest
from partwise.exchange.labels_psb import write_psb_labels
from partwise.exchange.named_labels import NamedLabels
from partwise.exchange.seg import read_seg, write_seg
from partwise.geometry.faces import face_centroids
from partwise.mesh import TriMesh
from partwise.store.meshes import kept_mesh_key
from partwise.store.records import MeshRole, RevisionKind, ShapeState
from partwise.testing.expect import raises
from partwise.testing.spheres import ball, halves, speckles
from partwise.testing.workspaces import publish_evaluation, publish_features, publish_meshes, save_model
from partwise.workspace.choices import ExportFormat, Segmentation
from partwise.workspace.export import MANIFEST, export_labels
from partwise.workspace.labelling import ImportReport, commit_labels, import_labels
from partwise.workspace.relabel import MoveReport, move_here

ORIGINAL, WORKING = ball(3), ball(2)
KEY = "a.off"


@pytest.fixture
def remeshed(filled):
    """a.off has a file of 512 faces and a working mesh of 128."""
    publish_meshes(filled.workspace, {filled.ids[KEY]: ORIGINAL}, "mesh", MeshRole.ORIGINAL)
    publish_meshes(filled.workspace, {filled.ids[KEY]: WORKING}, "remesh")
    return filled


def _import(filled, folder: Path, kind: RevisionKind = RevisionKind.IMPORTED) -> ImportReport:
    return import_labels(filled.workspace, filled.collection, folder, kind, "import")


def _seg(folder: Path, labels: np.ndarray) -> Path:
    write_seg(folder / "a.seg", labels.astype(np.int64))
    return folder


def _psb(folder: Path, labels: np.ndarray) -> Path:
    write_psb_labels(folder / "a_labels.txt", NamedLabels(("body", "handle"), labels.astype(np.int64) - 1))
    return folder


def _head(filled):
    return filled.workspace.catalog.head_revision(filled.ids[KEY])


@pytest.mark.parametrize("write", [_seg, _psb])
def test_labels_of_the_file_are_on_record_and_their_child_is_on_the_working_mesh(remeshed, tmp_path, write) -> None:
    report = _import(remeshed, write(tmp_path, halves(ORIGINAL)))
    assert (report.n_imported, report.moves, report.refused) == (1, MoveReport(1, 0, 0), ())
    made, child = remeshed.workspace.catalog.revisions(remeshed.ids[KEY])
    assert (made.mesh_hash, child.mesh_hash) == (ORIGINAL.content_hash(), WORKING.content_hash())
    assert (child.parent_id, child.kind) == (made.id, RevisionKind.IMPORTED)
    np.testing.assert_array_equal(remeshed.workspace.catalog.labels(child.id), halves(WORKING))
    for mesh in (ORIGINAL, WORKING):
        assert remeshed.workspace.arrays.exists(kept_mesh_key(mesh.content_hash()))


@pytest.mark.parametrize("write", [_seg, _psb])
def test_labels_of_the_working_mesh_are_known_by_their_number(remeshed, tmp_path, write) -> None:
    report = _import(remeshed, write(tmp_path, halves(WORKING)))
    assert (report.n_imported, report.moves) == (1, MoveReport(0, 0, 0))
    assert _head(remeshed).mesh_hash == WORKING.content_hash()


def test_labels_that_suffer_wait_for_a_review(remeshed, tmp_path: Path) -> None:
    assert _import(remeshed, _seg(tmp_path, speckles(ORIGINAL))).moves == MoveReport(1, 1, 0)
    shape_id = remeshed.ids[KEY]
    assert remeshed.workspace.catalog.shape_states([shape_id]) == {shape_id: ShapeState.REVIEW}


def test_where_both_meshes_have_as_many_faces_labels_are_the_files(filled, tmp_path: Path) -> None:
    turned = TriMesh(ORIGINAL.vertices, ORIGINAL.faces[::-1])
    publish_meshes(filled.workspace, {filled.ids[KEY]: ORIGINAL}, "mesh", MeshRole.ORIGINAL)
    publish_meshes(filled.workspace, {filled.ids[KEY]: turned}, "remesh")
    _import(filled, _seg(tmp_path, halves(ORIGINAL)))
    np.testing.assert_array_equal(filled.workspace.catalog.labels(_head(filled).id), halves(turned))


def test_where_the_file_is_the_working_mesh_nothing_is_moved(filled, tmp_path: Path) -> None:
    publish_meshes(filled.workspace, {filled.ids[KEY]: ORIGINAL}, "mesh", MeshRole.ORIGINAL)
    publish_meshes(filled.workspace, {filled.ids[KEY]: ORIGINAL}, "remesh")
    assert _import(filled, _seg(tmp_path, halves(ORIGINAL))).moves == MoveReport(0, 0, 0)
    assert len(filled.workspace.catalog.revisions(filled.ids[KEY])) == 1


def test_labels_of_a_file_that_could_not_be_remeshed_wait_on_record(filled, tmp_path: Path) -> None:
    publish_meshes(filled.workspace, {filled.ids[KEY]: ORIGINAL}, "mesh", MeshRole.ORIGINAL)
    report = _import(filled, _seg(tmp_path, halves(ORIGINAL)))
    assert (report.n_imported, report.moves) == (1, MoveReport(0, 0, 0))
    publish_meshes(filled.workspace, {filled.ids[KEY]: WORKING}, "remesh")
    assert move_here(filled.workspace, filled.collection) == MoveReport(1, 0, 0)


@pytest.mark.parametrize("kind", [RevisionKind.IMPORTED, RevisionKind.REFERENCE])
def test_importing_again_changes_nothing(remeshed, tmp_path: Path, kind: RevisionKind) -> None:
    _import(remeshed, _seg(tmp_path, halves(ORIGINAL)), kind)
    before = remeshed.workspace.catalog.revisions(remeshed.ids[KEY])
    report = _import(remeshed, tmp_path, kind)
    assert (report.n_imported, report.n_unchanged, report.moves) == (0, 1, MoveReport(0, 0, 0))
    assert remeshed.workspace.catalog.revisions(remeshed.ids[KEY]) == before


@pytest.mark.parametrize("write", [_seg, _psb])
def test_another_number_of_labels_is_refused_with_both_counts(remeshed, tmp_path: Path, write) -> None:
    report = _import(remeshed, write(tmp_path, np.ones(100, dtype=np.uint16)))
    (refused,) = report.refused
    assert all(word in refused.reason for word in ("512", "128", "100", "a.seg" if write is _seg else "a_labels.txt"))
    assert remeshed.workspace.catalog.revisions(remeshed.ids[KEY]) == []


def test_a_file_that_leaves_faces_out_belongs_to_the_only_mesh_that_has_its_last_face(remeshed, tmp_path) -> None:
    labels = np.ones(300, dtype=np.uint16)
    assert _import(remeshed, _psb(tmp_path, labels)).n_imported == 1
    made, _ = remeshed.workspace.catalog.revisions(remeshed.ids[KEY])
    assert made.mesh_hash == ORIGINAL.content_hash()
    assert np.count_nonzero(remeshed.workspace.catalog.labels(made.id)) == 300


def _export(filled, out: Path, segmentation: Segmentation, on: MeshRole) -> ManifestShape:
    export_labels(filled.workspace, filled.collection, segmentation, ExportFormat.SEG, out, on)
    (entry,) = read_manifest(out / MANIFEST).shapes
    return entry


def test_what_was_labelled_on_the_file_comes_back_exactly(remeshed, tmp_path: Path) -> None:
    _import(remeshed, _seg(tmp_path, speckles(ORIGINAL)))
    made, moved = remeshed.workspace.catalog.revisions(remeshed.ids[KEY])
    entry = _export(remeshed, tmp_path / "out", Segmentation.CONFIRMED, MeshRole.ORIGINAL)
    np.testing.assert_array_equal(read_seg(tmp_path / "out" / "a.seg", 512), speckles(ORIGINAL))
    assert (entry.mesh, entry.mesh_hash, entry.agreement) == ("original", ORIGINAL.content_hash(), None)
    assert (entry.revision_ids, entry.is_in_review) == ((made.id,), False)
    working = _export(remeshed, tmp_path / "working", Segmentation.CONFIRMED, MeshRole.WORKING)
    assert (working.mesh, working.mesh_hash) == ("working", WORKING.content_hash())
    assert (working.revision_ids, working.is_in_review, working.kind) == ((moved.id, made.id), True, "imported")


def test_what_a_person_changed_since_is_mapped_back(remeshed, tmp_path: Path) -> None:
    _import(remeshed, _seg(tmp_path, speckles(ORIGINAL)))
    labels = halves(WORKING)
    shape = remeshed.shape(KEY)
    mine = commit_labels(remeshed.workspace, remeshed.collection, shape, labels, RevisionKind.HUMAN, "ann")
    entry = _export(remeshed, tmp_path / "out", Segmentation.CONFIRMED, MeshRole.ORIGINAL)
    np.testing.assert_array_equal(read_seg(tmp_path / "out" / "a.seg", 512), halves(ORIGINAL))
    assert entry.revision_ids == (mine.id,)
    assert entry.agreement is not None
    assert entry.agreement >= 0.98


def _confirm_and_damage(filled, *keys: str) -> None:
    """Labels the working meshes of a.off and b.off, where b.off is twice as large; then those of `keys` are damaged."""
    large = [TriMesh(2 * mesh.vertices, mesh.faces) for mesh in (ORIGINAL, WORKING)]
    publish_meshes(filled.workspace, {filled.ids["b.off"]: large[0]}, "mesh", MeshRole.ORIGINAL)
    publish_meshes(filled.workspace, {filled.ids["b.off"]: large[1]}, "remesh")
    for key, mesh in ((KEY, WORKING), ("b.off", large[1])):
        labels = halves(WORKING)
        commit_labels(filled.workspace, filled.collection, filled.shape(key), labels, RevisionKind.HUMAN, "ann")
        if key in keys:
            filled.workspace.arrays.put_bytes(kept_mesh_key(mesh.content_hash()), b"damaged")


@pytest.mark.parametrize("on", list(MeshRole))
def test_a_mesh_that_cannot_be_read_costs_only_its_own_shape(remeshed, tmp_path: Path, on: MeshRole) -> None:
    _confirm_and_damage(remeshed, KEY)
    ws, out = remeshed.workspace, tmp_path / "out"
    report = export_labels(ws, remeshed.collection, Segmentation.CONFIRMED, ExportFormat.PLY, out, on)
    assert (report.n_written, report.n_without) == (1, 1)
    (refused,) = report.refused
    assert refused.startswith("a.off: ")
    assert "safetensors" in refused
    assert [entry.source_key for entry in read_manifest(report.manifest).shapes] == ["b.off"]
    assert sorted(path.name for path in out.iterdir()) == ["b.ply", MANIFEST]


def test_where_no_mesh_can_be_read_nothing_is_exported(remeshed, tmp_path: Path) -> None:
    _confirm_and_damage(remeshed, KEY, "b.off")
    with raises(StoreError, "a.off", "all 2 shapes"):
        _export(remeshed, tmp_path / "out", Segmentation.CONFIRMED, MeshRole.ORIGINAL)
    assert not (tmp_path / "out").exists()


def test_a_store_that_is_down_ends_the_export(remeshed, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    _confirm_and_damage(remeshed, KEY)

    def refuse(*_: object) -> None:
        raise StoreError("the array store refused; is it reachable?")

    monkeypatch.setattr(remeshed.workspace.arrays, "stage", refuse)
    with raises(StoreError, "is it reachable"):
        _export(remeshed, tmp_path / "out", Segmentation.CONFIRMED, MeshRole.ORIGINAL)


def test_predictions_are_mapped_back(remeshed, tmp_path: Path) -> None:
    shape_id = remeshed.ids[KEY]
    publish_features(remeshed.workspace, [shape_id], np.random.default_rng(0))
    model = save_model(remeshed.workspace, remeshed.collection)
    is_upper = face_centroids(WORKING)[:, 2] > 0
    probabilities = np.where(is_upper[:, None], [0.9, 0.1], [0.1, 0.9])
    publish_evaluation(remeshed.workspace, model, (1, 2), {shape_id: probabilities})
    entry = _export(remeshed, tmp_path, Segmentation.PREDICTED, MeshRole.ORIGINAL)
    np.testing.assert_array_equal(read_seg(tmp_path / "a.seg", 512), halves(ORIGINAL))
    assert (entry.revision_ids, entry.model_version, entry.kind) == ((), 1, "predicted")


def test_exported_labels_of_the_file_are_imported_unchanged(remeshed, tmp_path: Path) -> None:
    _import(remeshed, _seg(tmp_path, halves(ORIGINAL)))
    _export(remeshed, tmp_path / "out", Segmentation.CONFIRMED, MeshRole.ORIGINAL)
    assert _import(remeshed, tmp_path / "out").n_unchanged == 1


def test_export_says_how_far_it_is(remeshed, tmp_path: Path) -> None:
    _import(remeshed, _seg(tmp_path, halves(ORIGINAL)))
    told = []
    export_labels(
        remeshed.workspace,
        remeshed.collection,
        Segmentation.CONFIRMED,
        ExportFormat.SEG,
        tmp_path / "out",
        on_progress=told.append,
    )
    assert [(progress.n_done, progress.n_total) for progress in told] == [(1, 3)]
