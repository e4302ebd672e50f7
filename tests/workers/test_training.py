"""Training on stored shapes: what is learnt from, what is put on record, and that a seed settles the result."""

import json
import os
import signal
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import psutil
import pytest
import trimesh

from partwise.errors import NotEnoughDataError, WorkerError
from partwise.learning.recipe import Recipe
from partwise.mesh import TriMesh
from partwise.store.block_kinds import N_BINS, N_LIGHT_FIELD, REMESH
from partwise.store.levels import remeshed_arrays
from partwise.store.meshes import mesh_arrays
from partwise.store.records import (
    Collection,
    Model,
    NewBlock,
    NewMesh,
    NewRevision,
    NewShape,
    NewStageRun,
    RevisionKind,
)
from partwise.store.reviews import NewReview, ReviewReason
from partwise.workspace.reviewing import accept_all
from partwise.workspace.workspace import Workspace, init_workspace, open_workspace
from partwise_workers import training
from partwise_workers.model_store import ModelReference, read_model
from partwise_workers.plan import chain_keys, description_stages
from partwise_workers.training import (
    TrainingResult,
    _Trainer,
    labelled_shapes,
    recipe_of,
    train_collection,
    training_batches,
)

N_SHAPES = 4
BALL = trimesh.creation.icosphere(subdivisions=2)
MESHES = [TriMesh(BALL.vertices * (1 + 0.1 * number), BALL.faces) for number in range(N_SHAPES)]
LABELS = np.where(BALL.triangles_center[:, 2] > 0, 1, 2).astype(np.uint16)


@pytest.fixture
def described(tmp_path: Path) -> Iterator[tuple[Workspace, Collection]]:
    with described_balls(tmp_path / "ws") as opened:
        yield opened


@contextmanager
def described_balls(path: Path) -> Iterator[tuple[Workspace, Collection]]:
    """Four described balls of 320 faces whose features tell their halves apart, and nobody's labels."""
    init_workspace(path)
    with open_workspace(path) as workspace:
        collection = workspace.catalog.create_collection("balls", ["upper", "lower"])
        new = [NewShape(f"{number}.off", f"{number}", ".off") for number in range(N_SHAPES)]
        ids = [ingested.shape_id for ingested in workspace.catalog.add_shapes(collection.id, new)]
        publish(workspace, ids)
        config = replace(workspace.config, train=replace(workspace.config.train, n_iterations=20, n_snapshots=2))
        yield replace(workspace, config=config), collection


def publish(workspace: Workspace, ids: list[int]) -> None:
    """Meshes and features of the shapes, as a run of the configured stages would leave them."""
    made = [
        NewMesh(shape_id, MESHES[row].content_hash(), MESHES[row].n_vertices, MESHES[row].n_faces, row)
        for row, shape_id in enumerate(ids)
    ]
    publish_stage(workspace, ids, 0, [mesh_arrays(mesh) for mesh in MESHES])
    publish_stage(workspace, ids, 1, [remeshed_arrays(mesh, [(10_000, None)]) for mesh in MESHES], made)
    rng = np.random.default_rng(0)
    publish_stage(workspace, ids, 2, [features(rng) for _ in ids])


def publish_stage(
    workspace: Workspace, ids: list[int], position: int, arrays: list[dict[str, np.ndarray]], meshes: Sequence = ()
) -> None:
    """One block of what the stage at this position of the chain made."""
    stages = description_stages(workspace, workspace.catalog.list_collections()[0])
    stage, shapes = stages[position], workspace.catalog.shapes_by_id(ids)
    block = workspace.arrays.write_block(stage.block_kind, arrays)
    runs = [
        NewStageRun(
            shape_id,
            stage.name,
            chain_keys(shapes[shape_id], stages)[position],
            row,
            summary={"mesh_hash": MESHES[row].content_hash()},
        )
        for row, shape_id in enumerate(ids)
    ]
    new = NewBlock(block.name, stage.block_kind.name, block.n_shapes, block.n_bytes, block.checksum)
    workspace.catalog.publish_block(new, runs, meshes=meshes)


def features(rng: np.random.Generator) -> dict[str, np.ndarray]:
    codes = rng.integers(0, 128, (len(LABELS), N_BINS), dtype=np.uint8) + (LABELS == 1)[:, None].astype(np.uint8) * 100
    return {
        "shape_context": codes,
        "shape_context_scale": np.asarray(0.01, dtype=np.float32),
        "spin_image": codes[:, ::-1].copy(),
        "spin_image_scale": np.asarray(0.01, dtype=np.float32),
        "shape_diameter": np.ones(len(LABELS), dtype=np.float32),
        "light_field": np.zeros(N_LIGHT_FIELD, dtype=np.uint8),
    }


