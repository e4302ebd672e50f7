"""`Work`: what a handler of jobs is given, and what it hands back."""

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field
from typing import Any

from partwise.store.records import BACKGROUND_KINDS, EventKind, Job, JobKind, NewEvent, Progress
from partwise.store.records import Collection as ShapeCollection
from partwise.workspace.progress import RunProgress
from partwise.workspace.workspace import Workspace
from partwise_cli.jobs.pulse import Pulse
from partwise_workers.events import OnEvent


@dataclass(frozen=True, slots=True)
class Outcome:
    """How a job that is done went: one line for people, and small JSON."""

    message: str
    result: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, eq=False)
class Work:
    """A job in hand.

    owner : whose it is, as the catalog has it. kinds, collection_id : which jobs that owner takes, of which collection.
    connect : starts Ray, or joins a cluster, unless that was done for an earlier job.
    on_event : told what runs tell, whatever the job.
    """

    workspace: Workspace
    collection: ShapeCollection
    job: Job
    owner: str
    kinds: Collection[JobKind]
    collection_id: int | None
    pulse: Pulse
    connect: Callable[[], None]
    on_event: OnEvent

    def tell(self, run: RunProgress) -> None:
        """How far a run over shapes is."""
        self.pulse.tell(Progress(run.n_done, run.n_failed, run.n_total))

    def say(self, message: str) -> None:
        """What is being done, where that has no number."""
        self.pulse.tell(Progress(message=message))

    def add_event(self, kind: EventKind, payload: Mapping[str, Any]) -> None:
        """Tells open pages."""
        self.workspace.catalog.add_event(NewEvent(kind, self.collection.id, {**payload, "job_id": self.job.id}))

    def waiting_job(self, *, also_background: bool) -> Job | None:
        """The job that this owner would begin now if it were free."""
        kinds = [kind for kind in self.kinds if also_background or kind not in BACKGROUND_KINDS]
        return self.workspace.catalog.next_job(kinds, collection_id=self.collection_id) if kinds else None


Handler = Callable[[Work], Outcome | None]
"""Does a job. None : it has put the job's end on record itself.

What it raises ends the job: JobStoppedError as its reason says; StoreError, WorkerError and errors of Ray put it back
until it was begun a few times; anything else fails it, with the error's first line for people to read.
"""
