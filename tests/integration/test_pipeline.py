"""The way of a small simulated collection among broken files: from a folder to ranked, refined, exported labels."""

import json
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest

from partwise.config import Config
from partwise.exchange.labels_psb import write_psb_labels
from partwise.exchange.named_labels import NamedLabels
from partwise.exchange.seg import read_seg
from partwise.features.parameters import LightFieldParameters
from partwise.io.write import write_mesh
from partwise.simulate.collection import CATEGORIES, simulate_collection
from partwise.store.array_store import BlockAddress
from partwise.store.records import Collection, FirstShape, Model, RevisionKind, ShapeState
from partwise.workspace.assessment import assess
from partwise.workspace.export import ExportFormat, export_labels
from partwise.workspace.first_shapes import select_first_shapes
from partwise.workspace.ingest import IngestReport, ingest_folder
from partwise.workspace.labelling import ImportReport, commit_labels, import_labels
from partwise.workspace.progress import RunProgress
from partwise.workspace.queue import QueuedShape, ranked_queue
from partwise.workspace.segmentations import Segmentation, reference_labels, segmented_shapes
from partwise.workspace.shapes import all_shapes, shape_mesh
from partwise.workspace.status import CollectionStatus, collection_status
from partwise.workspace.workspace import Workspace, init_workspace, open_workspace
from partwise_workers.model_store import ModelReference, read_model
from partwise_workers.passes import evaluate, preprocess, refine
from partwise_workers.training import _Trainer, recipe_of, train_collection, training_batches

N_GOOD = 5
N_FACES = 2000
BAD_FILES = {
    "bad/truncated.off": b"OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n",
    "bad/nan.off": b"OFF\n3 1 0\n0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n",
    "bad/range.off": b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 512\n",
    "bad/no-faces.off": b"OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n",
}
CLUSTERS = 3


@dataclass(frozen=True)
class Pipeline:
    """The workspace after every step, and what each step reported."""

    workspace: Workspace
    collection: Collection
    folder: Path
    ingested: IngestReport
    preprocessed: RunProgress
    imported: ImportReport
    selected: list[FirstShape]
    model: Model
    evaluated: RunProgress
    refined: RunProgress
    queue: list[QueuedShape]
    status: CollectionStatus


def unheard(progress: RunProgress) -> None:
    """A listener for runs whose result is enough."""


def write_shapes(folder: Path) -> None:
    for shape in simulate_collection("mugs", N_GOOD, 3, n_faces=N_FACES):
        write_mesh(shape.mesh, folder / f"{shape.name}.off")
        write_psb_labels(folder / f"{shape.name}_labels.txt", NamedLabels(shape.part_names, shape.labels))
    for name, data in {**BAD_FILES, "bad/empty.off": b""}.items():
        path = folder / name
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(data)


def quick(config: Config) -> Config:
    """Little training; one actor without a probe of EGL, as starting actors is most of the work here."""
    return replace(
        config,
        train=replace(config.train, n_iterations=40, n_snapshots=2),
        workers=replace(config.workers, n_actors=1),
        describe=replace(config.describe, light_field=LightFieldParameters(renderer="raycast")),
    )


@pytest.fixture(scope="module")
def pipeline(local_ray: None, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Pipeline]:
    root = tmp_path_factory.mktemp("pipeline")
    write_shapes(root / "shapes")
    init_workspace(root / "ws")
    with open_workspace(root / "ws") as opened:
        workspace = replace(opened, config=quick(opened.config))
        collection = workspace.catalog.create_collection("mugs", CATEGORIES["mugs"].part_names)
        yield run(workspace, collection, root)


def run(workspace: Workspace, collection: Collection, root: Path) -> Pipeline:
    ingested = ingest_folder(workspace, collection, root / "shapes")
    preprocessed = preprocess(workspace, collection, unheard)
    imported = import_labels(workspace, collection, root / "shapes", RevisionKind.REFERENCE, "simulation")
    selected = select_first_shapes(workspace, collection, CLUSTERS, 1, 0)
    for shape in workspace.catalog.shapes_by_id([first.shape_id for first in selected]).values():
        truth = reference_labels(workspace, shape_mesh(workspace, shape))
        assert truth is not None
        commit_labels(workspace, collection, shape, truth, RevisionKind.HUMAN, "ann")
    return Pipeline(
        workspace,
        collection,
        root,
        ingested,
        preprocessed,
        imported,
        selected,
        train_collection(workspace, collection, lambda done, n_total: None),
        evaluate(workspace, collection, unheard),
        refine(workspace, collection, unheard),
        ranked_queue(workspace, collection, "entropy", limit=100),
        collection_status(workspace, collection, max_failures=100),
    )


def test_an_empty_file_is_refused_at_ingest_and_the_rest_goes_on(pipeline: Pipeline) -> None:
    assert [refused.source_key for refused in pipeline.ingested.refused] == ["bad/empty.off"]
    assert pipeline.ingested.n_added == N_GOOD + len(BAD_FILES)


def test_every_good_shape_is_described(pipeline: Pipeline) -> None:
    assert pipeline.preprocessed == RunProgress(N_GOOD, len(BAD_FILES), N_GOOD + len(BAD_FILES))


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("bad/truncated.off", "truncated"),
        ("bad/nan.off", "nan"),
        ("bad/range.off", "512"),
        ("bad/no-faces.off", "faces must be a non-empty"),
    ],
)
def test_a_bad_file_is_named_with_its_reason(pipeline: Pipeline, name: str, says: str) -> None:
    (failure,) = [failure for failure in pipeline.status.failures if failure.source_key == name]
    assert says in failure.reason.lower()
    assert "\n" not in failure.reason


