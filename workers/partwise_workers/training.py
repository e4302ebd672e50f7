"""Trains a model on every labelled shape of a collection, in one actor that has all cores, and puts it on record."""

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from typing import Any, overload

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
from partwise.store.open import open_array_store
from partwise.store.records import Collection, LabelRevision, Model, NewModel, ShapeState, StageRun
from partwise.workspace.workspace import Workspace
from partwise_workers.cluster import connected, cores
from partwise_workers.model_store import write_model
from partwise_workers.plan import chain_keys, description_stages
from partwise_workers.pool import first_line, raise_own
from partwise_workers.tasks import BlockRow, block_row

BRANCHES = ("shape_context", "spin_image")
POLL_S = 0.5


@dataclass(frozen=True, slots=True, eq=False)
class TrainingShape:
    """Where one labelled shape's arrays are, and its labels: (m,) uint16 part ids, 0 = unlabelled."""

    shape_id: int
    revision_id: int
    mesh: BlockRow
    features: BlockRow
    labels: UInt16[np.ndarray, " m"]


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
        names = [*BRANCHES, *(f"{branch}_scale" for branch in BRANCHES)]
        features = self._arrays.read_many(shape.features.block_name, shape.features.row, names)
        grids = {branch: CodedGrids(features[branch], features[f"{branch}_scale"]) for branch in BRANCHES}
        return LabelledShape(TriMesh(mesh["vertices"], mesh["faces"]), grids, self._class_of[shape.labels])


class _Trainer:
    """Fits one model. `progress` may be asked while `fit` runs: the actor has two threads."""

    def __init__(self, array_url: str) -> None:
        self._array_url = array_url
        self._done = (0, 0)

    def fit(
        self,
        shapes: Sequence[TrainingShape],
        part_ids: tuple[int, ...],
        recipe: Recipe,
        refinement: RefinementParameters | None,
        n_threads: int,
    ) -> TrainingResult:
        started = time.perf_counter()
        arrays = open_array_store(self._array_url)
        stored = StoredShapes(arrays, shapes, part_ids)
        fitted = fit(stored, part_ids, recipe, refinement, self._note, n_threads)
        account: dict[str, Any] = {"recipe": asdict(recipe), "train_s": round(time.perf_counter() - started, 3)}
        if fitted.tuning is not None:
            account["smoothness"] = fitted.tuning.smoothness
            account["tuning"] = asdict(fitted.tuning)
        return TrainingResult(write_model(arrays, fitted.model), account)

    def progress(self) -> tuple[int, int]:
        """Iterations done, and in all; (0, 0) before training begins."""
        return self._done

    def _note(self, done: int, n_total: int) -> None:
        self._done = (done, n_total)


Trainer = ray.remote(_Trainer)


def train_collection(workspace: Workspace, collection: Collection, on_progress: Callable[[int, int], None]) -> Model:
    """Trains on the newest human or imported labels of every shape; the model is one more version of the collection's.

    Shapes whose faces are all unlabelled teach nothing and are left out. The weights are in the array store before the
    catalog has the model.

    Raises
    ------
    NotEnoughDataError : no shape has labels on its present, described mesh.
    StoreError : a store is full or cannot be reached.
    WorkerError : Ray cannot be started, or the training's process died.
    """
    shapes = [shape for shape in labelled_shapes(workspace, collection) if shape.labels.any()]
    part_ids = tuple(sorted({int(part) for shape in shapes for part in np.unique(shape.labels) if part}))
    if not part_ids:
        raise _nothing_to_learn(workspace, collection)
    config = workspace.config.train
    refinement = workspace.config.refine if config.tune_smoothness else None
    with connected():
        n_threads = cores().largest_node
        actor: Any = Trainer.options(num_cpus=n_threads, max_concurrency=2).remote(workspace.array_url)
        try:
            pending = actor.fit.remote(shapes, part_ids, recipe_of(config), refinement, n_threads)
            result = _wait(actor, pending, on_progress)
        finally:
            ray.kill(actor)
    revision_ids = tuple(shape.revision_id for shape in shapes)
    return workspace.catalog.save_model(NewModel(collection.id, result.recipe, result.weights_key, revision_ids))


def _nothing_to_learn(workspace: Workspace, collection: Collection) -> NotEnoughDataError:
    states = workspace.catalog.state_counts(collection.id)
    n_review, n_labelled = states[ShapeState.REVIEW], states[ShapeState.CONFIRMED] + states[ShapeState.REVIEW]
    if not n_labelled:
        return NotEnoughDataError(
            f"training needs labelled shapes but {collection.name!r} has none; confirm those `partwise select` names"
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
    actor: Any, pending: ray.ObjectRef[TrainingResult], on_progress: Callable[[int, int], None]
) -> TrainingResult:
    try:
        while not ray.wait([pending], timeout=POLL_S)[0]:
            done, n_total = ray.get(actor.progress.remote())
            if n_total:
                on_progress(done, n_total)
        result: TrainingResult = ray.get(pending)
    except RayError as error:
        raise_own(error)
        raise WorkerError(
            f"training must run to its end but its process died: {first_line(error)}; free some memory, train again"
        ) from error
    return result


def labelled_shapes(workspace: Workspace, collection: Collection) -> Iterator[TrainingShape]:
    """Every shape whose newest human or imported labels can be learned from, by id.

    They must belong to the mesh that is described, and to the present schema version (older ones wait for someone to
    look at them); no review of them may be open. The description must be as the configuration says, so that no model
    mixes two kinds.
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
            if places is not None and revision.schema_version == collection.schema_version:
                yield TrainingShape(shape_id, revision.id, *places, catalog.labels(revision.id))
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
