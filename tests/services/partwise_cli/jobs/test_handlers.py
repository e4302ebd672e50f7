"""What each kind of job does beside the passes themselves, which are the workers' and replaced here."""

import numpy as np
import pytest
from safetensors.numpy import save

from partwise.store.records import EventKind, JobKind, JobState, NewModel, NewRevision, RevisionKind
from partwise.testing.workspaces import ingest, publish_features, publish_meshes, save_model
from partwise.workspace.first_shapes import select_first_shapes
from partwise.workspace.placed_shapes import read_placed
from partwise.workspace.progress import RunProgress
from partwise.workspace.relabel import MoveReport
from partwise.workspace.shapes import load_mesh
from partwise_cli.jobs.handlers import HANDLERS
from partwise_cli.jobs.stopping import JobStoppedError, StopReason
from partwise_workers import evaluation, passes, training
from partwise_workers.events import StageDone


@pytest.fixture
def do(worker, enqueue, workspace):
    """Does a job of a kind with its true handler, without Ray; the job as it ended."""

    def do(kind: JobKind):
        job = enqueue(kind)
        made = worker({kind: HANDLERS[kind]})
        made._cluster.connect = lambda: None
        made.work_once()
        return workspace.catalog.job(job.id)

    return do


def _waiting(workspace, collection_id: int) -> list[JobKind]:
    return [job.kind for job in workspace.catalog.jobs(collection_id, state=JobState.PENDING)]


def _events(workspace, kind: EventKind) -> list:
    return [event.payload for event in workspace.catalog.events(after=0) if event.kind is kind]


@pytest.fixture
def preprocessing(monkeypatch):
    """A pass that finds one shape to describe and moves the labels of two."""

    def run(workspace, collection, on_progress, on_event, on_moved, may_go_on) -> RunProgress:
        on_event(StageDone("describe", 1.0))
        on_progress(RunProgress(1, 0, 1))
        on_moved(MoveReport(2, 1, 0))
        return RunProgress(1, 0, 1)

    monkeypatch.setattr(passes, "preprocess", run)


def test_preprocessing_chooses_the_first_shapes_once(do, workspace, collection_id, preprocessing) -> None:
    ended = do(JobKind.PREPROCESS)
    assert (ended.state, ended.progress.message) == (JobState.DONE, "1 shape preprocessed, 0 failed")
    assert ended.result == {"n_done": 1, "n_failed": 0, "n_moved": 2, "n_in_review": 1}
    firsts = workspace.catalog.first_shapes(collection_id)
    assert len(firsts) == 2
    workspace.catalog.replace_first_shapes(collection_id, firsts[:1])
    do(JobKind.PREPROCESS)
    assert len(workspace.catalog.first_shapes(collection_id)) == 1


@pytest.fixture
def describe(workspace, collection_id):
    """So many further shapes, described: `describe(3)`; their ids."""
    rng = np.random.default_rng(1)
    first = next(iter(workspace.catalog.shapes(collection_id)))
    mesh = load_mesh(workspace, workspace.catalog.meshes([first.id])[first.id])

    def describe(n: int) -> list[int]:
        collection = workspace.catalog.get_collection("mugs")
        n_before = sum(workspace.catalog.state_counts(collection_id).values())
        ids = list(ingest(workspace, collection, {f"new{n_before + k}.off": mesh for k in range(n)}).values())
        publish_meshes(workspace, dict.fromkeys(ids, mesh))
        publish_features(workspace, ids, rng)
        return ids

    return describe


def _placed(workspace, collection_id: int):
    return read_placed(workspace, workspace.catalog.embedding(collection_id).key)


def test_preprocessing_places_what_came_since_in_the_embedding_that_there_is(
    do, workspace, collection_id, preprocessing, describe
) -> None:
    do(JobKind.PREPROCESS)
    n_fitted = _placed(workspace, collection_id).n_fitted
    (new,) = describe(1)
    do(JobKind.PREPROCESS)
    placed = _placed(workspace, collection_id)
    assert (placed.n_fitted, len(placed.shape_ids), placed.shape_ids[-1]) == (n_fitted, n_fitted + 1, new)
    assert new in workspace.catalog.clusters([new])


def test_preprocessing_fits_anew_once_there_are_twice_as_many(
    do, workspace, collection_id, preprocessing, describe
) -> None:
    do(JobKind.PREPROCESS)
    n_fitted = _placed(workspace, collection_id).n_fitted
    describe(n_fitted)
    do(JobKind.PREPROCESS)
    assert _placed(workspace, collection_id).n_fitted == 2 * n_fitted


def test_selecting_fits_anew_with_as_many_clusters_as_before(do, workspace, collection_id, describe) -> None:
    describe(12)
    collection = workspace.catalog.get_collection("mugs")
    select_first_shapes(workspace, collection, 3, 4, seed=0)
    (new,) = describe(1)
    ended = do(JobKind.SELECT)
    assert ended.state is JobState.DONE
    assert ended.progress.message == "the map is drawn, and 12 shapes chosen to be labelled first"
    placed = _placed(workspace, collection_id)
    assert (placed.n_clusters, new in placed.shape_ids) == (3, True)


def test_selecting_from_too_few_says_what_is_missing(do, workspace, collection_id) -> None:
    shape_ids = [shape.id for shape in workspace.catalog.shapes(collection_id)]
    runs = workspace.catalog.stage_runs(shape_ids, "describe").values()
    for name in {run.block_name for run in runs}:
        workspace.catalog.supersede_block(name)
    ended = do(JobKind.SELECT)
    assert ended.state is JobState.FAILED
    assert "needs 2 described ones" in ended.progress.message


