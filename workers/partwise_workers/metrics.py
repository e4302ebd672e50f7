"""`RunMetrics`: what a run tells, as metrics that Ray exports on every node for Prometheus.

They are labelled by stage and by kind of failure, of which there are few: what is per shape, run or person belongs into
the catalog. Ray puts `ray_` before each name, `_total` behind those of counters, and reports every ten seconds.
"""

from ray.util.metrics import Counter, Gauge, Histogram

from partwise_workers.events import ActorRestarted, InFlight, RunEvent, StageDone, StageFailed

SECONDS = (0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0)
"""Upper ends of the histogram's bins: half a decade each, from reading a mesh to the longest deadlines."""

RECYCLED = "recycled"
"""Instead of a kind of failure, where a process was replaced because it had done its share."""


class RunMetrics:
    """An `OnEvent` that counts. Needs a connected Ray; several in one process add to the same metrics."""

    def __init__(self) -> None:
        self._done = Counter("partwise_shapes_done", "Shapes that a stage is done for.", ("stage",))
        self._failed = Counter(
            "partwise_shapes_failed", "Shapes that a stage gave up, by what ended its last try.", ("stage", "kind")
        )
        self._seconds = Histogram(
            "partwise_stage_seconds", "Seconds that a stage took of a shape.", list(SECONDS), ("stage",)
        )
        self._in_flight = Gauge("partwise_shapes_in_flight", "Shapes in the hands of the run.")
        self._restarts = Counter(
            "partwise_actor_restarts", "Worker processes that were replaced, by what ended them.", ("kind",)
        )

    def __call__(self, event: RunEvent, /) -> None:
        match event:
            case StageDone(stage, seconds):
                self._done.inc(tags={"stage": stage})
                self._seconds.observe(seconds, tags={"stage": stage})
            case StageFailed(stage, kind):
                self._failed.inc(tags={"stage": stage, "kind": kind.value})
            case ActorRestarted(kind):
                self._restarts.inc(tags={"kind": RECYCLED if kind is None else kind.value})
            case InFlight(n):
                self._in_flight.set(n)
