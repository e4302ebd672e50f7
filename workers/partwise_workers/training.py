"""Trains a model on every labelled shape of a collection, in one actor that has all cores, and puts it on record.

The actor does not open the catalog: the driver writes the labels, a batch of shapes at a time, into blocks that no row
names, and tells the actor where they are. They are deleted afterwards; those of a run that was killed are orphans.
"""

import os
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field
from itertools import chain
from typing import Any, TypeVar, overload

import numpy as np
import ray
from jaxtyping import UInt16
from ray.exceptions import RayError

from partwise.config import TrainConfig
from partwise.errors import NotEnoughDataError, WorkerError
from partwise.learning.dataset import CodedGrids
from partwise.learning.fitting import LabelledShape, fit
from partwise.learning.recipe import Recipe
from partwise.mesh import TriMesh
from partwise.segmentation.parameters import RefinementParameters
from partwise.store.array_store import ArrayStore
from partwise.store.blocks import BlockKind, Domain, Quantity
from partwise.store.open_arrays import open_array_store
from partwise.store.records import Collection, LabelRevision, Model, NewModel, ShapeState, StageRun
from partwise.workspace.workspace import Workspace
from partwise_workers.cluster import connected, cores
from partwise_workers.events import ActorMemory, OnEvent, ignore_events
from partwise_workers.model_store import write_model
from partwise_workers.plan import chain_keys, description_stages
from partwise_workers.pool import first_line, raise_own
from partwise_workers.sentinel import resident_bytes
from partwise_workers.tasks import BlockRow, block_row

T = TypeVar("T")

BRANCHES = ("shape_context", "spin_image")
POLL_S = 0.5

TRAINING_LABELS = BlockKind("training_labels", (Quantity("labels", Domain.FACE, "uint16"),))
"""Part ids, 0 = unlabelled, as they were when training began."""

BATCH_SHAPES, BATCH_BYTES = 256, 32 * 1024 * 1024
"""Labels of so many shapes, or so large, are in the driver's memory at a time."""


@dataclass(frozen=True, slots=True)
class LearnableShape:
    """A shape with labels to learn from: their revision, and where its mesh and features are."""

    shape_id: int
    revision_id: int
    mesh: BlockRow
    features: BlockRow


@dataclass(frozen=True, slots=True)
class TrainingShape:
    """Where one labelled shape's arrays are; its labels in a block of `TRAINING_LABELS`."""

    mesh: BlockRow
    features: BlockRow
    labels: BlockRow


@dataclass(frozen=True, slots=True)
class TrainingBatch:
    """Shapes whose labels are in one block. part_ids : those that are in use among them."""

    shapes: tuple[TrainingShape, ...]
    shape_ids: tuple[int, ...]
    revision_ids: tuple[int, ...]
    part_ids: frozenset[int]


@dataclass(slots=True)
class _Gathered:
    shapes: list[LearnableShape] = field(default_factory=list)
    labels: list[UInt16[np.ndarray, " m"]] = field(default_factory=list)

    @property
    def is_full(self) -> bool:
        return len(self.shapes) >= BATCH_SHAPES or sum(each.nbytes for each in self.labels) >= BATCH_BYTES


@dataclass(frozen=True, slots=True)
class TrainingResult:
    """weights_key : in the array store. recipe : how the model came to be, JSON-able, with the smoothness chosen."""

    weights_key: str
    recipe: dict[str, Any]


class StoredShapes(Sequence[LabelledShape]):
    """Labelled shapes that are read from their blocks when they are indexed, so that few are in memory at once."""

    def __init__(self, arrays: ArrayStore, shapes: Sequence[TrainingShape], part_ids: tuple[int, ...]) -> None:
        self._arrays = arrays
        self._shapes = shapes
        self._class_of = np.full(max(part_ids) + 1, -1, dtype=np.int64)
        self._class_of[list(part_ids)] = np.arange(len(part_ids))

    def __len__(self) -> int:
        return len(self._shapes)

    @overload
    def __getitem__(self, index: int) -> LabelledShape: ...

    @overload
    def __getitem__(self, index: slice) -> "StoredShapes": ...

    def __getitem__(self, index: int | slice) -> "LabelledShape | StoredShapes":
        if isinstance(index, slice):
            raise TypeError("stored shapes are read one at a time; index them with integers")
        shape = self._shapes[index]
        mesh = self._arrays.read_many(shape.mesh.block_name, shape.mesh.row, ("vertices", "faces"))
        labels = self._arrays.read(shape.labels.block_name, shape.labels.row, "labels")
        names = [*BRANCHES, *(f"{branch}_scale" for branch in BRANCHES)]
        features = self._arrays.read_many(shape.features.block_name, shape.features.row, names)
        grids = {branch: CodedGrids(features[branch], features[f"{branch}_scale"]) for branch in BRANCHES}
        return LabelledShape(TriMesh(mesh["vertices"], mesh["faces"]), grids, self._class_of[labels])


