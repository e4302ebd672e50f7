"""The two kinds of actor: one runs stages on single shapes and stages the results, one packs them into blocks."""

import hashlib
import json
import logging
import os
import time
import traceback
import uuid
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from typing import Any

import numpy as np
import ray

from partwise.config import StageLimits
from partwise.errors import NotFoundError, PartwiseError, StageRefusedError, StoreError
from partwise.store.array_store import ArrayStore, BlockAddress
from partwise.store.blocks import BlockKind
from partwise.store.open_arrays import open_array_store
from partwise.store.ragged import ragged_quantities
from partwise.store.records import FailureKind
from partwise_workers.last_words import Progress, last_words_name, note_progress, progress_name
from partwise_workers.sentinel import resident_bytes
from partwise_workers.stage import RunStage, Stage, StageResult, reason_of
from partwise_workers.tasks import ShapeTask, StageCall, StagedName, StagedResult, StageFailure, StageReport, Started
from partwise_workers.watch import Sentinel, Unwatched, Watch

logger = logging.getLogger(__name__)

ACCOUNT = "_account"
"""Beside a staged result's arrays, as JSON, for a run that finds it after a crash: its summary and seconds, and what it
was made from, a digest for each array read: remeshing twice need not give the same mesh under the same key."""


class _TaskInputs:
    """Implements `ShapeInputs`: arrays made earlier of this shape, else read from their blocks."""

    def __init__(self, arrays: ArrayStore, task: ShapeTask) -> None:
        self._arrays = arrays
        self.task = task
        self._made: dict[str, Mapping[str, np.ndarray]] = {}

    def source(self) -> tuple[bytes, str]:
        return self._arrays.get_bytes(self.task.source_object), self.task.source_key

    def array(self, stage: str, quantity: str) -> np.ndarray:
        if stage in self._made:
            return self._made[stage][quantity]
        place = self.task.finished[stage]
        return self._arrays.read(place.block_name, place.row, quantity)

    def add(self, stage: str, made: Mapping[str, np.ndarray]) -> None:
        self._made[stage] = made

    def are_behind(self, made: Mapping[str, np.ndarray]) -> bool:
        """Whether a staged result was made from what is read here; otherwise another run has replaced that since."""
        read: dict[str, str] | None = _account(made).get("read")
        return read is not None and all(
            digest == _digest(self.array(*_unlisted(name))) for name, digest in read.items()
        )


class _CallInputs:
    """Implements `ShapeInputs` for one try of one stage: a task's inputs, and the stage's steps.

    read : digest of each array read so far, by stage and quantity.

    What is refused is told with the next step, as a process that dies in between has nothing to do there.
    """

    def __init__(self, inputs: _TaskInputs, call: StageCall, on_step: Callable[[Progress], None]) -> None:
        self.source = inputs.source
        self.read: dict[str, str] = {}
        self._inputs = inputs
        self._failed_steps = call.failed_steps
        self._refused_steps = dict(call.refused_steps)
        self._on_step = on_step
        self._started = time.monotonic()

    def array(self, stage: str, quantity: str) -> np.ndarray:
        found = self._inputs.array(stage, quantity)
        self.read[f"{stage}/{quantity}"] = _digest(found)
        return found

    @property
    def failed_steps(self) -> Mapping[str, str]:
        return self._failed_steps

    @property
    def refused_steps(self) -> Mapping[str, Mapping[str, Any]]:
        return self._refused_steps

    def begin(self, step: str) -> None:
        self._on_step(Progress(step, time.monotonic() - self._started, self._refused_steps))

    def refuse(self, step: str, record: Mapping[str, Any]) -> None:
        self._refused_steps[step] = record


