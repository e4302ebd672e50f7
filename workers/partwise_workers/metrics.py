"""`RunMetrics` and `CollectionMetrics`: what a run tells and how collections are doing, as metrics that Ray exports on
every node for Prometheus.

They are labelled by stage, kind of failure and collection, of which there are few: what is per shape, run or person
belongs into the catalog. Ray puts `ray_` before each name, `_total` behind those of counters, and reports every ten
seconds.
"""

from ray.util.metrics import Counter, Gauge, Histogram

from partwise.workspace.figures import CollectionFigures
from partwise.workspace.progress import RunProgress
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
        self._left = Gauge("partwise_shapes_left", "Shapes that the run has yet to finish.")
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

    def on_progress(self, run: RunProgress) -> None:
        """Implements `OnRunProgress`."""
        self._left.set(run.n_total - run.n_done - run.n_failed)

    def end(self) -> None:
        """The run is over, however it ended: nothing is left of it to wait for."""
        self._left.set(0)
        self._in_flight.set(0)


class CollectionMetrics:
    """Figures of collections, by name. Needs a connected Ray."""

    def __init__(self) -> None:
        gauges = {
            "n_free": ("queue_free", "Labels that shapes wait for."),
            "n_held": ("queue_held", "Labels that somebody is at work on."),
            "oldest_s": ("queue_oldest_seconds", "For how long a label has been waited for at most."),
            "fresh_share": ("scores_fresh_share", "Share of the scored shapes that the newest model has scored."),
            "model_version": ("model_version", "The newest model."),
            "train_s": ("train_seconds", "Seconds that its training took."),
            "mean_score": ("mean_score", "Mean of the scores that it gave."),
            "agreement": ("blind_agreement", "Area on which people agree with known labels since it is the newest."),
        }
        self._gauges = {
            field: Gauge(f"partwise_{name}", about, ("collection",)) for field, (name, about) in gauges.items()
        }
        self._stored = Gauge("partwise_stored_bytes", "What the database and the blocks on record take.")

    def tell(self, collection: str, figures: CollectionFigures) -> None:
        """The figures of one collection; what has no number keeps the last one."""
        for field, gauge in self._gauges.items():
            value = getattr(figures, field)
            if value is not None:
                gauge.set(value, tags={"collection": collection})

    def tell_stored(self, n_bytes: int) -> None:
        self._stored.set(n_bytes)
