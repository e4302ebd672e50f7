"""What a stage is: one shape's arrays in, one shape's arrays out, under a key that says what shaped them.

The key is a hash of the stage's name, code version and parameters and of the key of what it reads, so that running
again does nothing, and changing one stage's parameters redoes that stage and those after it, no more.
"""

import hashlib
import json
from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import Any, Protocol, TypeAlias

import numpy as np

from partwise.errors import PartwiseError
from partwise.store.array_store import ArrayStore
from partwise.store.blocks import BlockKind

MAX_REASON = 500
"""Characters of an unforeseen error that are kept as the reason; the traceback has the rest."""


@dataclass(frozen=True, slots=True, eq=False)
class StageResult:
    """arrays : one per quantity of the stage's block kind. summary : a small JSON-able account, kept in the catalog."""

    arrays: Mapping[str, np.ndarray]
    summary: Mapping[str, Any]


class ShapeInputs(Protocol):
    """What a stage may read of the shape in hand."""

    def source(self) -> tuple[bytes, str]:
        """The ingested file's bytes and its name, whose suffix tells the format."""

    def array(self, stage: str, quantity: str) -> np.ndarray:
        """One array that an earlier stage made of this shape."""

    @property
    def failed_steps(self) -> Mapping[str, str]:
        """Steps of this stage that ended its process on earlier tries of this shape, each with why, in order.

        Whoever runs the stage again skips them, and says so in the summary.
        """

    @property
    def refused_steps(self) -> Mapping[str, Mapping[str, Any]]:
        """Steps of this stage that it refused on earlier tries of this shape, each with its record, in order.

        Whoever runs the stage again passes them over, as they would take as long to be refused again.
        """

    def begin(self, step: str) -> None:
        """Says which of its steps the stage is in from now on; each has the stage's deadline to itself.

        For stages with `n_steps` > 1 only. The name is made of letters, digits, `.`, `_`, `-` and spaces, and is the
        same on every try.
        """

    def refuse(self, step: str, record: Mapping[str, Any]) -> None:
        """Says that a step has ended without a result. record : JSON-able, all that the summary is to say of it."""


RunStage: TypeAlias = Callable[[ShapeInputs], StageResult]
"""Raises whatever is wrong with the shape; that costs the shape, never the run."""


class Stage(Protocol):
    """A frozen, picklable recipe."""

    @property
    def name(self) -> str: ...

    @property
    def reads(self) -> str | None:
        """The stage before this one, whose key is part of this one's; None for the ingested source."""

    @property
    def block_kind(self) -> BlockKind: ...

    @property
    def identity(self) -> Mapping[str, object]:
        """Code version and parameters, JSON-able: all that shapes the result besides what is read."""

    @property
    def n_steps(self) -> int:
        """Ways that the stage may try one after the other, each announced by `ShapeInputs.begin`; 1 without steps.

        A step that ends the process is passed over on the next try, so that a stage gets a try for each.
        """

    def open(self, arrays: ArrayStore) -> AbstractContextManager[RunStage]:
        """What costs much to make (renderer, model) is made once in each actor and closed when the actor ends.

        What it raises is no shape's fault and ends the run.
        """
        ...


def stage_key(stage: Stage, input_key: str) -> str:
    """SHA-256 (hex) over what shapes the stage's result; `input_key` is the source's hash or the read stage's key."""
    content = {"stage": stage.name, "identity": stage.identity, "input": input_key}
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def reason_of(error: BaseException) -> str:
    """Why something failed, in one line: one of our errors in its own words, any other with its type."""
    if isinstance(error, PartwiseError):
        return str(error)
    return f"{type(error).__name__}: {error}".strip().splitlines()[0][:MAX_REASON]
