"""SIGKILL of `partwise work` at random moments of every kind of job, each with its own Ray.

Whenever it dies, the worker after it does what is left, and everything is done once: one model for each training,
one result for each shape and stage, nothing lost and nothing failed.
"""

import io
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
import zipfile
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from datetime import timedelta
from pathlib import Path

import numpy as np
import pytest
import trimesh

from partwise.io.off import format_off
from partwise.mesh import TriMesh
from partwise.store.array_store import BlockAddress
from partwise.store.large_objects import read_chunks
from partwise.store.records import EventKind, Job, JobKind, JobState, RevisionKind, ShapeState
from partwise.workspace.export_archive import find_export
from partwise.workspace.labelling import commit_labels
from partwise.workspace.shapes import all_shapes, load_mesh, shape_mesh
from partwise.workspace.uploads import begin_upload, uploads
from partwise.workspace.workspace import Workspace, init_collection, open_workspace

pytestmark = [pytest.mark.slow, pytest.mark.timeout(1800)]

N_SHAPES, N_LABELLED, N_ROUNDS, SEED = 16, 3, 2, 5
MAX_LOSSES = 2
"""Of one job: the third time that its worker is lost it fails, as whatever it does may be what kills them."""
MAX_DELAY_S = {
    JobKind.INGEST: 0.3,
    JobKind.PREPROCESS: 12.0,
    JobKind.TRAIN: 6.0,
    JobKind.EVALUATE: 6.0,
    JobKind.EXPORT: 0.3,
}
EXPORT = {"segmentation": "predicted", "format": "seg", "on": "working"}
ENDS_WITHIN_S = 600.0
POLL_S = 0.05
SETTINGS = """
[workers]
n_actors = 2
block_shapes = 4
max_attempts = 10

[jobs]
poll_s = 0.2
pulse_s = 0.2
lost_after_s = 6.0

[train]
n_iterations = 60
n_snapshots = 2

[describe.light_field]
renderer = "raycast"
"""


@dataclass
class Lab:
    """The workspace, and whoever works on it at the moment."""

    workspace: Workspace
    collection_id: int
    log: Path
    rng: np.random.Generator
    worker: "subprocess.Popen[bytes] | None" = None
    n_kills: Counter[str] = field(default_factory=Counter)

    def start(self) -> None:
        command = [sys.executable, "-c", "from partwise_cli.main import main; main()", "work", self.workspace.path]
        with self.log.open("ab") as log:
            self.worker = subprocess.Popen(command, stdout=log, stderr=log, start_new_session=True)

    def kill(self) -> None:
        assert self.worker is not None
        self.worker.send_signal(signal.SIGKILL)
        self.worker.wait()

    def finish(self, job: Job) -> Job:
        """The job once it has ended, its worker killed at random moments meanwhile."""
        n_losses, until = 0, time.monotonic() + ENDS_WITHIN_S
        while not (job := self.workspace.catalog.job(job.id)).is_over:
            assert time.monotonic() < until, (job, self.log.read_text()[-3000:])
            assert self.worker is not None
            assert self.worker.poll() is None, self.log.read_text()[-3000:]
            if job.state is JobState.RUNNING and job.attempts > n_losses and n_losses < MAX_LOSSES:
                pause(self.rng.uniform(0, MAX_DELAY_S[job.kind]))
                self.kill()
                n_losses = self.workspace.catalog.job(job.id).attempts
                self.n_kills[job.kind] += 1
                self.start()
            pause(POLL_S)
        return job

    def finish_what_came_of_it(self) -> None:
        for job in self.workspace.catalog.jobs(self.collection_id):
            if not job.is_over:
                self.finish(job)


def pause(seconds: float) -> None:
    threading.Event().wait(seconds)


def upload_balls(lab: Lab, first: int) -> str:
    """Sends bumpy balls of 320 faces, no two alike, in an archive."""
    rng = np.random.default_rng(first)
    ball = trimesh.creation.icosphere(subdivisions=2)
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w") as made:
        for number in range(first, first + N_SHAPES):
            bumps = 1 + 0.2 * rng.random((len(ball.vertices), 1))
            made.writestr(f"{number:02d}.off", format_off(TriMesh(ball.vertices * bumps, ball.faces)))
    writer = begin_upload(lab.workspace, lab.collection_id, "balls.zip", "oscar", timedelta(days=1), 8)
    writer.write(archive.getvalue())
    return writer.finish().name


