"""`Publisher`: gathers staged results into blocks, has a packer write each, and commits it to the catalog.

A result is let go from staging only after the commit, so that whatever ends the run before is found by the next one.
The packer does that too, between two blocks: it takes longer than the commit, and nothing waits for it. What it does
not get to, the sweep at the end of this run or the next one does.
"""

import logging
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import ray
from ray.exceptions import RayError

from partwise.errors import WorkerError
from partwise.store.catalog import StageCatalog
from partwise.store.records import NewBlock, NewMesh, NewScore, NewStageRun
from partwise_workers.actors import Packed
from partwise_workers.cluster import require_living_node
from partwise_workers.pool import Actor, Reference, first_line, raise_own
from partwise_workers.stage import Stage
from partwise_workers.tasks import StagedResult

logger = logging.getLogger(__name__)

MAX_PACKING = 2
"""Blocks of each stage that may be written or wait to be; more, and actors pause, so that staging stays small."""

MAX_PACK_ATTEMPTS = 3

BLOCK_BYTES = 512 * 1024 * 1024
"""A block is written as soon as its arrays reach this size, to bound the packer's memory."""


@dataclass(frozen=True, slots=True)
class Published:
    """What else a stage's result puts on record beside its run: meshes it made, scores it gave."""

    meshes: tuple[NewMesh, ...] = ()
    scores: tuple[NewScore, ...] = ()


AlsoPublish = Callable[[int, StagedResult, int], Published]
"""(shape id, result, row in its block) → what else to publish with it."""


def nothing_else(shape_id: int, result: StagedResult, row: int) -> Published:  # noqa: ARG001 - the signature of AlsoPublish
    """For stages whose results are arrays only."""
    return Published()


@dataclass(frozen=True, slots=True)
class _Ready:
    """A result that waits for its block."""

    shape_id: int
    result: StagedResult
    attempts: int


@dataclass(slots=True)
class _Gathered:
    ready: list[_Ready] = field(default_factory=list)
    n_bytes: int = 0


@dataclass(frozen=True, slots=True)
class _Packing:
    stage: str
    ready: tuple[_Ready, ...]
    packer: Actor
    attempt: int


