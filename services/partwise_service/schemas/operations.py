"""How a collection is doing: stages, queue, leases, scores, disk, workers, people, rounds."""

from datetime import datetime

from partwise.store.records import FailureKind, JobKind, ModelRound, PersonFigures, ShapeState
from partwise_service.schemas.base import Answer


class StageFigures(Answer):
    """done, failed : shapes with a present result, and shapes given up. remaining : shapes that wait for the stage.

    What an older model predicted is no present result, nor is what a running job does again after changed settings.

    per_min : done a minute, over `window_min`. eta_s : seconds until none remains at that pace; null while it is 0.
    """

    stage: str
    done: int
    failed: int
    remaining: int
    per_min: float
    eta_s: float | None


class QueueFigures(Answer):
    """free, held : labels that wait for a person, and that one is at. oldest_at : since when the oldest waits."""

    free: int
    held: int
    assigned: int
    oldest_at: datetime | None


class LeaseFigures(Answer):
    """held : shapes in people's hands, of which prefetched ones are loaded ahead. expired : others, free to anybody."""

    held: int
    prefetched: int
    expired: int
    people: int


class FreshnessRow(Answer):
    """Shapes whose latest score is of this model version, and their share of all that have one, [0, 1]."""

    model_version: int
    shapes: int
    share: float


class BlockFigures(Answer):
    """Blocks of one kind in the array store, of all collections."""

    kind: str
    blocks: int
    bytes: int


class DiskFigures(Answer):
    """Of the whole workspace. array_bytes : of all blocks. free_bytes : left where a local store is; null elsewhere."""

    database_bytes: int
    array_bytes: int
    free_bytes: int | None


class WorkerUsageOut(Answer):
    """What a worker takes of its machine. memory_bytes : of its own process, in RAM.

    n_actors, actor_bytes : of the processes that compute for it, wherever they run. free_bytes : left on the disk of
    the array store where that is a folder of its machine; null elsewhere.
    """

    memory_bytes: int
    n_actors: int
    actor_bytes: int
    free_bytes: int | None


class WorkerFigures(Answer):
    """A worker, at a job or waiting for one. silent_s : seconds since its last sign of life; the jobs of one that is
    silent for long are taken over by others.

    is_busy : it is at a job; job_id, job_kind, done, total : of that, where it is one of the collection, else null.
    usage : null where it has not told it lately.
    """

    owner: str
    is_busy: bool
    job_id: int | None
    job_kind: JobKind | None
    silent_s: float | None
    done: int | None
    total: int | None
    usage: WorkerUsageOut | None


class OpsOut(Answer):
    """As it was at `measured_at`, some seconds ago at most.

    states : shapes by state. failures : failed runs by kind. open_reviews : that wait for a reviewer.
    score_name : what the queue is ranked by; freshness : which models those scores are of, newest first.
    """

    measured_at: datetime
    states: dict[ShapeState, int]
    stages: list[StageFigures]
    window_min: float
    failures: dict[FailureKind, int]
    queue: QueueFigures
    leases: LeaseFigures
    model_version: int | None
    score_name: str
    freshness: list[FreshnessRow]
    open_reviews: int
    blocks: list[BlockFigures]
    disk: DiskFigures
    workers: list[WorkerFigures]


class PersonOps(Answer):
    """What a person confirmed in the last days.

    seconds_per_shape, clicks_per_shape : means from their strokes, without idle times; labels_per_h : at that pace.
    n_checks, blind_accuracy : blind checks, and the mean share of the area they got right. Null where nothing is known.
    """

    person_id: int
    name: str
    labels: int
    active_h: float
    labels_per_h: float | None
    seconds_per_shape: float | None
    clicks_per_shape: float | None
    last_at: datetime
    n_checks: int
    blind_accuracy: float | None

    @classmethod
    def of(cls, person: PersonFigures) -> "PersonOps":
        """The figures as they are told."""
        timed = person.n_timed
        return cls(
            person_id=person.person_id,
            name=person.name,
            labels=person.n_confirmed,
            active_h=person.active_s / 3600,
            labels_per_h=3600 * timed / person.active_s if person.active_s else None,
            seconds_per_shape=person.active_s / timed if timed else None,
            clicks_per_shape=person.n_clicks / timed if timed else None,
            last_at=person.last_at,
            n_checks=person.n_checks,
            blind_accuracy=person.area_agreement,
        )


class PeopleOps(Answer):
    """By name; whoever confirmed nothing is left out."""

    days: float
    items: list[PersonOps]


class RoundOut(Answer):
    """A model and the time until the next one. training_s : null if nobody noted it.

    n_scored, mean_score : shapes that it scored, and the mean of `score_name`; null before it has.
    n_checks, blind_accuracy : blind checks in that time, and the mean share of the area that people got right.
    """

    model_version: int
    trained_at: datetime
    training_s: float | None
    n_shapes: int
    n_scored: int
    mean_score: float | None
    n_checks: int
    blind_accuracy: float | None

    @classmethod
    def of(cls, found: ModelRound) -> "RoundOut":
        """The round as it is told."""
        return cls(
            model_version=found.version,
            trained_at=found.trained_at,
            training_s=found.train_s,
            n_shapes=found.n_shapes,
            n_scored=found.n_scores,
            mean_score=found.mean_score,
            n_checks=found.n_checks,
            blind_accuracy=found.area_agreement,
        )


class RoundsOut(Answer):
    """Newest first. score_name : what the queue is ranked by."""

    score_name: str
    items: list[RoundOut]


class SkipOut(Answer):
    """A shape that a person gave back for good. reason : in their words."""

    shape_id: int
    source_key: str
    person_id: int
    person_name: str
    reason: str
    skipped_at: datetime


class SkipsPage(Answer):
    """A page of skipped shapes, newest first. `next` goes into `before` for the next page; null at the end."""

    items: list[SkipOut]
    next: str | None = None