@contextmanager
def open_lab(folder: Path) -> Iterator[Lab]:
    init_collection(folder / "ws", "balls", ["top", "bottom"], {"working_faces": 500, "train_after": 0})
    with (folder / "ws" / "partwise.toml").open("a", encoding="utf-8") as file:
        file.write(SETTINGS)
    with open_workspace(folder / "ws") as workspace:
        collection_id = workspace.catalog.get_collection("balls").id
        lab = Lab(workspace, collection_id, folder / "worker.log", np.random.default_rng(SEED))
        lab.start()
        try:
            yield lab
        finally:
            lab.kill()


def label(lab: Lab, first: int) -> None:
    """Labels a few shapes as a person would have."""
    collection = lab.workspace.catalog.get_collection("balls")
    for shape in list(all_shapes(lab.workspace.catalog, lab.collection_id))[first : first + N_LABELLED]:
        mesh = load_mesh(lab.workspace, shape_mesh(lab.workspace, shape))
        labels = np.where(mesh.vertices[mesh.faces].mean(axis=1)[:, 1] > 0, 1, 2).astype(np.uint16)
        commit_labels(lab.workspace, collection, shape, labels, RevisionKind.HUMAN, "ann")


def test_everything_is_done_once_whenever_workers_are_killed() -> None:
    with tempfile.TemporaryDirectory(prefix="pw") as name, open_lab(Path(name)) as lab:
        catalog = lab.workspace.catalog
        for number in range(N_ROUNDS):
            sent = {"upload_id": upload_balls(lab, number * N_SHAPES)}
            lab.finish(catalog.enqueue_job(lab.collection_id, JobKind.INGEST, sent))
            lab.finish_what_came_of_it()
            label(lab, number * N_SHAPES)
            lab.finish(catalog.enqueue_job(lab.collection_id, JobKind.TRAIN))
            lab.finish_what_came_of_it()
            check_export(lab, lab.finish(catalog.enqueue_job(lab.collection_id, JobKind.EXPORT, EXPORT)))
            assert {job.state for job in catalog.jobs(lab.collection_id)} == {JobState.DONE}
            assert [model.version for model in catalog.models(lab.collection_id)] == list(range(number + 1, 0, -1))
        assert min(lab.n_kills[kind] for kind in MAX_DELAY_S) >= N_ROUNDS
        check(lab)
        os.write(1, f"\nkilled: {dict(lab.n_kills)}\n".encode())


def check_export(lab: Lab, job: Job) -> None:
    """All that has a prediction is in it, and it is whole."""
    assert job.result is not None
    made = find_export(lab.workspace, lab.collection_id, job.result["download"])
    with zipfile.ZipFile(io.BytesIO(b"".join(read_chunks(lab.workspace.arrays, made)))) as archive:
        assert archive.testzip() is None
        n_shapes = sum(name.endswith(".seg") for name in archive.namelist())
    assert n_shapes == job.result["n_written"] == sum(lab.workspace.catalog.state_counts(lab.collection_id).values())


def check(lab: Lab) -> None:
    """Nothing is missing, failed or there twice."""
    catalog = lab.workspace.catalog
    n_all = N_SHAPES * N_ROUNDS
    assert uploads(lab.workspace, lab.collection_id) == []
    counts = {count.stage: (count.n_done, count.n_failed) for count in catalog.stage_counts(lab.collection_id)}
    assert counts == dict.fromkeys(("mesh", "remesh", "describe", "picture", "evaluate", "refine"), (n_all, 0))
    newest = catalog.latest_model(lab.collection_id)
    assert newest is not None
    ids = [shape.id for shape in all_shapes(catalog, lab.collection_id)]
    assert {score.model_id for score in catalog.scores(ids, "entropy").values()} == {newest.id}
    assert catalog.state_counts(lab.collection_id)[ShapeState.CONFIRMED] == N_LABELLED * N_ROUNDS
    assert catalog.queue_depth(lab.collection_id).n_free == n_all - N_LABELLED * N_ROUNDS
    published = [event for event in catalog.events(after=0) if event.kind is EventKind.TRAINING]
    assert [event.payload["model_version"] for event in published] == list(range(1, N_ROUNDS + 1))
    for block in catalog.visible_blocks():
        lab.workspace.arrays.verify(BlockAddress(block.name, block.n_shapes, block.n_bytes, block.checksum))
