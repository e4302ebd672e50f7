"""Leave one out over a labelled folder: train on all shapes but one, predict and refine that one."""

import os
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from partwise.errors import NotEnoughDataError, NotFoundError
from partwise.exchange.labels_psb import read_psb_labels
from partwise.geometry.faces import face_areas
from partwise.io.read import read_mesh
from partwise.learning.ensemble import predict
from partwise.learning.fitting import Fitted, LabelledShape, fit
from partwise.learning.recipe import Recipe
from partwise.metrics.accuracy import accuracy, accuracy_by_area
from partwise.segmentation.model_refinement import refine
from partwise.store.records import Collection, RevisionKind
from partwise.workspace.ingest import ingest_folder, mesh_files
from partwise.workspace.labelling import PSB_ENDING, import_labels
from partwise.workspace.progress import OnRunProgress
from partwise.workspace.settings import change_settings
from partwise.workspace.workspace import Workspace, init_workspace, open_workspace
from partwise_workers.cluster import connected
from partwise_workers.passes import preprocess
from partwise_workers.training import StoredShapes, TrainingShape, labelled_shapes, training_batches

OnTraining = Callable[[int, int, str], None]


@dataclass(frozen=True, slots=True)
class HeldOut:
    """One held-out shape: shares in [0, 1] of its faces and of its area that are right, before and after the cut."""

    shape: str
    n_faces: int
    accuracy_raw: float
    accuracy_refined: float
    accuracy_raw_by_area: float
    accuracy_refined_by_area: float
    smoothness: float
    train_s: float


@dataclass(frozen=True, slots=True)
class Summary:
    """Means over the held-out shapes, and what they were measured with."""

    category: str
    preset: str
    n_held_out: int
    n_shapes: int
    accuracy_raw: float
    accuracy_refined: float
    accuracy_raw_by_area: float
    accuracy_refined_by_area: float
    train_s: float


@dataclass(frozen=True, slots=True)
class Prepared:
    """What of a folder can be measured on: shapes with labels. refused : files that cannot be used, and why."""

    collection: str
    n_shapes: int
    refused: tuple[str, ...]


def prepare(folder: Path, workspace_path: Path, on_progress: OnRunProgress) -> Prepared:
    """Ingests and describes the folder into a collection of its own name. What the workspace has already is kept.

    Raises
    ------
    NotEnoughDataError : fewer than two labelled shapes.
    NotFoundError : there is no such folder.
    """
    if not folder.is_dir():
        raise NotFoundError(
            f"leave one out needs a folder of meshes and labels but {folder} is not one; check the path"
        )
    names = part_names_of(folder)
    if not names:
        raise NotEnoughDataError(f"leave one out needs <id>{PSB_ENDING} files but {folder} has none; see --category")
    init_workspace(workspace_path)
    with open_workspace(workspace_path) as workspace:
        if folder.name not in {known.name for known in workspace.catalog.list_collections()}:
            workspace.catalog.create_collection(folder.name, names)
        collection = workspace.catalog.get_collection(folder.name)
        collection = change_settings(workspace, collection, {"remesh": "never"})  # as in the paper, on the files' faces
        ingested = ingest_folder(workspace, collection, folder)
        with connected():
            preprocess(workspace, collection, on_progress)
        imported = import_labels(workspace, collection, folder, RevisionKind.IMPORTED, "benchmark")
        failures = workspace.catalog.failures(collection.id)
        n_labelled = sum(1 for _ in labelled_shapes(workspace, collection))
    if n_labelled < 2:
        raise NotEnoughDataError(
            f"leave one out needs 2 labelled shapes or more but {folder} has {n_labelled}; add some"
        )
    refused = (
        *(file.reason for file in ingested.refused),
        *(f"{failure.source_key}: {failure.run.reason}" for failure in failures),
        *(labels.reason for labels in imported.refused),
    )
    return Prepared(collection.name, n_labelled, refused)


