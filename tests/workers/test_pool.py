"""The pool by itself: what it makes of actors that are done when nobody has looked for a while."""

from types import SimpleNamespace

import pytest
import ray

from partwise.config import StageLimits
from partwise_workers import pool
from partwise_workers.actors import StageWorker
from partwise_workers.pool import ActorPool
from partwise_workers.supervision import Rules

pytestmark = pytest.mark.usefixtures("local_ray")


def test_what_finished_while_the_driver_was_busy_is_taken_though_its_deadline_has_passed(
    make_bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    bench = make_bench({"a.off": ""})
    limits = {stage.name: StageLimits() for stage in bench.stages}
    arrays, url = bench.workspace.arrays, bench.workspace.array_url
    workers = ActorPool(
        lambda actor_id: StageWorker.remote(url, bench.stages, actor_id, limits),
        1,
        Rules(limits, dict.fromkeys(limits, 1), max_attempts=1, recycle_after=200),
        arrays,
    )
    workers.collect(ray.wait(workers.references())[0])
    workers.submit(next(bench.plan()))
    ray.wait(workers.references())
    monkeypatch.setattr(pool, "time", SimpleNamespace(monotonic=lambda: float("inf")))
    assert workers.collect([]) == []  # its first stage is done, and the second one is begun
    assert not workers.is_mourning
    assert workers.n_in_flight == 1
    workers.close()