def label(workspace: Workspace, collection: Collection, number: int, labels: np.ndarray, kind: str = "human") -> int:
    """Commits labels of a shape; returns the revision's id."""
    catalog = workspace.catalog
    people = catalog.list_people()
    author = people[0].id if people else catalog.add_person("ann").id
    shape = catalog.shape_by_key(collection.id, f"{number}.off")
    new = NewRevision(shape.id, MESHES[number].content_hash(), RevisionKind(kind), author, 1, labels)
    return catalog.add_revision(new).id


def train(workspace: Workspace, collection: Collection) -> Model:
    return train_collection(workspace, collection, lambda done, n_total: None)


def test_without_labels_there_is_nothing_to_train_on(described) -> None:
    with pytest.raises(NotEnoughDataError, match="confirm those"):
        train(*described)


def test_labels_that_cannot_be_learned_from_yet_are_not_said_to_be_missing(described) -> None:
    workspace, collection = described
    revision_id = label(workspace, collection, 0, LABELS)
    workspace.catalog.add_review(revision_id, NewReview(ReviewReason.MAP_BACK))
    with pytest.raises(NotEnoughDataError, match=r"those of all 1 labelled shapes .+ `partwise reviews`"):
        train(workspace, collection)


def test_labels_on_meshes_that_are_not_described_are_not_said_to_wait(described) -> None:
    workspace, collection = described
    revision_id = label(workspace, collection, 0, LABELS)
    label(workspace, collection, 1, LABELS)
    workspace.catalog.add_review(revision_id, NewReview(ReviewReason.MAP_BACK))
    mesh = replace(workspace.config.mesh, max_faces=1000)
    other = replace(workspace, config=replace(workspace.config, mesh=mesh))
    with pytest.raises(NotEnoughDataError, match=r"none of 2 labelled shapes.+\(1 wait for a review\)"):
        train(other, collection)


def test_reference_labels_are_never_trained_on(described) -> None:
    label(*described, 0, LABELS, "reference")
    with pytest.raises(NotEnoughDataError):
        train(*described)


def test_shapes_without_a_labelled_face_alone_are_not_enough(described) -> None:
    label(*described, 0, np.zeros_like(LABELS))
    with pytest.raises(NotEnoughDataError):
        train(*described)


def test_labels_of_another_mesh_are_left_out(described) -> None:
    workspace, collection = described
    label(workspace, collection, 0, LABELS)
    shape = workspace.catalog.shape_by_key(collection.id, "0.off")
    other = remeshed_arrays(MESHES[1], [(10_000, None)])
    new = NewMesh(shape.id, MESHES[1].content_hash(), MESHES[1].n_vertices, MESHES[1].n_faces, 0)
    key = chain_keys(shape, description_stages(workspace, collection))[1]
    block = workspace.arrays.write_block(REMESH, [other])
    workspace.catalog.publish_block(
        NewBlock(block.name, "remesh", block.n_shapes, block.n_bytes, block.checksum),
        [NewStageRun(shape.id, "remesh", key, 0, summary={"mesh_hash": new.mesh_hash})],
        meshes=[new],
    )
    assert list(labelled_shapes(workspace, collection)) == []


def test_labels_that_wait_for_a_review_are_left_out(described) -> None:
    workspace, collection = described
    label(workspace, collection, 0, LABELS)
    shape = workspace.catalog.shape_by_key(collection.id, "0.off")
    head = workspace.catalog.head_revision(shape.id)
    assert head is not None
    review = workspace.catalog.add_review(head.id, NewReview(ReviewReason.MAP_BACK))
    assert list(labelled_shapes(workspace, collection)) == []
    workspace.catalog.accept_review(review.id, head.author_id)
    assert len(list(labelled_shapes(workspace, collection))) == 1


def test_labels_of_other_parts_are_left_out_until_somebody_finds_them_right(described) -> None:
    workspace, collection = described
    for number in range(2):
        label(workspace, collection, number, LABELS)
    workspace.catalog.update_part(collection.id, 1, name="cap")
    assert len(list(labelled_shapes(workspace, collection))) == 2
    workspace.catalog.add_part(collection.id, "lid")
    collection = workspace.catalog.get_collection("balls")
    assert list(labelled_shapes(workspace, collection)) == []
    author = workspace.catalog.list_people()[0]
    assert accept_all(workspace.catalog, collection.id, ReviewReason.SCHEMA, author.id) == 2
    assert len(list(labelled_shapes(workspace, collection))) == 2


