"""Blocks that are lost or damaged are given up, and only those."""

from pathlib import Path

from partwise.store.records import ShapeState
from partwise.workspace.recovery import give_up_lost_blocks


def _ignore(_progress: object) -> None:
    pass


def test_whole_blocks_stay(filled) -> None:
    filled.described()
    assert give_up_lost_blocks(filled.workspace, _ignore) == []


def test_a_damaged_block_is_given_up(filled) -> None:
    filled.described()
    names = filled.workspace.arrays.block_names()
    features = next(name for name in names if "/features/" in name)
    chunk = max((Path(filled.workspace.array_url) / features).rglob("*"), key=lambda path: path.stat().st_size)
    chunk.write_bytes(chunk.read_bytes()[:-1])
    assert give_up_lost_blocks(filled.workspace, _ignore) == [features]


def test_shapes_of_a_lost_block_are_no_longer_ready(filled) -> None:
    filled.described()
    for name in filled.workspace.arrays.block_names():
        filled.workspace.arrays.delete_block(name)
    assert len(give_up_lost_blocks(filled.workspace, _ignore)) == 2
    assert set(filled.workspace.catalog.shape_states(filled.ids.values()).values()) == {ShapeState.NEW}
