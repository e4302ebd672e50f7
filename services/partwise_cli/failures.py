"""What the command line makes of an exception: one line and an exit code that means something."""

import errno
import sys
from dataclasses import dataclass

from partwise.errors import ConfigError, PartwiseError, StoreError, WorkerError

SOME_FAILED = 1
"""The command is done but some shapes or files failed."""
INPUT_ERROR = 3
STORE_ERROR = 4
FAULT = 70
INTERRUPTED = 130
EXIT_CODES = (
    "Exit codes: 0 done · 1 done, but some shapes or files failed · 2 wrong usage · 3 wrong input or configuration · "
    "4 a store or Ray cannot be reached or written · 70 a fault in partwise · 130 interrupted"
)


@dataclass(frozen=True, slots=True)
class Ending:
    """How a command that failed ends.

    is_fault : nobody foresaw it, so that its traceback is worth showing.
    is_domain : what was asked for cannot be done; the message is for whoever asked, and names no place on a machine.
    """

    code: int
    message: str
    is_fault: bool = False
    is_domain: bool = False


def ending_of(error: Exception) -> Ending:
    """The ending that an exception gets. What a remote process raised counts as raised here."""
    cause = getattr(error, "cause", None)  # of Ray's errors, whose own text holds a whole traceback
    if isinstance(cause, Exception):
        error = cause
    if isinstance(error, PartwiseError):
        is_of_a_machine = isinstance(error, StoreError | WorkerError)
        is_domain = not (is_of_a_machine or isinstance(error, ConfigError))
        return Ending(STORE_ERROR if is_of_a_machine else INPUT_ERROR, str(error), is_domain=is_domain)
    if isinstance(error, OSError):
        return Ending(STORE_ERROR, _of_the_system(error))
    if isinstance(error, MemoryError):
        return Ending(FAULT, "the machine ran out of memory; close other programs, or set n_actors lower in [workers]")
    if is_of_ray(error):
        return Ending(
            STORE_ERROR, f"Ray must work but: {_first_line(error)}; look at `partwise doctor`, then run again"
        )
    what = f"{type(error).__name__}: {_first_line(error)}"
    return Ending(FAULT, f"a fault in partwise, please report it with the lines above: {what}", is_fault=True)


def _of_the_system(error: OSError) -> str:
    where = f"{error.filename}: " if error.filename is not None else ""
    if error.errno in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG):
        return f"{where}files need room but the disk is full; free some space and run again"
    return f"{where}must be usable but: {error.strerror or _first_line(error)}; is it there, and may you use it?"


def is_of_ray(error: Exception) -> bool:
    """Whether Ray raised it."""
    exceptions = sys.modules.get("ray.exceptions")  # never loaded for this: commands without Ray stay quick
    return exceptions is not None and isinstance(error, exceptions.RayError)


def _first_line(error: Exception) -> str:
    return next((line.strip() for line in str(error).splitlines() if line.strip()), type(error).__name__)