def test_shapes_described_under_other_parameters_are_left_out(described) -> None:
    workspace, collection = described
    label(workspace, collection, 0, LABELS)
    mesh = replace(workspace.config.mesh, max_faces=1000)
    other = replace(workspace, config=replace(workspace.config, mesh=mesh))
    assert len(list(labelled_shapes(workspace, collection))) == 1
    assert list(labelled_shapes(other, collection)) == []


def test_the_configurations_recipe_is_the_one_trained(described) -> None:
    assert recipe_of(described[0].config.train).n_iterations == 20


@dataclass(frozen=True)
class Trained:
    workspace: Workspace
    collection: Collection
    revisions: list[int]
    model: Model


@pytest.fixture(scope="module")
def trained(local_ray: None, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Trained]:
    """A model of the labels of shapes 0 to 2, where shape 3 has labels that say nothing of any face."""
    with described_balls(tmp_path_factory.mktemp("training") / "ws") as (workspace, collection):
        revisions = [label(workspace, collection, number, LABELS) for number in range(3)]
        label(workspace, collection, 3, np.zeros_like(LABELS))
        yield Trained(workspace, collection, revisions, train(workspace, collection))


def train_here(trained: Trained, recipe: Recipe) -> TrainingResult:
    """In this process, on one thread."""
    trainer = _Trainer(trained.workspace.array_url)
    with training_batches(trained.workspace, trained.collection) as batches:
        for batch in batches:
            trainer.add(batch.shapes)
        return trainer.fit((1, 2), recipe, None, n_threads=1)


def test_the_same_seed_gives_the_same_weights_whatever_the_threads(trained: Trained) -> None:
    recipe = recipe_of(trained.workspace.config.train)
    again = train_here(trained, recipe)
    assert again.weights_key == trained.model.weights_key


def test_another_seed_gives_other_weights(trained: Trained) -> None:
    again = train_here(trained, replace(recipe_of(trained.workspace.config.train), seed=1))
    assert again.weights_key != trained.model.weights_key


def test_labels_come_in_batches_whose_blocks_are_gone_afterwards(trained: Trained, monkeypatch) -> None:
    monkeypatch.setattr(training, "BATCH_SHAPES", 2)
    arrays = trained.workspace.arrays
    before = arrays.block_names()
    with training_batches(trained.workspace, trained.collection) as batches:
        found = list(batches)
        assert [len(batch.shapes) for batch in found] == [2, 1]
        assert [id_ for batch in found for id_ in batch.revision_ids] == trained.revisions
        for batch in found:
            assert batch.part_ids == {1, 2}
            for shape in batch.shapes:
                read = arrays.read(shape.labels.block_name, shape.labels.row, "labels")
                np.testing.assert_array_equal(read, LABELS)
    assert arrays.block_names() == before


def test_large_labels_make_small_batches(trained: Trained, monkeypatch) -> None:
    monkeypatch.setattr(training, "BATCH_BYTES", LABELS.nbytes)
    with training_batches(trained.workspace, trained.collection) as batches:
        assert [len(batch.shapes) for batch in batches] == [1, 1, 1]


def test_training_leaves_nothing_but_the_model(trained: Trained) -> None:
    visible = [block.name for block in trained.workspace.catalog.visible_blocks()]
    assert sorted(visible) == list(trained.workspace.arrays.block_names())


def test_shapes_without_a_labelled_face_are_left_out(trained: Trained) -> None:
    assert sorted(trained.workspace.catalog.trained_on(trained.model.id)) == sorted(trained.revisions)


def test_the_files_of_a_model_on_record_are_there(trained: Trained) -> None:
    assert read_model(trained.workspace.arrays, ModelReference.of(trained.model)).part_ids == (1, 2)


def test_the_recipe_on_record_says_how_the_model_came_to_be(trained: Trained) -> None:
    recipe = json.loads(json.dumps(trained.model.recipe))
    assert recipe["recipe"]["n_iterations"] == 20
    assert recipe["smoothness"] == recipe["tuning"]["smoothness"]


def test_a_training_process_that_dies_is_one_clear_error(local_ray: None, described, monkeypatch) -> None:
    workspace, collection = described
    label(workspace, collection, 0, LABELS)
    endless = replace(workspace.config.train, n_iterations=1_000_000)
    workspace = replace(workspace, config=replace(workspace.config, train=endless))
    monkeypatch.setattr(training, "POLL_S", 0.1)
    is_killed = threading.Event()

    def kill(done: int, n_total: int) -> None:
        if not is_killed.is_set():
            is_killed.set()
            for process in psutil.Process().children(recursive=True):
                if "ray::_Trainer" in " ".join(process.cmdline()):
                    os.kill(process.pid, signal.SIGKILL)

    with pytest.raises(WorkerError, match="its process died"):
        train_collection(workspace, collection, kill)
    assert workspace.catalog.latest_model(collection.id) is None