def test_preprocessing_asks_for_an_evaluation_where_there_is_a_model(
    do, workspace, collection_id, preprocessing
) -> None:
    do(JobKind.PREPROCESS)
    assert _waiting(workspace, collection_id) == []
    save_model(workspace, workspace.catalog.get_collection("mugs"))
    do(JobKind.PREPROCESS)
    assert _waiting(workspace, collection_id) == [JobKind.EVALUATE]


def test_preprocessing_tells_how_far_its_stages_are(do, workspace, preprocessing) -> None:
    do(JobKind.PREPROCESS)
    (told,) = _events(workspace, EventKind.STAGE)
    assert (told["stage"], told["done"], told["failed"]) == ("describe", 1, 0)


def test_a_training_publishes_its_model_with_its_end(do, workspace, collection_id, monkeypatch) -> None:
    def train(workspace, collection, on_progress, on_event) -> NewModel:
        on_progress(1, 2)
        return NewModel(collection.id, {}, "models/x.safetensors", ())

    monkeypatch.setattr(training, "trained_model", train)
    ended = do(JobKind.TRAIN)
    assert (ended.state, ended.result["model_version"]) == (JobState.DONE, 1)
    assert _waiting(workspace, collection_id) == [JobKind.EVALUATE]


def test_a_cancelled_training_leaves_no_model(do, workspace, collection_id, monkeypatch) -> None:
    def train(workspace, collection, on_progress, on_event) -> NewModel:
        (job,) = workspace.catalog.jobs(collection_id)
        workspace.catalog.cancel_job(job.id)
        while True:  # until it is told, by what the callback raises
            on_progress(1, 2)

    monkeypatch.setattr(training, "trained_model", train)
    assert do(JobKind.TRAIN).state is JobState.CANCELLED
    assert workspace.catalog.latest_model(collection_id) is None


def test_an_evaluation_goes_on_with_a_newer_model(do, workspace, monkeypatch) -> None:
    collection, seen = workspace.catalog.get_collection("mugs"), []

    def evaluate(workspace, collection, model, shape_ids, on_progress, on_event, may_go_on) -> RunProgress:
        if not seen:
            save_model(workspace, collection)
        seen.append(model.version)
        on_progress(RunProgress(len(shape_ids), 0, len(shape_ids)))
        return RunProgress(len(shape_ids), 0, len(shape_ids))

    monkeypatch.setattr(evaluation, "evaluate_in_order", evaluate)
    save_model(workspace, collection)
    ended = do(JobKind.EVALUATE)
    assert seen == [1, 2]
    assert ended.progress.message == "6 shapes evaluated by model version 2, 0 failed"


def test_an_evaluation_begins_with_what_is_most_like_the_newly_confirmed(do, workspace, monkeypatch) -> None:
    seen = []

    def evaluate(workspace, collection, model, shape_ids, on_progress, on_event, may_go_on) -> RunProgress:
        seen.extend(shape_ids)
        on_progress(RunProgress(len(shape_ids), 0, len(shape_ids)))
        return RunProgress(len(shape_ids), 0, len(shape_ids))

    monkeypatch.setattr(evaluation, "evaluate_in_order", evaluate)
    collection = workspace.catalog.get_collection("mugs")
    a, b, c = (shape.id for shape in workspace.catalog.shapes(collection.id))
    points = np.array([[10.0, 0.0], [0.0, 0.0], [1.0, 0.0]], dtype=np.float32)
    workspace.arrays.put_bytes("embeddings/x", save({"shape_ids": np.array([a, b, c]), "points": points}))
    workspace.catalog.set_embedding(collection.id, "embeddings/x")
    ann, mesh = workspace.catalog.add_person("ann"), workspace.catalog.meshes([c])[c]
    labels = np.ones(mesh.n_faces, dtype=np.uint16)
    confirmed = workspace.catalog.add_revision(
        NewRevision(c, mesh.mesh_hash, RevisionKind.HUMAN, ann.id, collection.schema_version, labels, None)
    )
    workspace.catalog.save_model(NewModel(collection.id, {}, "models/x", (confirmed.id,)))
    assert do(JobKind.EVALUATE).state is JobState.DONE
    assert seen == [c, b, a]


def test_an_evaluation_needs_a_model(do) -> None:
    ended = do(JobKind.EVALUATE)
    assert ended.state is JobState.FAILED
    assert "has no model yet" in ended.progress.message


def test_a_refinement_that_gives_way_is_not_over(do, workspace, enqueue, monkeypatch) -> None:
    def refine(workspace, collection, on_progress, on_event, may_go_on) -> RunProgress:
        raise JobStoppedError(StopReason.GIVES_WAY, "gives way to job 9")

    monkeypatch.setattr(passes, "refine", refine)
    left = do(JobKind.REFINE)
    assert (left.state, left.progress.message) == (JobState.PENDING, "gives way to job 9")


def test_the_queue_follows_the_settings(do, workspace, collection_id) -> None:
    workspace.catalog.update_collection_settings(collection_id, {"labels_per_shape": 2})
    assert do(JobKind.REFILL).state is JobState.DONE
    assert workspace.catalog.queue_depth(collection_id).n_free == 6
