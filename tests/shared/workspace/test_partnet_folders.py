"""PartNet's folders: ingested whole, labelled by the parts that the collection has."""

import json
from pathlib import Path

import numpy as np
import pytest

from partwise.errors import FileFormatError
from partwise.mesh import TriMesh
from partwise.store.records import RevisionKind
from partwise.testing.workspaces import publish_meshes
from partwise.workspace.ingest import ingest_folder
from partwise.workspace.labelling import import_labels
from partwise.workspace.partnet_folders import folder_bytes, folder_of

TETRAHEDRON = "v {0} 0 0\nv {1} 0 0\nv {0} 1 0\nv {0} 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"
MUG = [
    {
        **{"id": 0, "name": "mug"},
        "children": [
            {"id": 1, "name": "body", "objs": ["new-0"]},
            {"id": 2, "name": "handle", "children": [{"id": 3, "name": "ring", "objs": ["new-1"]}]},
        ],
    }
]


def write_mug(folder: Path, hierarchy: object = MUG) -> Path:
    (folder / "objs").mkdir(parents=True)
    (folder / "point_sample").mkdir()
    (folder / "point_sample" / "ply-10000.ply").write_text("not of the shape")
    for k in (0, 1):
        (folder / "objs" / f"new-{k}.obj").write_text(TETRAHEDRON.format(2 * k, 2 * k + 1))
    (folder / "result.json").write_text(json.dumps(hierarchy))
    return folder


def _ingested(workspace, collection, folder: Path) -> dict[str, int]:
    assert ingest_folder(workspace, collection, folder).refused == ()
    return {shape.source_key: shape.id for shape in workspace.catalog.shapes(collection.id)}


def _published(workspace, shape_id: int) -> None:
    first = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=np.float64)
    faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    both = TriMesh(np.vstack([first, first + np.array([2.0, 0, 0])]), np.vstack([faces, faces + 4]))
    publish_meshes(workspace, {shape_id: both})


def test_a_folder_is_one_shape_and_its_files_are_none(workspace, collection, tmp_path) -> None:
    write_mug(tmp_path / "in" / "a" / "42")
    (tmp_path / "in" / "z.off").write_bytes(folder_bytes(tmp_path / "in" / "a" / "42"))
    assert set(_ingested(workspace, collection, tmp_path / "in")) == {"a/42.off", "z.off"}


def test_a_folder_by_itself_goes_by_its_name(workspace, collection, tmp_path) -> None:
    write_mug(tmp_path / "42")
    assert set(_ingested(workspace, collection, tmp_path / "42")) == {"42.off"}
    assert folder_of(tmp_path / "42", "42.off") == tmp_path / "42"
    assert folder_of(tmp_path, "42.off") == tmp_path / "42"
    assert folder_of(tmp_path, "43.off") is None
    assert folder_of(tmp_path, "42.obj") is None


def test_faces_are_of_the_deepest_part_that_the_collection_has(workspace, collection, tmp_path) -> None:
    write_mug(tmp_path / "42")
    shape_id = _ingested(workspace, collection, tmp_path)["42.off"]
    _published(workspace, shape_id)
    report = import_labels(workspace, collection, tmp_path, RevisionKind.IMPORTED, "partnet")
    assert (report.n_imported, report.refused) == (1, ())
    labels = workspace.catalog.labels(workspace.catalog.head_revision(shape_id).id)
    assert labels.tolist() == [1] * 4 + [2] * 4


def test_a_piece_under_no_known_part_is_refused_by_its_path(workspace, collection, tmp_path) -> None:
    stranger = [{"id": 0, "name": "mug", "children": [{"id": 1, "name": "lid", "objs": ["new-0", "new-1"]}]}]
    write_mug(tmp_path / "42", stranger)
    _published(workspace, _ingested(workspace, collection, tmp_path)["42.off"])
    (refused,) = import_labels(workspace, collection, tmp_path, RevisionKind.IMPORTED, "partnet").refused
    assert "mug/lid" in refused.reason


def test_pieces_that_have_changed_are_refused(workspace, collection, tmp_path) -> None:
    write_mug(tmp_path / "42")
    _published(workspace, _ingested(workspace, collection, tmp_path)["42.off"])
    (tmp_path / "42" / "objs" / "new-1.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    (refused,) = import_labels(workspace, collection, tmp_path, RevisionKind.IMPORTED, "partnet").refused
    assert "5" in refused.reason
    assert "were ingested" in refused.reason


def test_a_folder_that_cannot_be_read_costs_only_itself(workspace, collection, tmp_path) -> None:
    both = [{"id": k, "name": f"part {k}", "objs": ["new-0"]} for k in (0, 1)]
    write_mug(tmp_path / "42", both)
    (refused,) = ingest_folder(workspace, collection, tmp_path).refused
    assert refused.source_key == "42.off"
    assert "one part" in refused.reason
    assert str(tmp_path) not in refused.reason  # whoever asked for it need not know where it is
    with pytest.raises(FileFormatError, match="one part"):
        folder_bytes(tmp_path / "42")
