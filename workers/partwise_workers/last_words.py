"""What a process leaves in staging for its driver: the step that it is in, and its sentinel's last words.

The array store is what every node of a cluster reaches, so that the driver reads both wherever the process was.
"""

import json
import re
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from partwise.errors import NotFoundError, StoreError
from partwise.store.array_store import ArrayStore
from partwise_workers.tasks import StagedName

PROGRESS = "progress"
LAST_WORDS = "last_words"
_CONTENT = "json"
_FATAL = re.compile(r"Fatal Python error: (.+)")
_NOISE = re.compile(r"^(Extension modules: |:actor_name:|:job_id:).*\n?", re.MULTILINE)


@dataclass(frozen=True, slots=True)
class LastWords:
    """log : the end of what the process printed in its last step. is_over_memory : it was killed for its memory."""

    log: str = ""
    peak_bytes: int = 0
    is_over_memory: bool = False

    @classmethod
    def of(cls, log: bytes, peak_bytes: int, is_over_memory: bool) -> "LastWords":
        """Of a raw log, which may hold anything: databases take no zero characters."""
        text = log.decode("utf-8", errors="replace").replace("\x00", "\ufffd")
        return cls(_NOISE.sub("", text).strip(), peak_bytes, is_over_memory)

    @property
    def fatal_error(self) -> str | None:
        """What the interpreter said of the signal that ended it, such as "Segmentation fault"."""
        found = _FATAL.search(self.log)
        return found[1].strip() if found else None

    def arrays(self) -> dict[str, np.ndarray]:
        """As staged."""
        return _staged(asdict(self))


def last_words_name(name: StagedName, actor_id: str) -> str:
    """Where an actor's last words about a stage's result go; `StagedName.parse` takes it for one with a longer key."""
    return f"{LAST_WORDS}/{name}.{actor_id}"


def take_last_words(arrays: ArrayStore, staged_as: str) -> LastWords | None:
    """Reads and deletes them; None if there are none (yet)."""
    content = _take(arrays, staged_as)
    return None if content is None else LastWords(**content)


def progress_name(name: StagedName, actor_id: str) -> str:
    """Where an actor says which step of a stage it is in: two runs may have the same shape in hand."""
    return f"{PROGRESS}/{name}.{actor_id}"


@dataclass(frozen=True, slots=True)
class Progress:
    """step : that a stage is in. began_s : seconds into its call; clocks of two machines are never compared.

    refused : steps before it that it has refused, each with the stage's record of it.
    """

    step: str
    began_s: float
    refused: Mapping[str, Mapping[str, Any]]


def note_progress(arrays: ArrayStore, name: StagedName, actor_id: str, progress: Progress) -> None:
    """Says how far a stage has come."""
    arrays.stage(progress_name(name, actor_id), _staged(asdict(progress)))


def read_progress(arrays: ArrayStore, name: StagedName, actor_id: str) -> Progress | None:
    """How far a stage has come; None if it has not begun a step."""
    content = _read(arrays, progress_name(name, actor_id))
    return None if content is None else Progress(**content)


def take_progress(arrays: ArrayStore, name: StagedName, actor_id: str) -> Progress | None:
    """Reads and deletes it, when the process has died."""
    content = _take(arrays, progress_name(name, actor_id))
    return None if content is None else Progress(**content)


def _staged(content: Mapping[str, Any]) -> dict[str, np.ndarray]:
    return {_CONTENT: np.frombuffer(json.dumps(content).encode(), dtype=np.uint8)}


def _read(arrays: ArrayStore, staged_as: str) -> dict[str, Any] | None:
    """None for a damaged object too: it is an aid, and the store being down shows soon enough elsewhere."""
    try:
        content: dict[str, Any] = json.loads(arrays.read_staged(staged_as)[_CONTENT].tobytes())
    except (NotFoundError, StoreError):
        return None
    return content


def _take(arrays: ArrayStore, staged_as: str) -> dict[str, Any] | None:
    content = _read(arrays, staged_as)
    if content is not None:
        arrays.delete_staged(staged_as)
    return content
