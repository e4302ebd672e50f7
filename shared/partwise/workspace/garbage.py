"""`gc`: sweeps what crashed runs left behind and what newer results have replaced."""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta

from partwise.errors import ConflictError
from partwise.store.large_objects import sweep_expired
from partwise.store.records import Block
from partwise.workspace.export_archive import EXPORTS
from partwise.workspace.uploads import UPLOADS
from partwise.workspace.workspace import Workspace

PAGE = 1000


@dataclass(frozen=True, slots=True)
class GarbageReport:
    """Blocks that no current result needs, blocks that no catalog row names, and halves that killed writes left.

    n_bytes : of the unused blocks. n_expired : uploads and exports that nobody came for in time.
    """

    n_unused_blocks: int
    n_orphan_blocks: int
    n_unfinished: int
    n_bytes: int
    n_expired: int


def collect_garbage(workspace: Workspace, orphans_older_than: timedelta) -> GarbageReport:
    """Rows go first, then the arrays: a crash between the two leaves orphans for the next time.

    Young orphans are left alone: a run may be about to commit them. Kept meshes and sources are never swept.
    """
    n_unused = n_bytes = 0
    while unused := workspace.catalog.unused_blocks(limit=PAGE):
        deleted = _delete_rows(workspace, unused)
        for block in deleted:
            workspace.arrays.delete_block(block.name)
        n_unused += len(deleted)
        n_bytes += sum(block.n_bytes for block in deleted)
        if not deleted:
            break
    orphans = workspace.arrays.orphans(_visible_names(workspace), orphans_older_than)
    for name in orphans:
        workspace.arrays.delete_block(name)
    n_unfinished = workspace.arrays.sweep_unfinished(orphans_older_than)
    n_expired = sum(
        len(sweep_expired(workspace.arrays, f"{folder}/{collection.id}", datetime.now(UTC)))
        for collection in workspace.catalog.list_collections()
        for folder in (UPLOADS, EXPORTS)
    )
    return GarbageReport(n_unused, len(orphans), n_unfinished, n_bytes, n_expired)


def _delete_rows(workspace: Workspace, blocks: Sequence[Block]) -> Sequence[Block]:
    """Deletes them from the catalog, but for those that have come into use since they were listed; returns which."""
    try:
        workspace.catalog.delete_blocks([block.name for block in blocks])
    except ConflictError:
        if len(blocks) == 1:
            return []
        return [each for block in blocks for each in _delete_rows(workspace, [block])]
    return blocks


def _visible_names(workspace: Workspace) -> set[str]:
    names: set[str] = set()
    after = 0
    while page := workspace.catalog.visible_blocks(after=after, limit=PAGE):
        names.update(block.name for block in page)
        after = page[-1].id
    return names
