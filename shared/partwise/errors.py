"""The exception tree. A message says the rule, the offending value and the remedy.

Each class also derives from the builtin that fits, so that callers who know nothing of Partwise catch it too.
"""

from collections.abc import Mapping
from typing import Any


class PartwiseError(Exception):
    """Anything Partwise refuses to do. The command line prints it as one line and exits non-zero."""


class MeshError(PartwiseError, ValueError):
    """A mesh breaks a rule: wrong shape, NaN, an index out of range, no faces."""


class DegenerateMeshError(MeshError):
    """A mesh is too flat, small or empty for what was asked: no area, a single point."""


class StageRefusedError(MeshError):
    """A stage tried what it could and refuses the shape. detail : JSON-able, what was tried, for the record."""

    def __init__(self, message: str, detail: Mapping[str, Any] | None = None) -> None:
        super().__init__(message)
        self.detail: Mapping[str, Any] = detail or {}


class FileFormatError(PartwiseError, ValueError):
    """A file is missing, empty, truncated or not what its name says."""


class LabelError(PartwiseError, ValueError):
    """Labels do not fit: wrong length, another mesh, a part that is not in the schema."""


class ParameterError(PartwiseError, ValueError):
    """A parameter is outside its documented range."""


class ConfigError(PartwiseError, ValueError):
    """`partwise.toml` has an unknown key, a wrong type or a value out of range."""


class StoreError(PartwiseError, OSError):
    """A store cannot be reached, is full, or holds something unexpected."""


class NotFoundError(PartwiseError, LookupError):
    """A shape, collection, model or key that was asked for is not there."""


class ConflictError(PartwiseError, ValueError):
    """What was asked contradicts what is already committed."""


class StaleDraftError(ConflictError):
    """A draft went on elsewhere. state : JSON-able, what is on record now, so that no side is lost."""

    def __init__(self, message: str, state: Mapping[str, Any]) -> None:
        super().__init__(message)
        self.state = state


class WorkerError(PartwiseError, RuntimeError):
    """Ray cannot be reached or started, or its processes do not stay alive, whatever the shape."""


class NotEnoughDataError(PartwiseError, ValueError):
    """Too few shapes or labels for what was asked."""
