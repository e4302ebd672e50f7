from pathlib import Path

import numpy as np
import pytest
import trimesh
from PIL import Image

from partwise.errors import ParameterError, StoreError
from partwise.mesh import TriMesh
from partwise.render.contact_sheet import PADDING, LegendEntry, Tile, contact_sheet, save_png


def _tile(caption: tuple[str, ...] = (), colour: tuple[int, int, int] = (0, 114, 178)) -> Tile:
    box = trimesh.creation.box()
    mesh = TriMesh(np.asarray(box.vertices), np.asarray(box.faces))
    return Tile(mesh, np.tile(np.array(colour, dtype=np.uint8), (mesh.n_faces, 1)), caption)


def _ink(picture: np.ndarray) -> int:
    return int((picture < 250).any(axis=2).sum())


def test_tiles_lie_row_by_row() -> None:
    red, green = (255, 0, 0), (0, 255, 0)
    page = contact_sheet([_tile(colour=red), _tile(colour=green), _tile(colour=green)], columns=2, tile_size=40)
    cell = 40 + PADDING
    assert page.shape == (2 * cell + PADDING, 2 * cell + PADDING, 3)
    middles = [page[r * cell + PADDING + 20, c * cell + PADDING + 20].astype(int) for r, c in ((0, 0), (0, 1), (1, 0))]
    assert [int(middle.argmax()) for middle in middles] == [0, 1, 1]
    assert _ink(page[cell + PADDING :, cell + PADDING :]) == 0, "the last cell is empty"


def test_there_are_no_more_columns_than_tiles() -> None:
    assert contact_sheet([_tile()], columns=5, tile_size=40).shape[1] == 40 + 2 * PADDING


def test_captions_stay_within_their_tile() -> None:
    page = contact_sheet([_tile(("a very long name that cannot fit",)), _tile()], columns=2, tile_size=60)
    under_first, under_second = np.split(page[PADDING + 60 :], [PADDING + 60], axis=1)
    assert _ink(under_first) > 0
    assert _ink(under_second[:, 2:]) == 0


def test_title_and_legend_are_written_above() -> None:
    plain = contact_sheet([_tile()], columns=1, tile_size=120)
    swatch = (1, 200, 99)
    page = contact_sheet([_tile()], columns=1, tile_size=120, title="Chairs", legend=[LegendEntry("seat", swatch)])
    added = len(page) - len(plain)
    assert (page[:added] == swatch).all(axis=2).sum() > 100
    np.testing.assert_array_equal(page[added:], plain)


def test_a_long_legend_breaks_into_rows() -> None:
    entries = [LegendEntry("part", (1, 200, 99))] * 6
    one = contact_sheet([_tile()], columns=1, tile_size=200, legend=entries[:1])
    assert len(contact_sheet([_tile()], columns=1, tile_size=200, legend=entries)) > len(one)


@pytest.mark.parametrize(("n_tiles", "columns", "tile_size"), [(0, 1, 40), (1, 0, 40), (1, 1, 31)])
def test_an_impossible_page_is_refused(n_tiles: int, columns: int, tile_size: int) -> None:
    with pytest.raises(ParameterError, match=f"has {n_tiles}, {columns} and {tile_size}"):
        contact_sheet([_tile()] * n_tiles, columns, tile_size)


@pytest.mark.parametrize("n_channels", [3, 4])
def test_png_round_trip(n_channels: int, tmp_path: Path) -> None:
    picture = np.random.default_rng(0).integers(0, 256, (7, 5, n_channels)).astype(np.uint8)
    save_png(picture, tmp_path / "a.png")
    np.testing.assert_array_equal(np.asarray(Image.open(tmp_path / "a.png")), picture)
    assert [path.name for path in tmp_path.iterdir()] == ["a.png"]


def test_a_folder_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(StoreError, match=r"nowhere/a\.png"):
        save_png(np.zeros((2, 2, 3), dtype=np.uint8), tmp_path / "nowhere" / "a.png")
