"""The two kinds of actor: one runs stages on single shapes and stages the results, one packs them into blocks."""

import json
import logging
import time
import traceback
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import ray

from partwise.errors import NotFoundError, PartwiseError
from partwise.store.array_store import ArrayStore, BlockAddress
from partwise.store.blocks import BlockKind
from partwise.store.open import open_array_store
from partwise.store.records import StageRun
from partwise_workers.stage import ShapeInputs, Stage, StageResult

logger = logging.getLogger(__name__)

ACCOUNT = "_account"
"""Beside a staged result's arrays: its summary and seconds as JSON, for a run that finds it after a crash."""


@dataclass(frozen=True, slots=True)
class BlockRow:
    """Where a finished stage's arrays of one shape are: a published block and the shape's row in it."""

    block_name: str
    row: int


def block_row(run: StageRun | None) -> BlockRow | None:
    """Where a stage run's arrays are; None without a run or without arrays."""
    if run is None or run.block_name is None or run.row is None:
        return None
    return BlockRow(run.block_name, run.row)


@dataclass(frozen=True, slots=True)
class ShapeTask:
    """Ids only. Stages to run on one shape, in order, each with its key; and where earlier stages' arrays are."""

    shape_id: int
    source_key: str
    source_object: str
    stage_keys: tuple[tuple[str, str], ...]
    finished: Mapping[str, BlockRow]


@dataclass(frozen=True, slots=True)
class StagedResult:
    """One stage's result of one shape, waiting in the staging area to be packed."""

    stage: str
    key: str
    staged_as: str
    seconds: float
    summary: Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class StageFailure:
    """Why a stage gave up on a shape: one line for people, and the traceback where the cause was unforeseen."""

    stage: str
    key: str
    reason: str
    seconds: float
    detail: str = ""


@dataclass(frozen=True, slots=True)
class ShapeOutcome:
    """What an actor did with one task; stages after a failure did not run."""

    shape_id: int
    results: tuple[StagedResult, ...]
    failure: StageFailure | None = None


def staged_name(stage: str, shape_id: int, key: str) -> str:
    """The staging name of one result. It holds the key, so that a restarted run finds what an earlier one had made."""
    return f"{stage}/{shape_id}-{key}"


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

    def add(self, stage: str, made: Mapping[str, np.ndarray]) -> None:
        self._made[stage] = made


class _StageWorker:
    """Runs stages on one shape at a time. What a stage opens (renderer, model) lives as long as the actor."""

    def __init__(self, array_url: str, stages: Sequence[Stage]) -> None:
        self._arrays = open_array_store(array_url)
        self._stages = {stage.name: stage for stage in stages}
        self._opened: dict[str, Callable[[ShapeInputs], StageResult]] = {}

    def run(self, task: ShapeTask) -> ShapeOutcome:
        inputs = _TaskInputs(self._arrays, task)
        results: list[StagedResult] = []
        for stage, key in task.stage_keys:
            started = time.perf_counter()
            try:
                results.append(self._run_stage(stage, key, task, inputs, started))
            except PartwiseError as error:
                failure = StageFailure(stage, key, str(error), time.perf_counter() - started)
                return ShapeOutcome(task.shape_id, tuple(results), failure)
            except Exception as error:  # noqa: BLE001 - the task's edge: one bad mesh never costs the run
                reason = f"{type(error).__name__}: {error}".splitlines()[0]
                failure = StageFailure(stage, key, reason, time.perf_counter() - started, traceback.format_exc())
                return ShapeOutcome(task.shape_id, tuple(results), failure)
        return ShapeOutcome(task.shape_id, tuple(results))

    def _run_stage(self, stage: str, key: str, task: ShapeTask, inputs: _TaskInputs, started: float) -> StagedResult:
        name = staged_name(stage, task.shape_id, key)
        try:
            made = self._arrays.read_staged(name)
        except NotFoundError:
            if stage not in self._opened:
                self._opened[stage] = self._stages[stage].open(self._arrays)
            result = self._opened[stage](inputs)
            note = json.dumps({"summary": result.summary, "seconds": time.perf_counter() - started})
            made = {**result.arrays, ACCOUNT: np.frombuffer(note.encode(), dtype=np.uint8)}
            self._arrays.stage(name, made)
        inputs.add(stage, made)
        account = json.loads(made[ACCOUNT].tobytes())
        return StagedResult(stage, key, name, account["seconds"], account["summary"])


class _Packer:
    """The one writer of blocks of a run."""

    def __init__(self, array_url: str) -> None:
        self._arrays = open_array_store(array_url)

    def pack(self, kind: BlockKind, staged: Sequence[str]) -> BlockAddress:
        """Writes one block of the staged results, in order. It stays invisible until the catalog names it."""
        shapes = [{q: a for q, a in self._arrays.read_staged(name).items() if q != ACCOUNT} for name in staged]
        return self._arrays.write_block(kind, shapes)


StageWorker = ray.remote(_StageWorker)
Packer = ray.remote(_Packer)
