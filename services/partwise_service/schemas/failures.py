"""Quarantined shapes: what failed and why, and which of it is tried again."""

from datetime import datetime
from typing import Annotated

from pydantic import Field

from partwise.store.records import Failure, FailureKind
from partwise_service.schemas.base import NO_NUL, Answer, AnyId, Request
from partwise_service.schemas.jobs import JobOut

MAX_NAMED = 500
StageName = Annotated[str, Field(pattern="^[a-z_]{1,64}$")]


class FailureOut(Answer):
    """A shape that a stage gave up after `attempts` tries: what ended it, and why in one line."""

    shape_id: int
    source_key: str
    stage: str
    kind: FailureKind
    message: str
    attempts: int
    at: datetime

    @classmethod
    def of(cls, failure: Failure) -> "FailureOut":
        """The failure as it is told. What was recorded without a kind is an error."""
        run = failure.run
        return cls(
            shape_id=run.shape_id,
            source_key=failure.source_key,
            stage=run.stage,
            kind=FailureKind(run.summary.get("kind", FailureKind.ERROR)),
            message=run.reason or "",
            attempts=run.attempts,
            at=run.finished_at,
        )


class Retry(Request):
    """Which failures are forgotten: those that meet all that is given, all if nothing is. text : in their message."""

    shape_ids: Annotated[list[AnyId], Field(min_length=1, max_length=MAX_NAMED)] | None = None
    kind: Annotated[FailureKind, Field(strict=False)] | None = None
    stage: StageName | None = None
    text: Annotated[str, Field(max_length=200), NO_NUL] = ""


class Retried(Answer):
    """n_retried : failures forgotten. job : that tries again; null where there was nothing to forget."""

    n_retried: int
    job: JobOut | None
