"""Turns coded histograms into the network's input."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import torch
from jaxtyping import Float, Int64, UInt8
from torch import Tensor

from partwise.errors import ParameterError
from partwise.learning.dataset import CodedGrids

INPUT_RMS = 1.0
_GAIN_SAMPLE = 20_000


def fit_input_gains(grids: Mapping[str, CodedGrids], branches: tuple[str, ...]) -> dict[str, float]:
    """The factor per branch that brings the root mean square of sqrt(h) over all bins and faces to `INPUT_RMS`.

    Taken over at most 20,000 evenly spaced faces. A branch that is 0 everywhere gets 1.

    Raises
    ------
    ParameterError : a branch is missing.
    """
    return {branch: _gain(grids_of(grids, branch)) for branch in branches}


def grids_of(grids: Mapping[str, CodedGrids], branch: str) -> CodedGrids:
    """The histograms of one branch.

    Raises
    ------
    ParameterError : they are missing.
    """
    if branch not in grids:
        raise ParameterError(
            f"the network needs {branch} but got {', '.join(sorted(grids)) or 'nothing'}; describe the shapes again"
        )
    return grids[branch]


@dataclass(frozen=True, slots=True, eq=False)
class GridLoader:
    """Coded histograms of n faces as torch sees them, without copying the codes.

    codes : per branch (n, 256) uint8.
    factors : per branch (n,) float32, scale times input gain.
    device : where batches go.
    """

    codes: tuple[UInt8[Tensor, "n 256"], ...]
    factors: tuple[Float[Tensor, " n"], ...]
    device: torch.device

    @classmethod
    def of(cls, grids: Mapping[str, CodedGrids], gains: Mapping[str, float], device: torch.device) -> "GridLoader":
        """The loader for the branches of `gains`, in their order."""
        chosen = [grids_of(grids, branch) for branch in gains]
        codes = tuple(_as_tensor(g.codes) for g in chosen)
        factors = tuple(
            torch.from_numpy(g.scale * np.float32(gain)) for g, gain in zip(chosen, gains.values(), strict=True)
        )
        return cls(codes, factors, device)

    def load(self, rows: Int64[Tensor, " b"]) -> list[Float[Tensor, "b 256"]]:
        """The network's input for the given faces."""
        return [
            codes[rows].to(self.device).to(torch.float32).mul_(factors[rows].to(self.device)[:, None])
            for codes, factors in zip(self.codes, self.factors, strict=True)
        ]


def _as_tensor(codes: np.ndarray) -> Tensor:
    # torch has no read-only tensors and warns about read-only memory; nothing here writes to it, but a copy is cheap.
    return torch.from_numpy(np.ascontiguousarray(codes) if codes.flags.writeable else codes.copy())


def _gain(grids: CodedGrids) -> float:
    rows = np.unique(np.linspace(0, len(grids) - 1, min(len(grids), _GAIN_SAMPLE)).astype(np.int64))
    root_h = grids.codes[rows].astype(np.float32) * grids.scale[rows, None]
    rms = float(np.sqrt(np.mean(np.square(root_h, dtype=np.float64))))
    return INPUT_RMS / rms if rms > 0 else 1.0