class _StageWorker:
    """Runs one stage on one shape at a time. `start` comes first; what it opens lives as long as the actor.

    What a stage raises is the shape's fault and comes back as its failure. What `start` raises, and a store that
    refuses or cannot be reached, is not, and goes to the driver as an exception, which ends the run.

    Parameters
    ----------
    actor_id : unique; the last words of this process are staged under it.
    limits : of each stage. The sentinel bounds memory by them; None: the process is not the actor's own to watch.
    """

    def __init__(
        self,
        array_url: str,
        stages: Sequence[Stage],
        actor_id: str = "",
        limits: Mapping[str, StageLimits] | None = None,
    ) -> None:
        self._array_url = array_url
        self._stages = {stage.name: stage for stage in stages}
        self._actor_id = actor_id
        self._limits = limits
        self._opened: dict[str, RunStage] = {}
        self._stack = ExitStack()
        self._watch: Watch = Unwatched()
        self._inputs: _TaskInputs | None = None

    def start(self) -> Started:
        """Opens the store and the stages."""
        if self._limits is not None:
            self._watch = Sentinel(self._array_url)
        self._arrays: ArrayStore = open_array_store(self._array_url)
        for name, stage in self._stages.items():
            self._opened[name] = self._stack.enter_context(stage.open(self._arrays))
        node_id = ray.get_runtime_context().get_node_id() if ray.is_initialized() else ""
        return Started(resident_bytes(os.getpid()), node_id)

    def close(self) -> None:
        """Closes what `start` opened."""
        self._stack.close()

    def run(self, call: StageCall) -> StageReport:
        """Runs a stage, unless its result is staged already. A task's stages are called in order, from the first.

        What they make is kept for those after them until another task comes.
        """
        if self._inputs is None or self._inputs.task != call.task:
            self._inputs = _TaskInputs(self._arrays, call.task)
        self._begin(call, None)
        try:
            made = self._result_of(call, self._inputs)
        finally:
            self._watch.idle()
        if isinstance(made, StageFailure) or call.stage == call.task.stage_keys[-1][0]:
            self._inputs = None  # holds arrays
        else:
            self._inputs.add(call.stage, made)
        result = made if isinstance(made, StageFailure) else _staged_result(call, made)
        return StageReport(result, resident_bytes(os.getpid()))

    def _result_of(self, call: StageCall, inputs: _TaskInputs) -> Mapping[str, np.ndarray] | StageFailure:
        if (staged := self._staged(call.name, inputs)) is not None:
            return staged
        started = time.perf_counter()
        result: Mapping[str, np.ndarray] | StageFailure
        try:
            result = self._make(call, inputs, started)
        except (Exception, SystemExit) as error:  # noqa: BLE001 - the task's edge: one bad mesh never costs the run
            if isinstance(error, StoreError):
                self._require_store()
            result = _failure(call, error, time.perf_counter() - started)
        else:
            self._arrays.stage(str(call.name), result)
        self._forget_steps(call)
        return result

    def _forget_steps(self, call: StageCall) -> None:
        if self._stages[call.stage].n_steps > 1:
            self._arrays.delete_staged(progress_name(call.name, self._actor_id))

    def _begin(self, call: StageCall, progress: Progress | None) -> None:
        """Tells the driver and the sentinel which step the stage is in, None before the first."""
        if progress is not None:
            note_progress(self._arrays, call.name, self._actor_id, progress)
        if self._limits is not None:
            self._watch.at(last_words_name(call.name, self._actor_id), self._limits[call.stage].memory_gb)

    def _staged(self, name: StagedName, inputs: _TaskInputs) -> Mapping[str, np.ndarray] | None:
        """A result that an earlier try or run left; None if it is to be made: damaged, or from other inputs."""
        try:
            staged = self._arrays.read_staged(str(name))
            return staged if inputs.are_behind(staged) else None
        except (NotFoundError, StoreError, KeyError):  # of other code, it may name what is not there
            return None

    def _make(self, call: StageCall, inputs: _TaskInputs, started: float) -> dict[str, np.ndarray]:
        own = _CallInputs(inputs, call, lambda progress: self._begin(call, progress))
        result: StageResult = self._opened[call.stage](own)
        ragged_quantities(
            self._stages[call.stage].block_kind, [result.arrays]
        )  # refused here, it costs only this shape
        seconds = time.perf_counter() - started
        account = json.dumps({"summary": result.summary, "seconds": seconds, "read": own.read})
        return {**result.arrays, ACCOUNT: np.frombuffer(account.encode(), dtype=np.uint8)}

    def _require_store(self) -> None:
        """Tells a store that is down, which raises `StoreError` here, from one damaged object."""
        probe = f"probe/{uuid.uuid4().hex}"
        self._arrays.stage(probe, {"probe": np.zeros(1, dtype=np.uint8)})
        self._arrays.delete_staged(probe)


def _staged_result(call: StageCall, made: Mapping[str, np.ndarray]) -> StagedResult:
    account = _account(made)
    n_bytes = sum(array.nbytes for array in made.values())
    return StagedResult(call.stage, call.key, str(call.name), n_bytes, account["seconds"], account["summary"])


def _account(made: Mapping[str, np.ndarray]) -> dict[str, Any]:
    account: dict[str, Any] = json.loads(made[ACCOUNT].tobytes())
    return account


def _digest(array: np.ndarray) -> str:
    """Of the values alone, the same whether they come from staging or from a block."""
    return hashlib.blake2b(np.ascontiguousarray(array).tobytes(), digest_size=16).hexdigest()


def _unlisted(name: str) -> tuple[str, str]:
    stage, _, quantity = name.partition("/")
    return stage, quantity


def _failure(call: StageCall, error: BaseException, seconds: float) -> StageFailure:
    kind = FailureKind.MEMORY if isinstance(error, MemoryError) else FailureKind.ERROR
    if isinstance(error, PartwiseError):
        known = error.detail if isinstance(error, StageRefusedError) else {}
        return StageFailure(call.stage, call.key, kind, reason_of(error), seconds, known)
    detail = {"traceback": "".join(traceback.format_exception(error))}
    return StageFailure(call.stage, call.key, kind, reason_of(error), seconds, detail)


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

    def pack(self, kind: BlockKind, seconds: Mapping[str, float]) -> Packed:
        """Writes one block of the staged results, in order. It stays invisible until the catalog names it.

        Results that are no longer staged are left out: another run on the same workspace has published them. So are
        those that somebody has replaced, such as an actor of a driver that died: the arrays of one try must never be
        put on record with the summary of another.

        Parameters
        ----------
        seconds : of each result by the name it is staged as; no two tries take the same to the last digit.
        """
        found: list[str] = []
        shapes: list[Mapping[str, np.ndarray]] = []
        for name in seconds:
            try:
                staged = self._arrays.read_staged(name)
            except NotFoundError:
                continue
            if _account(staged)["seconds"] != seconds[name]:
                continue
            found.append(name)
            shapes.append({quantity: array for quantity, array in staged.items() if quantity != ACCOUNT})
        return Packed(self._arrays.write_block(kind, shapes) if shapes else None, tuple(found))

    def clear(self, names: Sequence[str]) -> None:
        """Lets go of staged results whose block the catalog names."""
        self._arrays.delete_staged_many(names)


StageWorker = ray.remote(_StageWorker)
Packer = ray.remote(_Packer)
