"""The two kinds of actor: one runs stages on single shapes and stages the results, one packs them into blocks."""

import json
import logging
import time
import traceback
import uuid
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass

import numpy as np
import ray

from partwise.errors import NotFoundError, PartwiseError, StoreError
from partwise.store.array_store import ArrayStore, BlockAddress
from partwise.store.blocks import BlockKind
from partwise.store.open import open_array_store
from partwise.store.ragged import ragged_quantities
from partwise_workers.stage import RunStage, Stage, StageResult
from partwise_workers.tasks import ShapeOutcome, ShapeTask, StagedName, StagedResult, StageFailure

logger = logging.getLogger(__name__)

ACCOUNT = "_account"
"""Beside a staged result's arrays: its summary and seconds as JSON, for a run that finds it after a crash."""

MAX_REASON = 500
"""Characters of an unforeseen error that are kept as the reason; the traceback has the rest."""


class _TaskInputs:
    """Implements `ShapeInputs`: arrays made earlier in this task, else read from their blocks."""

    def __init__(self, arrays: ArrayStore, task: ShapeTask) -> None:
        self._arrays = arrays
        self._task = task
        self._made: dict[str, Mapping[str, np.ndarray]] = {}

    def source(self) -> tuple[bytes, str]:
        return self._arrays.get_bytes(self._task.source_object), self._task.source_key

    def array(self, stage: str, quantity: str) -> np.ndarray:
        if stage in self._made:
            return self._made[stage][quantity]
        place = self._task.finished[stage]
        return self._arrays.read(place.block_name, place.row, quantity)

    @property
    def failed_steps(self) -> Mapping[str, str]:
        return {}

    def begin(self, step: str) -> None:
        pass

    def add(self, stage: str, made: Mapping[str, np.ndarray]) -> None:
        self._made[stage] = made


class _StageWorker:
    """Runs stages on one shape at a time. `start` comes first; what it opens lives as long as the actor.

    What a stage raises is the shape's fault and comes back as its failure. What `start` raises, and a store that
    refuses or cannot be reached, is not, and goes to the driver as an exception, which ends the run.
    """

    def __init__(self, array_url: str, stages: Sequence[Stage]) -> None:
        self._array_url = array_url
        self._stages = {stage.name: stage for stage in stages}
        self._opened: dict[str, RunStage] = {}
        self._stack = ExitStack()

    def start(self) -> None:
        """Opens the store and the stages."""
        self._arrays: ArrayStore = open_array_store(self._array_url)
        for name, stage in self._stages.items():
            self._opened[name] = self._stack.enter_context(stage.open(self._arrays))

    def close(self) -> None:
        """Closes what `start` opened."""
        self._stack.close()

    def run(self, task: ShapeTask) -> ShapeOutcome:
        """Runs the task's stages, one after the other, until one fails."""
        inputs = _TaskInputs(self._arrays, task)
        results: list[StagedResult] = []
        for stage, key in task.stage_keys:
            name = str(StagedName(stage, task.shape_id, key))
            made = self._staged(name)
            if made is None:
                started = time.perf_counter()
                try:
                    made = self._make(stage, inputs, started)
                except Exception as error:  # noqa: BLE001 - the task's edge: one bad mesh never costs the run
                    if isinstance(error, StoreError):
                        self._require_store()
                    failure = _failure(stage, key, error, time.perf_counter() - started)
                    return ShapeOutcome(task.shape_id, tuple(results), failure)
                self._arrays.stage(name, made)
            inputs.add(stage, made)
            results.append(_staged_result(stage, key, name, made))
        return ShapeOutcome(task.shape_id, tuple(results))

    def give_up(self, task: ShapeTask, reason: str) -> ShapeOutcome:
        """What earlier attempts, which died, had finished; the stage after that is the one that fails."""
        results: list[StagedResult] = []
        for stage, key in task.stage_keys:
            name = str(StagedName(stage, task.shape_id, key))
            made = self._staged(name)
            if made is None:
                return ShapeOutcome(task.shape_id, tuple(results), StageFailure(stage, key, reason, 0.0))
            results.append(_staged_result(stage, key, name, made))
        return ShapeOutcome(task.shape_id, tuple(results))

    def _staged(self, name: str) -> Mapping[str, np.ndarray] | None:
        """A result that an earlier attempt or run left; None if there is none, or a damaged one to be made again."""
        try:
            return self._arrays.read_staged(name)
        except (NotFoundError, StoreError):
            return None

    def _make(self, stage: str, inputs: _TaskInputs, started: float) -> dict[str, np.ndarray]:
        result: StageResult = self._opened[stage](inputs)
        ragged_quantities(self._stages[stage].block_kind, [result.arrays])  # refused here, it costs only this shape
        account = json.dumps({"summary": result.summary, "seconds": time.perf_counter() - started})
        return {**result.arrays, ACCOUNT: np.frombuffer(account.encode(), dtype=np.uint8)}

    def _require_store(self) -> None:
        """Tells a store that is down, which raises `StoreError` here, from one damaged object."""
        probe = f"probe/{uuid.uuid4().hex}"
        self._arrays.stage(probe, {"probe": np.zeros(1, dtype=np.uint8)})
        self._arrays.delete_staged(probe)


def _staged_result(stage: str, key: str, name: str, made: Mapping[str, np.ndarray]) -> StagedResult:
    account = json.loads(made[ACCOUNT].tobytes())
    n_bytes = sum(array.nbytes for array in made.values())
    return StagedResult(stage, key, name, n_bytes, account["seconds"], account["summary"])


def _failure(stage: str, key: str, error: Exception, seconds: float) -> StageFailure:
    if isinstance(error, PartwiseError):
        return StageFailure(stage, key, str(error), seconds)
    reason = f"{type(error).__name__}: {error}".strip().splitlines()[0][:MAX_REASON]
    return StageFailure(stage, key, reason, seconds, "".join(traceback.format_exception(error)))


@dataclass(frozen=True, slots=True)
class Packed:
    """A block as written, None if nothing was left to pack, and which of the names given are in it, in order."""

    address: BlockAddress | None
    names: tuple[str, ...]


class _Packer:
    """The one writer of blocks of a run."""

    def __init__(self, array_url: str) -> None:
        self._array_url = array_url
        self._opened: ArrayStore | None = None

    @property
    def _arrays(self) -> ArrayStore:
        """Opened on first use: what a method raises reaches the driver as it is, unlike what `__init__` does."""
        if self._opened is None:
            self._opened = open_array_store(self._array_url)
        return self._opened

    def pack(self, kind: BlockKind, names: Sequence[str]) -> Packed:
        """Writes one block of the staged results, in order. It stays invisible until the catalog names it.

        Results that are no longer staged are left out: another run on the same workspace has published them.
        """
        found: list[str] = []
        shapes: list[Mapping[str, np.ndarray]] = []
        for name in names:
            try:
                staged = self._arrays.read_staged(name)
            except NotFoundError:
                continue
            found.append(name)
            shapes.append({quantity: array for quantity, array in staged.items() if quantity != ACCOUNT})
        return Packed(self._arrays.write_block(kind, shapes) if shapes else None, tuple(found))


StageWorker = ray.remote(_StageWorker)
Packer = ray.remote(_Packer)
