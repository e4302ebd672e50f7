"""Sweeps results that are staged but that no run will take up."""

from collections.abc import Sequence
from itertools import islice

from partwise.store.records import Collection
from partwise.workspace.workspace import Workspace
from partwise_workers.plan import chain_keys
from partwise_workers.stage import Stage
from partwise_workers.tasks import StagedName

BATCH = 1000


def sweep_staging(
    workspace: Workspace, collection: Collection, stages: Sequence[Stage], earlier: Sequence[Stage] = ()
) -> int:
    """Deletes what crashed runs left of the stages of a chain, where it is of no more use; returns how many.

    A staged result is of use while it has the shape's present key and no published run has that key. Another run's
    results of present keys are therefore left alone.
    """
    chain = [*earlier, *stages]
    n_swept = 0
    for position, stage in enumerate(chain[len(earlier) :], start=len(earlier)):
        names = (StagedName.parse(key) for key in workspace.arrays.staged_keys(stage.name))
        left = (name for name in names if name is not None)
        while batch := list(islice(left, BATCH)):
            ids = {name.shape_id for name in batch}
            shapes, runs = workspace.catalog.shapes_by_id(ids), workspace.catalog.stage_runs(ids, stage.name)
            for name in batch:
                shape, run = shapes.get(name.shape_id), runs.get(name.shape_id)
                if shape is None or shape.collection_id != collection.id:
                    continue
                is_published = run is not None and run.key == name.key
                if is_published or chain_keys(shape, chain)[position] != name.key:
                    workspace.arrays.delete_staged(str(name))
                    n_swept += 1
    return n_swept
