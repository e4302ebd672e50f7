"""Jobs: what is asked for, and how far it is."""

from dataclasses import replace
from datetime import datetime
from typing import Literal

from pydantic import JsonValue

from partwise.store.records import Job, JobKind, JobState, Role
from partwise_service.schemas.base import Answer, Request

Kind = Literal[JobKind.PREPROCESS, JobKind.TRAIN, JobKind.EVALUATE, JobKind.REFINE, JobKind.SELECT]


class NoParameters(Request):
    """These jobs do what is missing; there is nothing to choose."""


class NewJob(Request):
    """What is to be done to a collection. If a job of this kind waits already, that is the one."""

    kind: Kind
    parameters: NoParameters = NoParameters()


class JobProgress(Answer):
    """total : null while it is unknown. message : one line for people."""

    done: int
    failed: int
    total: int | None
    message: str


class JobOut(Answer):
    """A job. attempts : how often it was begun. message : how it stands, or why it ended as it did.

    cancel_requested : it is asked to stop, and will between two shapes. result : small figures, once it is done.
    Operators alone are told parameters, result, and a message that names files or places on machines.
    """

    id: int
    collection_id: int
    kind: JobKind
    state: JobState
    parameters: dict[str, JsonValue]
    attempts: int
    progress: JobProgress
    cancel_requested: bool
    created_at: datetime
    started_at: datetime | None
    heartbeat_at: datetime | None
    finished_at: datetime | None
    message: str
    result: dict[str, JsonValue] | None

    @classmethod
    def of(cls, job: Job, role: Role) -> "JobOut":
        """The job as it is told to callers of a role: not which process works on it."""
        about = job.progress
        if role.includes(Role.OPERATOR):
            about = replace(about, message=job.full_message)
        else:
            job = replace(job, parameters={}, result=None)
        progress = JobProgress(done=about.n_done, failed=about.n_failed, total=about.n_total, message=about.message)
        same = {name: getattr(job, name) for name in cls.model_fields if name not in ("progress", "message")}
        return cls(**same, progress=progress, message=about.message)


class JobsPage(Answer):
    """A page of jobs, newest first. `next` goes into `before` for the next page; null at the end."""

    items: list[JobOut]
    next: str | None = None
