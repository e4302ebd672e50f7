"""A chain of stages that compute nothing: what is left of a run is what the machinery around stages takes."""

from collections.abc import Mapping
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass

import numpy as np

from partwise.store.array_store import ArrayStore
from partwise.store.blocks import BlockKind, Domain, Quantity
from partwise_workers.stage import RunStage, ShapeInputs, StageResult

NOOP = BlockKind("noop", (Quantity("nothing", Domain.SHAPE, "uint8"),))


@dataclass(frozen=True, slots=True)
class NoopStage:
    """Makes one byte of a shape, and reads neither its file nor what earlier stages made.

    reads : the stage before it in the chain.
    """

    name: str
    reads: str | None

    @property
    def block_kind(self) -> BlockKind:
        return NOOP

    @property
    def n_steps(self) -> int:
        return 1

    @property
    def identity(self) -> Mapping[str, object]:
        return {"version": 1}

    def open(self, arrays: ArrayStore) -> AbstractContextManager[RunStage]:  # noqa: ARG002 - the protocol's
        return nullcontext(self._run)

    def _run(self, inputs: ShapeInputs) -> StageResult:  # noqa: ARG002 - as every stage's
        return StageResult({"nothing": np.zeros((), dtype=np.uint8)}, {"is_noop": True})


def noop_chain(n_stages: int) -> tuple[NoopStage, ...]:
    """So many stages, each reading the one before."""
    names = [f"noop{number}" for number in range(1, n_stages + 1)]
    return tuple(NoopStage(name, before) for name, before in zip(names, [None, *names], strict=False))
