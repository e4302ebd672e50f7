"""Writes simulated collections in the layout of the labelled Princeton benchmark: `<id>.off`, `<id>_labels.txt`."""

import os
import signal
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from multiprocessing import get_context
from pathlib import Path

from partwise.exchange.labels_psb import write_psb_labels
from partwise.exchange.named_labels import NamedLabels
from partwise.io.write import write_mesh
from partwise.simulate.collection import CATEGORIES, shape_seed, simulate_collection, simulate_shape
from partwise_cli.terminal import Advance


@dataclass(frozen=True, slots=True)
class SimulationRequest:
    """What `partwise simulate` was asked for. dirty_every : where not all are dirty, one in so many is; 0 for none.

    Raises
    ------
    ParameterError : an unknown category, or a count, seed or number of faces out of range.
    """

    category: str
    n_shapes: int
    seed: int
    dirty: bool = False
    n_faces: int | None = None
    dirty_every: int = 0

    def __post_init__(self) -> None:
        # Checks its arguments at once and makes nothing until it is iterated.
        simulate_collection(self.category, self.n_shapes, self.seed, dirty=self.dirty, n_faces=self.n_faces)

    def is_dirty(self, index: int) -> bool:
        """Whether the shape of this index is a soup."""
        return self.dirty or (self.dirty_every > 0 and (index + 1) % self.dirty_every == 0)

    @property
    def part_names(self) -> tuple[str, ...]:
        return CATEGORIES[self.category].part_names


def write_collection(request: SimulationRequest, out: Path, on_progress: Advance) -> None:
    """Writes the shapes, on all cores. Same request, same bytes, whatever the number of cores."""
    # spawn: a forked child would inherit the threads' locks of the numerical libraries.
    n_processes = min(os.cpu_count() or 1, request.n_shapes)
    with ProcessPoolExecutor(n_processes, get_context("spawn"), _leave_interrupts_to_the_parent) as pool:
        done = pool.map(partial(_write_shape, request, out), range(request.n_shapes))
        try:
            for n_done, _ in enumerate(done, start=1):
                on_progress(n_done, request.n_shapes)
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise


def _leave_interrupts_to_the_parent() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def _write_shape(request: SimulationRequest, out: Path, index: int) -> None:
    seed = shape_seed(request.category, request.seed, index)
    name = f"{request.category.removesuffix('s')}-{index:04d}"
    shape = simulate_shape(request.category, seed, name, dirty=request.is_dirty(index), n_faces=request.n_faces)
    write_mesh(shape.mesh, out / f"{shape.name}.off")
    write_psb_labels(out / f"{shape.name}_labels.txt", NamedLabels(shape.part_names, shape.labels))