def test_ground_truth_fits_every_stored_mesh(pipeline: Pipeline) -> None:
    assert (pipeline.imported.n_imported, pipeline.imported.refused) == (N_GOOD, ())


def test_the_first_shapes_are_of_different_clusters(pipeline: Pipeline) -> None:
    assert len({first.cluster for first in pipeline.selected}) == CLUSTERS


def test_the_model_learnt_from_what_was_confirmed(pipeline: Pipeline) -> None:
    assert pipeline.model.n_shapes == CLUSTERS


def test_the_models_files_are_in_the_store(pipeline: Pipeline) -> None:
    model = read_model(pipeline.workspace.arrays, ModelReference.of(pipeline.model))
    parts = pipeline.workspace.catalog.parts(pipeline.collection.id).parts
    assert model.part_ids == tuple(part.id for part in parts)


def test_every_described_shape_is_evaluated_and_refined(pipeline: Pipeline) -> None:
    assert pipeline.evaluated == pipeline.refined == RunProgress(N_GOOD, 0, N_GOOD)


def test_probabilities_are_shares(pipeline: Pipeline) -> None:
    ids = [shape.id for shape in all_shapes(pipeline.workspace.catalog, pipeline.collection.id)]
    for run_of_shape in pipeline.workspace.catalog.stage_runs(ids, "evaluate").values():
        probabilities = pipeline.workspace.arrays.read(run_of_shape.block_name, run_of_shape.row, "probabilities")
        np.testing.assert_allclose(probabilities.astype(np.float64).sum(axis=1), 1.0, atol=2e-3)


def test_a_little_training_already_beats_calling_everything_the_largest_part(pipeline: Pipeline) -> None:
    meshes = [shape_mesh(pipeline.workspace, each.shape) for each in pipeline.queue]
    truths = [reference_labels(pipeline.workspace, mesh) for mesh in meshes]
    largest = [np.bincount(truth).max() / len(truth) for truth in truths if truth is not None]
    refined = assess(pipeline.workspace, pipeline.collection, Segmentation.REFINED)
    assert np.mean([each.by_face for each in refined]) > np.mean(largest)


def test_the_queue_is_ranked_the_least_certain_first(pipeline: Pipeline) -> None:
    scores = [row.score for row in pipeline.queue]
    assert len(scores) == N_GOOD
    assert scores == sorted(scores, reverse=True)


def test_the_queue_says_what_is_confirmed(pipeline: Pipeline) -> None:
    confirmed = {row.shape.id for row in pipeline.queue if row.state is ShapeState.CONFIRMED}
    assert confirmed == {first.shape_id for first in pipeline.selected}


def test_predicted_parts_cover_the_shape(pipeline: Pipeline) -> None:
    for row in pipeline.queue:
        assert sum(share for _, share in row.parts) == pytest.approx(1.0)


@pytest.mark.parametrize("again", [preprocess, evaluate, refine])
def test_a_second_pass_has_nothing_to_do(pipeline: Pipeline, again) -> None:
    assert again(pipeline.workspace, pipeline.collection, unheard) == RunProgress(0, 0, 0)


def test_exported_labels_are_the_refined_ones(pipeline: Pipeline, tmp_path: Path) -> None:
    export_labels(pipeline.workspace, pipeline.collection, Segmentation.REFINED, ExportFormat.SEG, tmp_path)
    for each in segmented_shapes(pipeline.workspace, pipeline.collection, Segmentation.REFINED):
        written = read_seg(tmp_path / each.shape.source_key.replace(".off", ".seg"), each.mesh.n_faces)
        np.testing.assert_array_equal(written, each.labels)


def test_the_manifest_lists_what_was_confirmed(pipeline: Pipeline, tmp_path: Path) -> None:
    report = export_labels(pipeline.workspace, pipeline.collection, Segmentation.CONFIRMED, ExportFormat.PLY, tmp_path)
    assert (report.n_written, report.n_without) == (CLUSTERS, N_GOOD + len(BAD_FILES) - CLUSTERS)
    assert json.loads(report.manifest.read_text(encoding="utf-8"))["segmentation"] == "confirmed"


def test_every_block_on_record_is_whole_and_no_other_is_there(pipeline: Pipeline) -> None:
    blocks = pipeline.workspace.catalog.visible_blocks()
    for block in blocks:
        pipeline.workspace.arrays.verify(BlockAddress(block.name, block.n_shapes, block.n_bytes, block.checksum))
    assert sorted(block.name for block in blocks) == list(pipeline.workspace.arrays.block_names())


def test_nothing_stays_staged(pipeline: Pipeline) -> None:
    assert list(pipeline.workspace.arrays.staged_keys()) == []


def test_the_same_seed_gives_the_same_weights(pipeline: Pipeline) -> None:
    part_ids = tuple(part.id for part in pipeline.workspace.catalog.parts(pipeline.collection.id).parts)
    recipe = recipe_of(pipeline.workspace.config.train)
    trainer = _Trainer(pipeline.workspace.array_url)
    with training_batches(pipeline.workspace, pipeline.collection) as batches:
        for batch in batches:
            trainer.add(batch.shapes)
        again = trainer.fit(part_ids, recipe, None, n_threads=1)
    assert again.weights_key == pipeline.model.weights_key
