"""Finds blocks whose arrays are lost or damaged, so that what was in them is computed again."""

from partwise.errors import StoreError
from partwise.store.array_store import BlockAddress
from partwise.store.records import Block
from partwise.workspace.progress import OnRunProgress, RunProgress
from partwise.workspace.workspace import Workspace

PAGE = 1000


def give_up_lost_blocks(workspace: Workspace, on_progress: OnRunProgress) -> list[str]:
    """Reads every block on record and compares it with its checksum; returns the names of those that are not whole.

    Their shapes lack those stages from now on: the next preprocess, evaluate and refine do them again. Labels are in
    the catalog, and the meshes they belong to are kept apart, so nothing that people made is in a block only.
    """
    blocks = _blocks_on_record(workspace)
    lost: list[str] = []
    for n_done, block in enumerate(blocks, start=1):
        try:
            workspace.arrays.verify(BlockAddress(block.name, block.n_shapes, block.n_bytes, block.checksum))
        except StoreError:
            workspace.catalog.supersede_block(block.name)
            lost.append(block.name)
        on_progress(RunProgress(n_done, 0, len(blocks)))
    return lost


def _blocks_on_record(workspace: Workspace) -> list[Block]:
    blocks: list[Block] = []
    while page := workspace.catalog.visible_blocks(after=blocks[-1].id if blocks else 0, limit=PAGE):
        blocks += page
    return blocks