class _Trainer:
    """Fits one model. `progress` may be asked while `fit` runs: the actor has two threads."""

    def __init__(self, array_url: str) -> None:
        self._array_url = array_url
        self._done = (0, 0)
        self._shapes: list[TrainingShape] = []

    def add(self, shapes: Sequence[TrainingShape]) -> None:
        """More shapes to learn from."""
        self._shapes += shapes

    def fit(
        self,
        part_ids: tuple[int, ...],
        recipe: Recipe,
        refinement: RefinementParameters | None,
        n_threads: int,
    ) -> TrainingResult:
        started = time.perf_counter()
        arrays = open_array_store(self._array_url)
        stored = StoredShapes(arrays, self._shapes, part_ids)
        fitted = fit(stored, part_ids, recipe, refinement, self._note, n_threads)
        account: dict[str, Any] = {"recipe": asdict(recipe), "train_s": round(time.perf_counter() - started, 3)}
        if fitted.tuning is not None:
            account["smoothness"] = fitted.tuning.smoothness
            account["tuning"] = asdict(fitted.tuning)
        return TrainingResult(write_model(arrays, fitted.model), account)

    def progress(self) -> tuple[int, int]:
        """Iterations done, and in all; (0, 0) before training begins."""
        return self._done

    def resident_bytes(self) -> int:
        """Memory of this process in RAM."""
        return resident_bytes(os.getpid())

    def _note(self, done: int, n_total: int) -> None:
        self._done = (done, n_total)


Trainer = ray.remote(_Trainer)


def train_collection(workspace: Workspace, collection: Collection, on_progress: Callable[[int, int], None]) -> Model:
    """Trains as `trained_model`; the model is one more version of the collection's."""
    return workspace.catalog.save_model(trained_model(workspace, collection, on_progress))


def trained_model(
    workspace: Workspace,
    collection: Collection,
    on_progress: Callable[[int, int], None],
    on_event: OnEvent = ignore_events,
) -> NewModel:
    """Trains on the newest human or imported labels of every shape; the weights are stored, the model is on no record.

    Shapes whose faces are all unlabelled teach nothing and are left out. What `on_progress` raises ends the training.

    Raises
    ------
    NotEnoughDataError : no shape has labels on its present, described mesh.
    StoreError : a store is full or cannot be reached.
    WorkerError : Ray cannot be started, or the training's process died.
    """
    with training_batches(workspace, collection) as batches:
        first = next(batches, None)
        if first is None:
            raise _nothing_to_learn(workspace, collection)
        with connected():
            result, revision_ids = _train(workspace, chain([first], batches), on_progress, on_event)
    return NewModel(collection.id, result.recipe, result.weights_key, revision_ids)


def _train(
    workspace: Workspace,
    batches: Iterable[TrainingBatch],
    on_progress: Callable[[int, int], None],
    on_event: OnEvent,
) -> tuple[TrainingResult, tuple[int, ...]]:
    """The model, and the revisions that it learned from."""
    config = workspace.config.train
    refinement = workspace.config.refine if config.tune_smoothness else None
    n_threads = cores().largest_node
    actor: Any = Trainer.options(num_cpus=n_threads, max_concurrency=2).remote(workspace.array_url)
    part_ids: set[int] = set()
    revision_ids: list[int] = []
    try:
        for batch in batches:
            _result(actor.add.remote(batch.shapes))
            part_ids |= batch.part_ids
            revision_ids += batch.revision_ids
        pending = actor.fit.remote(tuple(sorted(part_ids)), recipe_of(config), refinement, n_threads)
        return _wait(actor, pending, on_progress, on_event), tuple(revision_ids)
    finally:
        ray.kill(actor)
        on_event(ActorMemory(0, 0))


@contextmanager
def training_batches(workspace: Workspace, collection: Collection) -> Iterator[Iterator[TrainingBatch]]:
    """The shapes that a model can learn from, batch by batch, by id; their labels are there for the time of the block.

    Shapes whose faces are all unlabelled are left out.
    """
    written: list[str] = []
    try:
        yield _batches(workspace, collection, written)
    finally:
        for name in written:
            workspace.arrays.delete_block(name)


