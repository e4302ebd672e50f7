"""From confirming in the browser to the next shape: training, evaluation and a queue ranked anew, by jobs.

A service and a worker meet on one workspace of a few simulated mugs; nothing else calls the stages.
"""

import uuid
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fastapi.testclient import TestClient

from partwise.io.write import write_mesh
from partwise.simulate.collection import CATEGORIES, simulate_collection
from partwise.store.records import EventKind, JobKind, JobState, NewToken, Role, ShapeState
from partwise.testing.postgres import keep_catalog_in, postgres_database
from partwise.workspace.ingest import ingest_folder
from partwise.workspace.shapes import load_mesh, shape_mesh
from partwise.workspace.workspace import Workspace, init_collection, open_workspace
from partwise_cli.jobs.cluster import Cluster
from partwise_cli.jobs.handlers import HANDLERS
from partwise_cli.jobs.worker import Worker
from partwise_service.app import create_app
from partwise_service.settings import ServiceSettings

N_SHAPES, N_FACES, N_CONFIRMED = 5, 1000, 2
API = "/api/v1"
SETTINGS = """
[workers]
n_actors = 1

[jobs]
pulse_s = 0.2

[train]
n_iterations = 20
n_snapshots = 2

[describe.light_field]
renderer = "raycast"
"""


@dataclass(frozen=True)
class Lab:
    """A workspace whose jobs `work` does, and its service in the name of an operator."""

    workspace: Workspace
    collection_id: int
    client: TestClient
    person_id: int

    def work(self) -> None:
        Worker(self.workspace, HANDLERS, Cluster()).run(once=True)

    def post(self, path: str, **body: Any) -> Any:
        answer = self.client.post(f"{API}{path}", json=body)
        assert answer.status_code < 300, answer.text
        return answer.json()

    def get(self, path: str) -> Any:
        return self.client.get(f"{API}{path}").json()

    def confirm_next(self) -> int:
        """Labels the next shape of the queue as a person would; its id."""
        lease = self.post("/queue/claim", collection_id=self.collection_id)["items"][0]
        shape_id = lease["shape_id"]
        shape = self.workspace.catalog.shape(shape_id)
        mesh = load_mesh(self.workspace, shape_mesh(self.workspace, shape))
        heights = mesh.vertices[mesh.faces].mean(axis=1)[:, 1]
        is_upper = heights > np.median(heights)
        draft = self.post(f"/leases/{lease['id']}/draft")
        faces = [(np.flatnonzero(is_upper), 1), (np.flatnonzero(~is_upper), 2)]
        strokes = [self._stroke(n, rows, label) for n, (rows, label) in enumerate(faces)]
        self.post(f"/drafts/{draft['id']}/strokes", expected_sequence=0, strokes=strokes)
        self.post(f"/leases/{lease['id']}/complete", n_strokes=len(strokes))
        return int(shape_id)

    def _stroke(self, sequence: int, rows: np.ndarray, label: int) -> dict[str, Any]:
        return {
            "v": 1,
            "kind": "assign",
            "runs": [[int(row), 1] for row in rows],
            "label": label,
            "sequence": sequence,
            "base_revision": None,
            "id": str(uuid.uuid4()),
            "author_id": self.person_id,
            "at": "2026-01-31T12:00:00Z",
        }


@pytest.fixture(scope="module", params=["sqlite", pytest.param("postgres", marks=pytest.mark.slow)])
def lab(request: pytest.FixtureRequest, local_ray: None, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Lab]:
    """On PostgreSQL with the slow tests: the stages take their time whatever the catalog is in."""
    root = tmp_path_factory.mktemp("jobs")
    if request.param == "postgres":
        with postgres_database(request.getfixturevalue("postgres")) as url:
            keep_catalog_in(root / "ws", url)
            yield from _made(root)
    else:
        yield from _made(root)


def _made(root: Path) -> Iterator[Lab]:
    for shape in simulate_collection("mugs", N_SHAPES, 3, n_faces=N_FACES):
        write_mesh(shape.mesh, root / "shapes" / f"{shape.name}.off")
    init_collection(root / "ws", "mugs", CATEGORIES["mugs"].part_names, {"train_after": N_CONFIRMED})
    with (root / "ws" / "partwise.toml").open("a", encoding="utf-8") as file:
        file.write(SETTINGS)
    with open_workspace(root / "ws") as workspace:
        collection = workspace.catalog.get_collection("mugs")
        ingest_folder(workspace, collection, root / "shapes")
        person = workspace.catalog.add_person("oscar")
        until = datetime.now(UTC) + timedelta(hours=1)
        secret = workspace.catalog.issue_token(NewToken(person.id, Role.OPERATOR, until), "test").secret
        app = create_app(ServiceSettings(workspace=root / "ws"))
        with TestClient(app, headers={"Authorization": f"Bearer {secret}"}) as client:
            yield Lab(workspace, collection.id, client, person.id)


@pytest.fixture(scope="module")
def preprocessed(lab: Lab) -> Lab:
    lab.post(f"/collections/{lab.collection_id}/jobs", kind="preprocess")
    lab.work()
    return lab