class Publisher:
    """Needs a connected Ray. `new_packer` makes an actor whose `pack` is a packer's.

    Blocks are published in the order in which they were gathered, and a shape's earlier stages before its later ones:
    at no moment is a result on record whose input is not.

    Parameters
    ----------
    stages : in order, each reading the one before.
    block_shapes : results that make a block.
    """

    def __init__(
        self,
        catalog: StageCatalog,
        new_packer: Callable[[], Actor],
        stages: Sequence[Stage],
        block_shapes: int,
        also_publish: AlsoPublish = nothing_else,
    ) -> None:
        self._catalog = catalog
        self._new_packer = new_packer
        self._kinds = {stage.name: stage.block_kind for stage in stages}
        self._block_shapes = block_shapes
        self._also_publish = also_publish
        self._gathered = {stage.name: _Gathered() for stage in stages}
        self._packing: dict[Reference, _Packing] = {}
        self._arrived: set[Reference] = set()
        self._clearing: set[Reference] = set()
        self._packer: Actor | None = None
        self._is_in_order = True

    @property
    def has_room(self) -> bool:
        """Whether packing and clearing keep up with what comes in."""
        return max(len(self._packing), len(self._clearing)) < MAX_PACKING * len(self._kinds)

    def add(self, shape_id: int, result: StagedResult, attempts: int) -> None:
        """Takes a result; when there are enough for a block, has it packed."""
        gathered = self._gathered[result.stage]
        gathered.ready.append(_Ready(shape_id, result, attempts))
        gathered.n_bytes += result.n_bytes
        if len(gathered.ready) >= self._block_shapes or gathered.n_bytes >= BLOCK_BYTES:
            self._pack_gathered(up_to=result.stage)

    def references(self) -> list[Reference]:
        """What to wait for: blocks that are being packed, and staged results that are being let go."""
        return [*(reference for reference in self._packing if reference not in self._arrived), *self._clearing]

    def collect(self, ready: Sequence[Reference]) -> None:
        """Publishes the blocks that are ready among `references`, and forgets what was cleared.

        Raises
        ------
        StoreError : a store refuses. What is staged stays there for the next run.
        WorkerError : the packer keeps dying, or Ray has no node left.
        """
        self._arrived.update(reference for reference in ready if reference in self._packing)
        while self._packing and (first := next(iter(self._packing))) in self._arrived:
            self._arrived.remove(first)
            self._take(first)
        for reference in self._clearing.intersection(ready):
            self._clearing.remove(reference)
            _note_cleared(reference)

    def flush(self) -> None:
        """Packs and publishes all that was added, and has it let go from staging.

        Nothing, if an interrupt fell into publishing: what comes after must not be on record without what came before.
        """
        if not self._is_in_order:
            return
        self._pack_gathered()
        while self._packing or self._clearing:
            self.collect(ray.wait(self.references(), num_returns=1)[0])

    def close(self) -> None:
        """Ends the packer; a block it has not finished stays invisible."""
        if self._packer is not None:
            ray.kill(self._packer)
            self._packer = None

    def _pack_gathered(self, up_to: str | None = None) -> None:
        """Packs what was gathered of each stage, up to one if given."""
        for stage in self._gathered:
            ready, self._gathered[stage] = tuple(self._gathered[stage].ready), _Gathered()
            if ready:
                self._pack(stage, ready)
            if stage == up_to:
                return

    def _pack(self, stage: str, ready: tuple[_Ready, ...], attempt: int = 1) -> None:
        packer = self._living_packer()
        seconds = {each.result.staged_as: each.result.seconds for each in ready}
        reference = packer.pack.remote(self._kinds[stage], seconds)
        self._packing[reference] = _Packing(stage, ready, packer, attempt)

    def _living_packer(self) -> Actor:
        if self._packer is None:
            self._packer = self._new_packer()
        return self._packer

    def _take(self, reference: Reference) -> None:
        packing = self._packing.pop(reference)
        self._is_in_order = False
        try:
            packed: Packed = ray.get(reference)
        except RayError as error:
            raise_own(error)
            self._pack_again(packing, error)
        else:
            self._publish(packing, packed)
        self._is_in_order = True

    def _pack_again(self, packing: _Packing, error: RayError) -> None:
        logger.warning("the packer died", extra={"stage": packing.stage, "why": first_line(error)})
        if packing.attempt >= MAX_PACK_ATTEMPTS:
            raise WorkerError(
                f"a block of {len(packing.ready):,} shapes must be written but its packer died {packing.attempt} "
                f"times: {first_line(error)}; results are kept: free some memory or lower [workers] block_shapes, "
                "run again"
            ) from error
        require_living_node()
        if self._packer is packing.packer:
            self.close()
        self._pack(packing.stage, packing.ready, packing.attempt + 1)

    def _publish(self, packing: _Packing, packed: Packed) -> None:
        by_name = {each.result.staged_as: each for each in packing.ready}
        self._account_for(packing.stage, [by_name[name] for name in by_name.keys() - set(packed.names)])
        if packed.address is None:
            return
        rows = [by_name[name] for name in packed.names]
        extras = [self._also_publish(each.shape_id, each.result, row) for row, each in enumerate(rows)]
        address, kind = packed.address, self._kinds[packing.stage]
        self._catalog.publish_block(
            NewBlock(address.name, kind.name, address.n_shapes, address.n_bytes, address.checksum),
            [_run(packing.stage, each, row) for row, each in enumerate(rows)],
            scores=[score for extra in extras for score in extra.scores],
            meshes=[mesh for extra in extras for mesh in extra.meshes],
        )
        # If the commit failed, its block is not deleted here: the answer may have been lost after the commit. `gc`
        # knows which blocks are on record.
        self._clearing.add(self._living_packer().clear.remote(packed.names))

    def _account_for(self, stage: str, gone: Sequence[_Ready]) -> None:
        """Results that left staging, or were replaced there, before they were packed: by another run as a rule."""
        runs = self._catalog.stage_runs([each.shape_id for each in gone], stage) if gone else {}
        lost = [each.shape_id for each in gone if _key(runs.get(each.shape_id)) != each.result.key]
        if lost:
            logger.warning("staged results are gone or replaced; run again", extra={"stage": stage, "shapes": lost})


def _note_cleared(reference: Reference) -> None:
    """A store that refuses ends the run; a packer that died leaves what it had not cleared to the sweep."""
    try:
        ray.get(reference)
    except RayError as error:
        raise_own(error)
        logger.warning("published results stay staged until the sweep", extra={"why": first_line(error)})


def _run(stage: str, ready: _Ready, row: int) -> NewStageRun:
    result = ready.result
    return NewStageRun(ready.shape_id, stage, result.key, row, ready.attempts, result.seconds, result.summary)


def _key(run: Any) -> str | None:
    return None if run is None else run.key
