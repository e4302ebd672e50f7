"""Trains the network on a pool of faces: RMSProp, cyclic cosine rate, a snapshot at the end of each cycle.

On a CPU a batch is cut into shards. Their gradients are computed by single-threaded operations, on threads of our own,
and added in a fixed order: four fifths of the CPU time of torch's threads inside operations, and the weights do not
depend on how many threads there are.
"""

import math
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import contextmanager

import numpy as np
import torch
from torch import Tensor
from torch.nn import functional

from partwise.errors import LabelError, ParameterError
from partwise.learning.batches import GridLoader, fit_input_gains
from partwise.learning.dataset import FacePool, batch_rows
from partwise.learning.model import Snapshot, TrainedModel
from partwise.learning.network import NetworkSpec, PartNetwork
from partwise.learning.recipe import Recipe
from partwise.learning.schedule import learning_rate_at, snapshot_iterations

N_CPU_SHARDS = 2
REPORT_EVERY = 50


def train(
    pool: FacePool,
    spec: NetworkSpec,
    recipe: Recipe,
    progress: Callable[[int, float], None] | None = None,
    *,
    n_threads: int | None = None,
    device: str | None = None,
) -> TrainedModel:
    """A model of the pool's parts.

    The same pool, spec and recipe give bit-identical weights on one machine, whatever the number of threads.

    Parameters
    ----------
    pool : labelled faces; classes of `spec.n_parts` parts.
    progress : called with (iterations done, mean loss since the last call) every 50 iterations and at the end.
    n_threads : CPU threads, at most 2 are used; None takes torch's current number.
    device : "cpu" or "cuda"; None takes CUDA when there is one.

    Raises
    ------
    LabelError : the pool has another number of parts than the spec.
    ParameterError : the pool lacks a branch, or the loss stops being finite.

    Source: George et al. 2018. Differs: each feature is scaled to unit root mean square by one factor, fixed by the
    training faces and kept in the model, because the paper does not say how its inputs are scaled.
    """
    if len(pool.part_ids) != spec.n_parts:
        raise LabelError(
            f"the network has {spec.n_parts} classes but the pool {len(pool.part_ids)} parts; build the spec from them"
        )
    where = torch.device(device or ("cuda" if torch.cuda.is_available() else "cpu"))
    n_threads = n_threads or torch.get_num_threads()
    gains = fit_input_gains(pool.grids, spec.branches)
    loader = GridLoader.of(pool.grids, gains, where)
    weight_seed, order_seed = np.random.SeedSequence(recipe.seed).spawn(2)
    with _deterministic(where), _single_threaded_operations(where), _executor(n_threads, where) as threads:
        network = PartNetwork(spec, torch.Generator().manual_seed(int(weight_seed.generate_state(1)[0]))).to(where)
        step = _GradientStep(network, loader, torch.from_numpy(pool.classes), threads)
        snapshots, history = _run(step, recipe, np.random.default_rng(order_seed), len(pool), progress)
    return TrainedModel(spec, recipe, pool.part_ids, gains, snapshots, history)


def _run(
    step: "_GradientStep",
    recipe: Recipe,
    rng: np.random.Generator,
    n_faces: int,
    progress: Callable[[int, float], None] | None,
) -> tuple[tuple[Snapshot, ...], tuple[tuple[int, float], ...]]:
    keep_at = snapshot_iterations(recipe.n_iterations, recipe.n_snapshots)
    optimiser = torch.optim.RMSprop([step.weights], lr=recipe.learning_rate, alpha=recipe.smoothing)
    batches = batch_rows(n_faces, recipe.batch_size, rng)
    snapshots: list[Snapshot] = []
    history: list[tuple[int, float]] = []
    losses: list[Tensor] = []
    for t in range(1, recipe.n_iterations + 1):
        rate = learning_rate_at(t, recipe.n_iterations, recipe.n_snapshots, recipe.learning_rate)
        optimiser.param_groups[0]["lr"] = rate
        losses.append(step.descend(next(batches), optimiser))
        if t in keep_at:
            snapshots.append(step.snapshot())
        if t % REPORT_EVERY == 0 or t == recipe.n_iterations:
            history.append((t, _finite_mean(losses, t, rate)))
            losses.clear()
            if progress is not None:
                progress(*history[-1])
    return tuple(snapshots), tuple(history)


