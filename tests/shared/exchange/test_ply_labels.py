"""Labels and colours on a PLY mesh's faces."""

import numpy as np
import pytest
import trimesh

from partwise.errors import FileFormatError, LabelError
from partwise.exchange.ply_labels import LabelledMesh, colour_faces, read_ply_labels, write_ply_labels
from partwise.io.write import write_mesh
from partwise.mesh import TriMesh

MESH = TriMesh(np.eye(4)[:, :3], np.array([[0, 1, 2], [1, 2, 3], [0, 3, 1]]))
LABELS = np.array([5, -1, 300])
COLOURS = {5: (255, 0, 0), 300: (0, 128, 255)}


def test_round_trip(tmp_path):
    write_ply_labels(tmp_path / "a.ply", LabelledMesh(MESH, LABELS), COLOURS)
    again = read_ply_labels(tmp_path / "a.ply")
    np.testing.assert_array_equal(again.labels, LABELS)
    assert again.mesh.content_hash() == MESH.content_hash()


def test_from_bytes(tmp_path):
    write_ply_labels(tmp_path / "a.ply", LabelledMesh(MESH, LABELS), COLOURS)
    again = read_ply_labels("s3://bucket/a.ply", (tmp_path / "a.ply").read_bytes())
    np.testing.assert_array_equal(again.labels, LABELS)


def test_other_programs_see_the_colours(tmp_path):
    write_ply_labels(tmp_path / "a.ply", LabelledMesh(MESH, LABELS), COLOURS, unlabelled=(1, 2, 3))
    seen = trimesh.load_mesh(tmp_path / "a.ply", process=False)
    np.testing.assert_array_equal(seen.faces, MESH.faces)
    np.testing.assert_array_equal(seen.visual.face_colors[:, :3], [(255, 0, 0), (1, 2, 3), (0, 128, 255)])


def test_labels_must_fit_the_mesh():
    with pytest.raises(LabelError, match="3 faces must have a label each"):
        LabelledMesh(MESH, np.zeros(4, dtype=np.int64))


def test_a_label_without_colour():
    with pytest.raises(LabelError, match="300 has none"):
        colour_faces(LABELS, {5: (0, 0, 0)})


@pytest.mark.parametrize("colour", [(0, 0, 256), (-1, 0, 0)])
def test_a_colour_out_of_range(colour):
    with pytest.raises(LabelError, match="0 to 255"):
        colour_faces(LABELS, {5: colour, 300: (0, 0, 0)})


def test_a_mesh_without_labels(tmp_path):
    write_mesh(MESH, tmp_path / "a.ply")
    with pytest.raises(FileFormatError, match=r"a\.ply: faces must have a number 'label'"):
        read_ply_labels(tmp_path / "a.ply")


def test_labels_of_polygons_do_not_fit_triangles():
    data = (
        b"ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        b"element face 1\nproperty list uchar int vertex_index\nproperty int label\nend_header\n"
        b"0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 7\n"
    )
    with pytest.raises(LabelError, match=r"^a\.ply: 2 faces must have a label each"):
        read_ply_labels("a.ply", data)