def part_names_of(folder: Path) -> list[str]:
    """Every part name that the folder's `_labels.txt` files use, sorted."""
    names: set[str] = set()
    for path in mesh_files(folder):
        labels = path.with_name(path.stem + PSB_ENDING)
        if labels.is_file():
            names.update(read_psb_labels(labels, read_mesh(path).n_faces).part_names)
    return sorted(names)


def leave_one_out(
    workspace: Workspace, collection_name: str, recipe: Recipe, limit: int | None, on_training: OnTraining
) -> Iterator[HeldOut]:
    """Holds out `limit` evenly spaced shapes, one after the other; all of them without a limit."""
    collection = workspace.catalog.get_collection(collection_name)
    with training_batches(workspace, collection) as batches:
        labelled = {
            shape_id: shape for batch in batches for shape_id, shape in zip(batch.shape_ids, batch.shapes, strict=True)
        }
        yield from _held_out_in_turn(workspace, collection, labelled, recipe, limit, on_training)


def _held_out_in_turn(
    workspace: Workspace,
    collection: Collection,
    labelled: Mapping[int, TrainingShape],
    recipe: Recipe,
    limit: int | None,
    on_training: OnTraining,
) -> Iterator[HeldOut]:
    part_ids = workspace.catalog.parts(collection.id).ids
    shapes = workspace.catalog.shapes_by_id(labelled)
    ids = list(labelled)
    for held_out in (ids[position] for position in evenly_spaced(len(ids), limit)):
        name = shapes[held_out].source_key
        others = [shape for shape_id, shape in labelled.items() if shape_id != held_out]
        started = time.perf_counter()
        fitted = fit(
            StoredShapes(workspace.arrays, others, part_ids),
            part_ids,
            recipe,
            workspace.config.refine,
            lambda done, n_total, name=name: on_training(done, n_total, name),  # type: ignore[misc] # mypy cannot type the default
            n_threads=os.cpu_count(),
        )
        train_s = time.perf_counter() - started
        yield _judge(
            name, StoredShapes(workspace.arrays, [labelled[held_out]], part_ids)[0], fitted, workspace, train_s
        )


def evenly_spaced(n: int, limit: int | None) -> list[int]:
    """`limit` of the indices 0 … n−1, first and last among them; all without a limit."""
    return sorted(set(np.linspace(0, n - 1, min(limit or n, n)).round().astype(int).tolist()))


def summarise(results: Sequence[HeldOut], category: str, preset: str, n_shapes: int) -> Summary:
    """Means over held-out shapes."""

    def mean(name: str) -> float:
        return round(float(np.mean([getattr(result, name) for result in results])), 5)

    return Summary(
        category,
        preset,
        len(results),
        n_shapes,
        mean("accuracy_raw"),
        mean("accuracy_refined"),
        mean("accuracy_raw_by_area"),
        mean("accuracy_refined_by_area"),
        mean("train_s"),
    )


def _judge(name: str, shape: LabelledShape, fitted: Fitted, workspace: Workspace, train_s: float) -> HeldOut:
    refinement = workspace.config.refine
    if fitted.tuning is not None:
        refinement = replace(refinement, smoothness=fitted.tuning.smoothness)
    probabilities = predict(fitted.model, shape.grids).probabilities
    raw, refined = np.argmax(probabilities, axis=1), refine(shape.mesh, probabilities, refinement)
    areas = face_areas(shape.mesh)
    return HeldOut(
        shape=name,
        n_faces=shape.mesh.n_faces,
        accuracy_raw=round(accuracy(raw, shape.classes), 5),
        accuracy_refined=round(accuracy(refined, shape.classes), 5),
        accuracy_raw_by_area=round(accuracy_by_area(raw, shape.classes, areas), 5),
        accuracy_refined_by_area=round(accuracy_by_area(refined, shape.classes, areas), 5),
        smoothness=refinement.smoothness,
        train_s=round(train_s, 2),
    )
