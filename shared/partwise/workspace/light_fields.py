"""The light fields of described shapes, a few at a time: one is 208 kB."""

from collections.abc import Iterator, Sequence

import numpy as np
from jaxtyping import UInt8

from partwise.store.records import Collection, StageRun
from partwise.workspace.segmentations import DESCRIBE
from partwise.workspace.shapes import pages_of_shapes
from partwise.workspace.workspace import Workspace

AT_ONCE = 64
"""Light fields in memory at a time, 13 MB."""


def described_runs(workspace: Workspace, collection: Collection) -> Iterator[StageRun]:
    """What described each shape, by shape id."""
    for page in pages_of_shapes(workspace.catalog, collection.id):
        runs = workspace.catalog.stage_runs([shape.id for shape in page], DESCRIBE)
        yield from (runs[shape.id] for shape in page if shape.id in runs)


def light_fields(workspace: Workspace, runs: Sequence[StageRun]) -> Iterator[UInt8[np.ndarray, "b d"]]:
    """Those of the shapes that were described by these runs, in their order, up to `AT_ONCE` together."""
    for start in range(0, len(runs), AT_ONCE):
        batch = runs[start : start + AT_ONCE]
        places = [(run.block_name, run.row) for run in batch if run.block_name is not None and run.row is not None]
        yield np.stack([workspace.arrays.read(name, row, "light_field") for name, row in places])
