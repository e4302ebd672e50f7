"""Real files read with the number of faces that their text declares."""

import os
from pathlib import Path

import numpy as np
import pytest

from partwise.io.read import read_mesh
from partwise.io.write import write_mesh

DATA = os.environ.get("PARTWISE_DATA")
pytestmark = pytest.mark.skipif(not DATA, reason="PARTWISE_DATA is not set: no real meshes at hand")
OBJ_FILES = sorted(path for folder in ("dirty", "kaykit") for path in Path(DATA or "").glob(f"{folder}/**/*.obj"))


def test_the_files_are_there():
    assert len(OBJ_FILES) == 92


@pytest.mark.parametrize("path", OBJ_FILES, ids=lambda path: path.stem)
def test_obj_has_the_faces_and_vertices_of_its_text(path):
    mesh = read_mesh(path)
    rows = [line.split() for line in path.read_text().splitlines()]
    polygons = [[int(corner.split("/")[0]) - 1 for corner in row[1:]] for row in rows if row[:1] == ["f"]]
    fans = [[p[0], p[k], p[k + 1]] for p in polygons for k in range(1, len(p) - 1)]
    points = [[float(value) for value in row[1:4]] for row in rows if row[:1] == ["v"]]
    np.testing.assert_array_equal(mesh.faces, fans)
    np.testing.assert_array_equal(mesh.vertices, points)


@pytest.mark.parametrize("number", [61, 70, 80])
def test_off_has_the_faces_of_its_text(number):
    path = Path(DATA) / "lpsb" / "Airplane" / f"{number}.off"
    mesh = read_mesh(path)
    lines = path.read_text().splitlines()
    assert (mesh.n_vertices, mesh.n_faces) == tuple(map(int, lines[1].split()[:2]))
    np.testing.assert_array_equal(mesh.faces[-1], [int(token) for token in lines[-1].split()[1:]])


@pytest.mark.parametrize("suffix", [".off", ".obj", ".ply", ".stl", ".glb"])
@pytest.mark.parametrize("name", ["Mug/D00923", "DeskLamp/m605", "Jet/m1172"])
def test_dirty_meshes_keep_every_corner_through_every_format(name, suffix, tmp_path):
    mesh = read_mesh(Path(DATA) / "dirty" / f"{name}.obj")
    write_mesh(mesh, tmp_path / f"shape{suffix}")
    again = read_mesh(tmp_path / f"shape{suffix}")
    corners, expected = (m.vertices[m.faces].astype(np.float32) for m in (again, mesh))
    np.testing.assert_array_equal(corners, expected)