class _GradientStep:
    """A network whose parameters are views of one flat vector: adding gradients and updating are single operations."""

    def __init__(self, network: PartNetwork, loader: GridLoader, classes: Tensor, threads: Executor) -> None:
        self._network = network
        self._loader = loader
        self._classes = classes
        self._threads = threads
        self._parameters = list(network.parameters())
        self.weights = torch.cat([p.detach().flatten() for p in self._parameters])
        offset = 0
        for parameter in self._parameters:
            parameter.data = self.weights[offset : offset + parameter.numel()].view(parameter.shape)
            offset += parameter.numel()

    def descend(self, rows: np.ndarray, optimiser: torch.optim.Optimizer) -> Tensor:
        """One optimiser step on a batch. Returns its mean loss, a scalar on the network's device."""
        n_shards = N_CPU_SHARDS if self.weights.device.type == "cpu" else 1
        shards = [shard for shard in np.array_split(rows, n_shards) if len(shard)]
        results = list(self._threads.map(self._shard, shards))
        loss = results[0][0]
        gradient = results[0][1]
        for other_loss, other_gradient in results[1:]:
            loss = loss + other_loss
            gradient.add_(other_gradient)
        self.weights.grad = gradient.div_(len(rows))
        optimiser.step()
        return loss / len(rows)

    def snapshot(self) -> Snapshot:
        return {name: p.detach().cpu().numpy().copy() for name, p in self._network.named_parameters()}

    def _shard(self, rows: np.ndarray) -> tuple[Tensor, Tensor]:
        """Summed loss of a shard and its gradient as one flat vector."""
        chosen = torch.from_numpy(rows)
        logits = self._network(self._loader.load(chosen))
        loss = functional.cross_entropy(logits, self._classes[chosen].to(logits.device), reduction="sum")
        gradients = torch.autograd.grad(loss, self._parameters)
        return loss.detach(), torch.cat([g.flatten() for g in gradients])


def _finite_mean(losses: list[Tensor], iteration: int, rate: float) -> float:
    mean = float(torch.stack(losses).mean())
    if not math.isfinite(mean):
        raise ParameterError(
            f"the loss must stay finite but is {mean} by iteration {iteration} at rate {rate:.4g}; "
            "lower the recipe's learning_rate"
        )
    return mean


@contextmanager
def _deterministic(device: torch.device) -> Iterator[None]:
    """Has a GPU choose operations whose results do not vary, for as long as the context lasts.

    On a CPU all operations of the network are of that kind. cuBLAS also wants CUBLAS_WORKSPACE_CONFIG=:4096:8 in the
    environment; without it torch warns, and goes on.
    """
    before = torch.are_deterministic_algorithms_enabled()
    warn_only = torch.is_deterministic_algorithms_warn_only_enabled()
    if device.type != "cpu":
        torch.use_deterministic_algorithms(True, warn_only=True)
    try:
        yield
    finally:
        torch.use_deterministic_algorithms(before, warn_only=warn_only)


def _executor(n_threads: int, device: torch.device) -> ThreadPoolExecutor:
    if device.type != "cpu":
        return ThreadPoolExecutor(1)
    # OpenMP keeps the number of threads per thread, so each of ours has to say that it wants one.
    return ThreadPoolExecutor(min(n_threads, N_CPU_SHARDS), initializer=torch.set_num_threads, initargs=(1,))


@contextmanager
def _single_threaded_operations(device: torch.device) -> Iterator[None]:
    """One thread inside each CPU operation, for as long as the context lasts; it has no say on a GPU."""
    before = torch.get_num_threads()
    if device.type == "cpu":
        torch.set_num_threads(1)
    try:
        yield
    finally:
        torch.set_num_threads(before)
