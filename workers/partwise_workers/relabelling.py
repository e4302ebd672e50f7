"""Moves labels of shapes that have another mesh now: Ray tasks find whose label each face takes, the driver commits.

A run that was killed leaves nothing half-done: the next one finds the moves that are still missing.
"""

import time
from dataclasses import dataclass
from typing import Any

import numpy as np
import ray
from jaxtyping import UInt16
from ray.exceptions import RayError, RayTaskError

from partwise.errors import PartwiseError, StoreError
from partwise.remesh.moved_labels import MovedLabels
from partwise.store.open_arrays import open_array_store
from partwise.store.records import Collection, Mesh
from partwise.workspace.progress import OnRunProgress, RunProgress
from partwise.workspace.relabel import (
    MoveReport,
    PendingMove,
    commit_move,
    compute_move,
    forget_failed_moves,
    move_here,
    pending_moves,
    record_failed_move,
    require_store,
    waits_for_review,
)
from partwise.workspace.workspace import Workspace
from partwise_workers.cluster import connected, n_cores, thread_environment
from partwise_workers.pool import first_line, raise_own

FEW = 8
"""So many moves are made in this process: starting Ray would take longer."""

MAX_RETRIES = 1
"""Of a move whose process died."""

POLL_S = 1.0
"""How often deadlines are looked at while no move ends."""


@dataclass(frozen=True, slots=True)
class _InFlight:
    move: PendingMove
    since: float


def move_labels(workspace: Workspace, collection: Collection, on_progress: OnRunProgress) -> MoveReport:
    """Moves the newest labels of every shape to its present working mesh; where all are there, nothing happens.

    A shape whose labels cannot be moved is named among the failures and tried again next time.

    Raises
    ------
    StoreError : a store is full or cannot be reached; what is committed stays.
    WorkerError : Ray cannot be started.
    """
    n_total = sum(1 for _ in pending_moves(workspace, collection))
    if n_total <= FEW:
        return move_here(workspace, collection, on_progress)
    forget_failed_moves(workspace, collection)
    with connected():
        return _Mover(workspace, on_progress, n_total).run(collection)


class _Mover:
    """Keeps one task a core in flight and commits what they return.

    A move has the time that remeshing has: it searches the same meshes. Its clock runs from when it is handed out.
    """

    def __init__(self, workspace: Workspace, on_progress: OnRunProgress, n_total: int) -> None:
        self._workspace = workspace
        self._on_progress = on_progress
        self._n_total = n_total
        self._in_flight: dict[ray.ObjectRef[MovedLabels], _InFlight] = {}
        self._deadline_s = workspace.config.workers.limits.remesh.deadline_s
        self._n_moved = self._n_in_review = self._n_failed = 0

    def run(self, collection: Collection) -> MoveReport:
        n_slots = n_cores()
        try:
            for move in pending_moves(self._workspace, collection):
                self._submit(move)
                while len(self._in_flight) >= n_slots:
                    self._wait()
            while self._in_flight:
                self._wait()
        finally:
            for pending in self._in_flight:
                ray.cancel(pending, force=True)
        return MoveReport(self._n_moved, self._n_in_review, self._n_failed)

    def _submit(self, move: PendingMove) -> None:
        try:
            labels = self._workspace.catalog.labels(move.source.id)
        except PartwiseError as error:
            self._blame(move, error)
            return
        task: Any = _compute
        reference = task.remote(self._workspace.array_url, move.old_mesh, move.new_mesh, labels)
        self._in_flight[reference] = _InFlight(move, time.monotonic())

    def _wait(self) -> None:
        ready, _ = ray.wait(list(self._in_flight), num_returns=1, timeout=POLL_S)
        for reference in ready:
            self._finish(reference)
        now = time.monotonic()
        for reference in [each for each, flight in self._in_flight.items() if now - flight.since > self._deadline_s]:
            ray.cancel(reference, force=True)
            self._fail(
                self._in_flight.pop(reference).move,
                f"its labels took longer to move than deadline_s = {self._deadline_s:g}; raise deadline_s under "
                "[workers.limits.remesh], or simplify its file",
            )

    def _finish(self, done: "ray.ObjectRef[MovedLabels]") -> None:
        move = self._in_flight.pop(done).move
        try:
            moved = _result(done)
        except (PartwiseError, RayError) as error:
            self._blame(move, error)
            return
        committed = commit_move(self._workspace, move, moved)
        if committed is not None:
            self._n_moved += 1
            self._n_in_review += waits_for_review(committed)
        self._tell()

    def _blame(self, move: PendingMove, error: Exception) -> None:
        """The shape fails for it, unless it is the store that does, which raises StoreError."""
        if isinstance(error, StoreError):
            require_store(self._workspace.arrays)
        has_died = isinstance(error, RayError) and not isinstance(error, RayTaskError)
        remedy = "; free some memory or simplify its file, then preprocess again" if has_died else ""
        self._fail(move, f"{first_line(error)}{remedy}")

    def _fail(self, move: PendingMove, reason: str) -> None:
        record_failed_move(self._workspace, move, reason)
        self._n_failed += 1
        self._tell()

    def _tell(self) -> None:
        self._on_progress(RunProgress(self._n_moved, self._n_failed, self._n_total))


def _result(done: "ray.ObjectRef[MovedLabels]") -> MovedLabels:
    try:
        result: MovedLabels = ray.get(done)
    except RayError as error:
        raise_own(error)
        raise
    return result


@ray.remote(num_cpus=1, max_retries=MAX_RETRIES, runtime_env={"env_vars": thread_environment(1)})
def _compute(array_url: str, old_mesh: Mesh, new_mesh: Mesh, labels: UInt16[np.ndarray, " n"]) -> MovedLabels:
    return compute_move(open_array_store(array_url), old_mesh, new_mesh, labels)