def _batches(workspace: Workspace, collection: Collection, written: list[str]) -> Iterator[TrainingBatch]:
    """Adds the name of each block that it writes to `written`."""
    gathered = _Gathered()
    for shape in labelled_shapes(workspace, collection):
        labels = workspace.catalog.labels(shape.revision_id)
        if labels.any():
            gathered.shapes.append(shape)
            gathered.labels.append(labels)
        if gathered.is_full:
            yield _batch(workspace, gathered, written)
            gathered = _Gathered()
    if gathered.shapes:
        yield _batch(workspace, gathered, written)


def _batch(workspace: Workspace, gathered: _Gathered, written: list[str]) -> TrainingBatch:
    block = workspace.arrays.write_block(TRAINING_LABELS, [{"labels": labels} for labels in gathered.labels])
    written.append(block.name)
    return TrainingBatch(
        tuple(
            TrainingShape(shape.mesh, shape.features, BlockRow(block.name, row))
            for row, shape in enumerate(gathered.shapes)
        ),
        tuple(shape.shape_id for shape in gathered.shapes),
        tuple(shape.revision_id for shape in gathered.shapes),
        frozenset(int(part) for labels in gathered.labels for part in np.unique(labels) if part),
    )


def _nothing_to_learn(workspace: Workspace, collection: Collection) -> NotEnoughDataError:
    states = workspace.catalog.state_counts(collection.id)
    n_review, n_labelled = states[ShapeState.REVIEW], states[ShapeState.CONFIRMED] + states[ShapeState.REVIEW]
    if not n_labelled:
        return NotEnoughDataError(
            f"training needs labelled shapes but {collection.name!r} has none; confirm those `partwise select` names"
        )
    if n_review == n_labelled:
        return NotEnoughDataError(
            f"training needs labels that wait for no review but those of all {n_review:,} labelled shapes of "
            f"{collection.name!r} do; look at them, or accept many at once: `partwise reviews`"
        )
    return NotEnoughDataError(
        f"training needs labels on meshes that are described as configured but none of {n_labelled:,} labelled shapes "
        f"of {collection.name!r} has any ({n_review:,} wait for a review); run `partwise preprocess`, which moves "
        "labels along, and look at those in review"
    )


def recipe_of(config: TrainConfig) -> Recipe:
    """The recipe that `[train]` of `partwise.toml` describes."""
    values = asdict(config)
    del values["tune_smoothness"]
    return Recipe(**values)


def _wait(
    actor: Any,
    pending: ray.ObjectRef[TrainingResult],
    on_progress: Callable[[int, int], None],
    on_event: OnEvent,
) -> TrainingResult:
    while not ray.wait([pending], timeout=POLL_S)[0]:
        on_event(ActorMemory(1, _result(actor.resident_bytes.remote())))
        done, n_total = _result(actor.progress.remote())
        if n_total:
            on_progress(done, n_total)
    return _result(pending)


def _result(reference: "ray.ObjectRef[T]") -> T:
    """What the actor answers; its own errors, and WorkerError where it died."""
    try:
        return ray.get(reference)
    except RayError as error:
        raise_own(error)
        raise WorkerError(
            f"training must run to its end but its process died: {first_line(error)}; free some memory, train again"
        ) from error


def labelled_shapes(workspace: Workspace, collection: Collection) -> Iterator[LearnableShape]:
    """Every shape whose newest human or imported labels can be learned from, by id.

    They must belong to the mesh that is described, and no review of them may be open: when parts change one opens for
    all, and who accepts it finds them right under the present ones. The description must be as the configuration says,
    so that no model mixes two kinds.
    """
    catalog, after = workspace.catalog, 0
    stages = description_stages(workspace, collection)
    while page := catalog.labelled_shapes(collection.id, after=after, leave_out_reviews=True):
        ids = [revision.shape_id for revision in page]
        shapes = catalog.shapes_by_id(ids)
        runs = [catalog.stage_runs(ids, stage.name) for stage in stages[1:]]  # the original's mesh is another
        for revision in page:
            shape_id = revision.shape_id
            places = _places([each.get(shape_id) for each in runs], chain_keys(shapes[shape_id], stages)[1:], revision)
            if places is not None:
                yield LearnableShape(shape_id, revision.id, *places)
        after = ids[-1]


def _places(
    runs: Sequence[StageRun | None], keys: Sequence[str], revision: LabelRevision
) -> tuple[BlockRow, BlockRow] | None:
    """Where mesh and features are, if both are present and of the mesh that the labels belong to."""
    present = [
        place
        for run, key in zip(runs, keys, strict=True)
        if run is not None
        and run.key == key
        and run.summary["mesh_hash"] == revision.mesh_hash
        and (place := block_row(run)) is not None
    ]
    return (present[0], present[1]) if len(present) == len(keys) else None
