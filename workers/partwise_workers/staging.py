"""Sweeps what is staged but no run will take up: results, and what dead processes left behind."""

from collections.abc import Iterator, Sequence
from itertools import islice

from partwise.store.records import Collection
from partwise.workspace.workspace import Workspace
from partwise_workers.last_words import LAST_WORDS, PROGRESS
from partwise_workers.plan import chain_keys
from partwise_workers.stage import Stage
from partwise_workers.tasks import StagedName

BATCH = 1000


def sweep_staging(
    workspace: Workspace, collection: Collection, stages: Sequence[Stage], earlier: Sequence[Stage] = ()
) -> int:
    """Deletes what crashed runs left of the stages of a chain, where it is of no more use; returns how many.

    A staged result is of use while it has the shape's present key and no published run has that key. Another run's
    results of present keys are therefore left alone. Neither are steps and last words of use once the stage has failed.
    """
    chain = [*earlier, *stages]
    n_swept = 0
    for stage in stages:
        upstream = chain[: chain.index(stage) + 1]
        for folder in (stage.name, f"{PROGRESS}/{stage.name}", f"{LAST_WORDS}/{stage.name}"):
            names = (StagedName.parse(key) for key in workspace.arrays.staged_keys(folder))
            left = (name for name in names if name is not None)
            while batch := list(islice(left, BATCH)):
                useless = [str(name) for name in _useless(workspace, collection, upstream, batch)]
                workspace.arrays.delete_staged_many(useless)
                n_swept += len(useless)
    return n_swept


def _useless(
    workspace: Workspace, collection: Collection, upstream: Sequence[Stage], names: Sequence[StagedName]
) -> Iterator[StagedName]:
    """Those of the names, all of the last stage of `upstream`, that no run will look for."""
    stage = upstream[-1].name
    ids = {name.shape_id for name in names}
    shapes = workspace.catalog.shapes_by_id(ids)
    done, failed = workspace.catalog.stage_runs(ids, stage), workspace.catalog.failed_runs(ids, stage)
    for name in names:
        shape = shapes.get(name.shape_id)
        if shape is None or shape.collection_id != collection.id:
            continue
        key = name.key.partition(".")[0]  # last words and steps have their actor behind it
        runs = [done.get(name.shape_id), failed.get(name.shape_id) if name.stage != stage else None]
        is_on_record = any(run is not None and run.key == key for run in runs)
        if is_on_record or chain_keys(shape, upstream)[-1] != key:
            yield name
