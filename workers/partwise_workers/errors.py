"""What ends a run beside the errors of `partwise` itself."""

from partwise.errors import PartwiseError


class WorkerError(PartwiseError, RuntimeError):
    """Ray's processes cannot be started, or do not stay alive, whatever the shape."""
