"""Which stages each shape still needs, read from the catalog page by page."""

from collections.abc import Iterator, Mapping, Sequence

from partwise.store.records import Collection, Shape, StageRun
from partwise.workspace.ingest import source_object
from partwise.workspace.settings import settings_of
from partwise.workspace.shapes import pages_of_shapes
from partwise.workspace.workspace import Workspace
from partwise_workers.stage import Stage, stage_key
from partwise_workers.stages.describe import DescribeStage
from partwise_workers.stages.mesh import MeshStage
from partwise_workers.stages.remesh import RemeshStage
from partwise_workers.tasks import BlockRow, ShapeTask, block_row


def plan_tasks(
    workspace: Workspace, collection: Collection, stages: Sequence[Stage], earlier: Sequence[Stage] = ()
) -> Iterator[ShapeTask]:
    """Tasks for the shapes that need any of the stages, by shape id.

    `earlier` and `stages` together are a chain, each reading the one before it and the first the source. A shape that
    has not all of `earlier` under their present keys is passed over: its arrays would not fit together. So is a shape
    that failed under the same key, until its failure is cleared or the key changes.
    """
    for page in pages_of_shapes(workspace.catalog, collection.id):
        yield from plan_page(workspace, page, stages, earlier)


def plan_page(
    workspace: Workspace, shapes: Sequence[Shape], stages: Sequence[Stage], earlier: Sequence[Stage] = ()
) -> Iterator[ShapeTask]:
    """As `plan_tasks`, of these shapes, in their order: a page of a collection's."""
    chain = [*earlier, *stages]
    ids = [shape.id for shape in shapes]
    done = {stage.name: workspace.catalog.stage_runs(ids, stage.name) for stage in chain}
    failed = {stage.name: workspace.catalog.failed_runs(ids, stage.name) for stage in stages}
    for shape in shapes:
        done_here = {name: runs[shape.id] for name, runs in done.items() if shape.id in runs}
        failed_here = {name: runs[shape.id].key for name, runs in failed.items() if shape.id in runs}
        task = _plan(shape, chain, len(earlier), done_here, failed_here)
        if task is not None:
            yield task


def description_stages(workspace: Workspace, collection: Collection) -> tuple[MeshStage, RemeshStage, DescribeStage]:
    """What turns an ingested file into descriptors, as the workspace is configured and the collection set.

    Raises
    ------
    ParameterError : a setting of the collection is out of range.
    """
    config = workspace.config
    remesh = RemeshStage.of(config.remesh, settings_of(collection))
    return MeshStage(config.mesh), remesh, DescribeStage(config.describe)


def chain_keys(shape: Shape, chain: Sequence[Stage]) -> list[str]:
    """The key of each stage of a chain, the first of which reads the shape's source."""
    keys: list[str] = []
    for stage in chain:
        keys.append(stage_key(stage, keys[-1] if keys else shape.source_hash))
    return keys


def _plan(
    shape: Shape, chain: Sequence[Stage], n_earlier: int, done: Mapping[str, StageRun], failed: Mapping[str, str]
) -> ShapeTask | None:
    finished: dict[str, BlockRow] = {}
    needed: list[tuple[str, str]] = []
    for position, (stage, key) in enumerate(zip(chain, chain_keys(shape, chain), strict=True)):
        run = done.get(stage.name)
        place = block_row(run)
        if run is not None and run.key == key and place is not None and not needed:
            finished[stage.name] = place
        elif position < n_earlier:
            return None
        elif failed.get(stage.name) == key:
            break
        else:
            needed.append((stage.name, key))
    if not needed:
        return None
    source = source_object(shape.source_hash, shape.source_suffix)
    return ShapeTask(shape.id, shape.source_key, source, tuple(needed), finished)
