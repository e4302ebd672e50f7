"""Part probabilities of faces, averaged over the snapshots of a model."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
import torch
from jaxtyping import Float32

from partwise.learning.batches import GridLoader
from partwise.learning.dataset import CodedGrids
from partwise.learning.model import Snapshot, TrainedModel
from partwise.learning.network import PartNetwork

FACES_PER_BATCH = 1024


@dataclass(frozen=True, slots=True, eq=False)
class Prediction:
    """probabilities : (m, n_parts) float32, rows sum to 1; columns are in the order of the model's `part_ids`."""

    probabilities: Float32[np.ndarray, "m k"]

    @property
    def classes(self) -> np.ndarray:
        """(m,) int64, the most probable class of each face."""
        return self.probabilities.argmax(axis=1)


def predict(model: TrainedModel, grids: Mapping[str, CodedGrids], device: str | None = None) -> Prediction:
    """Probabilities of m faces, the mean over the model's snapshots.

    Parameters
    ----------
    model : a trained ensemble.
    grids : branch name to the histograms of the m faces, as in training.
    device : "cpu" or "cuda"; None takes CUDA when there is one.

    Raises
    ------
    ParameterError : a branch is missing.

    Source: Huang et al. 2017, George et al. 2018.
    """
    total: np.ndarray | None = None
    for probabilities in _each_snapshot(model, grids, device):
        total = probabilities if total is None else total + probabilities
    assert total is not None  # noqa: S101 # a model has at least one snapshot
    return Prediction(total / np.float32(len(model.snapshots)))


def snapshot_probabilities(
    model: TrainedModel, grids: Mapping[str, CodedGrids], device: str | None = None
) -> Float32[np.ndarray, "s m k"]:
    """Probabilities of each snapshot by itself, (n_snapshots, m, n_parts), for measures of their disagreement.

    Parameters and errors are those of `predict`.
    """
    return np.stack(list(_each_snapshot(model, grids, device)))


def _each_snapshot(
    model: TrainedModel, grids: Mapping[str, CodedGrids], device: str | None
) -> Iterator[Float32[np.ndarray, "m k"]]:
    where = torch.device(device or ("cuda" if torch.cuda.is_available() else "cpu"))
    loader = GridLoader.of(grids, {branch: model.input_gains[branch] for branch in model.spec.branches}, where)
    n_faces = len(loader.codes[0])
    for snapshot in model.snapshots:
        network = _network(model, snapshot).to(where)
        with torch.inference_mode():
            batches = torch.split(torch.arange(n_faces), FACES_PER_BATCH) if n_faces else ()
            parts = [torch.softmax(network(loader.load(rows)), dim=1).cpu() for rows in batches]
        yield torch.cat(parts).numpy() if parts else np.empty((0, model.spec.n_parts), dtype=np.float32)


def _network(model: TrainedModel, snapshot: Snapshot) -> PartNetwork:
    network = PartNetwork(model.spec, generator=None)
    network.load_state_dict({name: torch.from_numpy(np.array(array)) for name, array in snapshot.items()})
    return network.eval()
