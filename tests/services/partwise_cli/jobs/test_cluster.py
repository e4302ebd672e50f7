"""Ray is started for a job, and joined where it runs already; Ray itself is replaced here."""

from contextlib import nullcontext

import pytest

from partwise.errors import WorkerError
from partwise_cli.jobs.cluster import AGAIN_S, Cluster
from partwise_workers import cluster as ray_cluster


class _Clock:
    now_s = 0.0

    def __call__(self) -> float:
        return self.now_s


@pytest.fixture
def tries(monkeypatch) -> list[object]:
    """A member for each connection that is tried; the first one fails."""
    made: list[object] = []

    def connected():
        made.append(None)
        if len(made) == 1:
            raise WorkerError("nobody listens")
        return nullcontext()

    monkeypatch.setattr(ray_cluster, "connected", connected)
    return made


def test_a_cluster_that_runs_is_joined_and_tried_again_a_while_later(tries, monkeypatch, caplog) -> None:
    monkeypatch.setenv("RAY_ADDRESS", "ray:6379")
    clock = _Clock()
    cluster = Cluster(clock=clock)
    cluster.join()
    cluster.join()
    assert (len(tries), cluster.is_connected) == (1, False)
    assert "nobody listens" in caplog.text
    clock.now_s = AGAIN_S
    cluster.join()
    cluster.join()
    assert (len(tries), cluster.is_connected) == (2, True)


def test_where_none_runs_none_is_started_before_a_job_needs_it(tries, monkeypatch) -> None:
    monkeypatch.delenv("RAY_ADDRESS", raising=False)
    Cluster().join()
    assert tries == []


def test_a_worker_that_waits_for_jobs_joins(worker, monkeypatch) -> None:
    made = worker({})

    def joined() -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(made._cluster, "join", joined)
    with pytest.raises(KeyboardInterrupt):
        made.run()
