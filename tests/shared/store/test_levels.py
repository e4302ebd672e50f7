"""A working mesh and its other resolutions, through a block and back."""

import numpy as np
import pytest

from partwise.errors import NotFoundError
from partwise.mesh import TriMesh
from partwise.store.array_store import ArrayStore
from partwise.store.block_kinds import REMESH
from partwise.store.levels import read_level, remeshed_arrays
from partwise.store.open_arrays import open_array_store
from partwise.testing.expect import raises
from partwise.testing.meshes import subdivided

VERTICES = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=np.float64)
COARSE = TriMesh(VERTICES, np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]))
MIDDLE = subdivided(COARSE)
FINE = subdivided(MIDDLE)


@pytest.fixture
def arrays(tmp_path) -> ArrayStore:
    return open_array_store(str(tmp_path / "arrays"))


def written(arrays: ArrayStore, *shapes: dict[str, np.ndarray]) -> str:
    return arrays.write_block(REMESH, shapes).name


def test_every_level_comes_back_whichever_is_the_working_mesh(arrays) -> None:
    levels = [(64, FINE), (16, MIDDLE), (4, COARSE)]
    name = written(arrays, *(remeshed_arrays(working, levels) for _, working in levels))
    for row in range(3):
        for n_faces, mesh in levels:
            assert read_level(arrays, name, row, n_faces).content_hash() == mesh.content_hash()


def test_the_working_mesh_is_stored_once() -> None:
    made = remeshed_arrays(MIDDLE, [(64, FINE), (16, MIDDLE)])
    assert (len(made["faces"]), len(made["level_faces"])) == (16, 64)
    assert made["level_sizes"].tolist() == [[64, FINE.n_vertices, 64], [16, 0, 0]]


def test_shapes_without_any_other_level_may_fill_a_block(arrays) -> None:
    name = written(arrays, *(remeshed_arrays(mesh, [(64, None), (16, None)]) for mesh in (COARSE, MIDDLE)))
    assert arrays.read(name, 1, "level_faces").shape == (0, 3)
    assert len(arrays.read(name, 1, "faces")) == 16


def test_shapes_with_and_without_levels_share_a_block(arrays) -> None:
    none, one = remeshed_arrays(COARSE, [(16, None)]), remeshed_arrays(COARSE, [(16, MIDDLE)])
    name = written(arrays, none, one, none, one, none)
    for row in (1, 3):
        assert read_level(arrays, name, row, 16).content_hash() == MIDDLE.content_hash()
    assert arrays.read(name, 2, "level_vertices").shape == (0, 3)


def test_an_absent_level_names_those_that_are_there(arrays) -> None:
    name = written(arrays, remeshed_arrays(MIDDLE, [(64, None), (16, MIDDLE), (4, COARSE)]))
    with raises(NotFoundError, "64 faces were not", "there are: 16, 4"):
        read_level(arrays, name, 0, 64)


def test_without_any_level_there_are_none(arrays) -> None:
    name = written(arrays, remeshed_arrays(MIDDLE, [(64, None)]))
    with raises(NotFoundError, "100 faces were not", "there are: none"):
        read_level(arrays, name, 0, 100)