@pytest.fixture(scope="module")
def trained(preprocessed: Lab) -> tuple[Lab, list[int]]:
    """After two shapes were confirmed and the worker had nothing left to do; their ids."""
    confirmed = [preprocessed.confirm_next() for _ in range(N_CONFIRMED)]
    preprocessed.work()
    return preprocessed, confirmed


def _jobs(lab: Lab) -> list[tuple[str, str]]:
    jobs = lab.get(f"/collections/{lab.collection_id}/jobs")["items"]
    return [(job["kind"], job["state"]) for job in reversed(jobs)]


def test_preprocessing_describes_and_chooses_the_first_shapes(preprocessed: Lab) -> None:
    catalog = preprocessed.workspace.catalog
    firsts = [first.shape_id for first in catalog.first_shapes(preprocessed.collection_id)]
    assert catalog.state_counts(preprocessed.collection_id)[ShapeState.READY] == N_SHAPES
    assert len(firsts) == 4
    shape_ids = [row.shape.id for row in catalog.list_shapes(preprocessed.collection_id)]
    assert set(catalog.clusters(shape_ids).values()) == {0, 1}
    assert catalog.ordering(preprocessed.collection_id) is not None


def test_confirming_enough_leads_to_a_model_and_an_evaluation(trained: tuple[Lab, list[int]]) -> None:
    lab, confirmed = trained
    assert _jobs(lab) == [("preprocess", "done"), ("train", "done"), ("evaluate", "done")]
    assert lab.workspace.catalog.model(lab.collection_id, 1).n_shapes == len(confirmed)
    done = {count.stage: count.n_done for count in lab.workspace.catalog.stage_counts(lab.collection_id)}
    assert (done["evaluate"], done["refine"]) == (N_SHAPES, N_SHAPES)


def test_the_queue_is_ranked_by_the_model(trained: tuple[Lab, list[int]]) -> None:
    lab, confirmed = trained
    catalog = lab.workspace.catalog
    waiting = catalog.highest_waiting(lab.collection_id, "entropy", N_SHAPES)
    assert set(waiting).isdisjoint(confirmed)
    scores = catalog.scores(waiting, "entropy")
    clusters = catalog.clusters(waiting)
    lease = lab.post("/queue/claim", collection_id=lab.collection_id)["items"][0]
    best_of_its_cluster = max(
        score.value for shape_id, score in scores.items() if clusters[shape_id] == clusters[lease["shape_id"]]
    )
    assert scores[lease["shape_id"]].value == best_of_its_cluster == max(score.value for score in scores.values())
    lab.post(f"/leases/{lease['id']}/release")


def test_open_pages_are_told(trained: tuple[Lab, list[int]]) -> None:
    lab, _ = trained
    events = lab.workspace.catalog.events(after=0)
    payloads = {kind: [event.payload for event in events if event.kind is kind] for kind in EventKind}
    assert [each["model_version"] for each in payloads[EventKind.TRAINING] if "model_version" in each] == [1]
    assert any(each.get("re_ranked", 0) > 0 for each in payloads[EventKind.QUEUE])
    assert {each["stage"] for each in payloads[EventKind.STAGE]} >= {"mesh", "describe", "evaluate", "refine"}
    states = [(each["job_kind"], each["state"]) for each in payloads[EventKind.JOB]]
    assert [state for kind, state in dict.fromkeys(states) if kind == "train"] == ["pending", "running", "done"]


def test_confirming_during_a_training_leaves_exactly_one_waiting(trained: tuple[Lab, list[int]]) -> None:
    lab, _ = trained
    catalog = lab.workspace.catalog
    lab.post(f"/collections/{lab.collection_id}/jobs", kind="train")
    running = catalog.claim_job("another worker", [JobKind.TRAIN])
    assert running is not None
    for _ in range(N_CONFIRMED):
        lab.confirm_next()
    lab.post(f"/collections/{lab.collection_id}/jobs", kind="train")
    (waiting,) = catalog.jobs(lab.collection_id, state=JobState.PENDING)
    assert waiting.kind is JobKind.TRAIN
    catalog.release_jobs("another worker", "test")
    assert _jobs(lab)[-2:] == [("train", "cancelled"), ("train", "pending")]
    lab.post(f"/jobs/{waiting.id}/cancel")


def test_a_job_that_cannot_be_done_says_why(lab: Lab) -> None:
    other = lab.workspace.catalog.create_collection("vases", ["neck"])
    job = lab.post(f"/collections/{other.id}/jobs", kind="train")
    lab.work()
    ended = lab.get(f"/jobs/{job['id']}")
    assert ended["state"] == "failed"
    assert "training needs labelled shapes but 'vases' has none" in ended["message"]


def test_more_labels_a_shape_are_more_places(trained: tuple[Lab, list[int]]) -> None:
    lab, _ = trained
    before = lab.workspace.catalog.queue_depth(lab.collection_id).n_free
    lab.client.patch(f"{API}/collections/{lab.collection_id}/settings", json={"labels_per_shape": 3})
    lab.work()
    assert lab.workspace.catalog.queue_depth(lab.collection_id).n_free == 3 * before
