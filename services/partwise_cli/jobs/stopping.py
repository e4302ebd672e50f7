"""Why a job stops before its end."""

from enum import Enum


class StopReason(Enum):
    """What ends the work on a job, and what then becomes of the job."""

    CANCELLED = "cancelled"  # somebody asked for it: the job is over
    LOST = "lost"  # it counts as lost, or is another owner's by now: leave it alone
    GIVES_WAY = "gives way"  # to other work: it is begun again


class JobStoppedError(Exception):
    """Raised by what works on a job, between two pieces of it. message : one line for people."""

    def __init__(self, reason: StopReason, message: str) -> None:
        super().__init__(message)
        self.reason = reason
