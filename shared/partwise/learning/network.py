"""The paper's network: one small convolutional branch per feature, joined by two fully connected layers."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import torch
from jaxtyping import Float
from torch import Tensor, nn
from torch.nn import functional

from partwise.errors import ParameterError
from partwise.learning.dataset import GRID_SIZE
from partwise.learning.stem import convolve_and_pool

LEAKY_SLOPE = 0.2
KERNEL_SIZE = 3
N_POOLINGS = 2


@dataclass(frozen=True, slots=True)
class NetworkSpec:
    """The network's shape.

    n_parts : number of classes, at least 2.
    widths : channels after the first and the second convolution of a branch.
    hidden : width of the fully connected layer.
    branches : features, in the order in which their outputs are concatenated.

    Raises
    ------
    ParameterError : too few parts, a width below 1, or no or repeated branches.

    Source: George et al. 2018, which gives no widths; 16, 32 and 128 are ours.
    """

    n_parts: int
    widths: tuple[int, int] = (16, 32)
    hidden: int = 128
    branches: tuple[str, ...] = ("shape_context", "spin_image")

    def __post_init__(self) -> None:
        if self.n_parts < 2:
            raise ParameterError(f"n_parts must be at least 2 but is {self.n_parts}; add parts to the schema")
        if len(self.widths) != N_POOLINGS or min(*self.widths, self.hidden) < 1:
            raise ParameterError(
                f"widths must be {N_POOLINGS} numbers and hidden one, all at least 1, but they are {self.widths} and "
                f"{self.hidden}; the defaults are (16, 32) and 128"
            )
        if not self.branches or len(set(self.branches)) != len(self.branches):
            raise ParameterError(f"branches must be named and differ but are {self.branches}; name each feature once")

    @property
    def n_branch_outputs(self) -> int:
        """Values per face that one branch hands to the fully connected layers."""
        return self.widths[-1] * (GRID_SIZE // 2**N_POOLINGS) ** 2


class Branch(nn.Module):
    """Twice: 3×3 convolution, 2×2 max-pool, LeakyReLU."""

    def __init__(self, widths: tuple[int, int]) -> None:
        super().__init__()
        options = {"kernel_size": KERNEL_SIZE, "padding": KERNEL_SIZE // 2}
        self.first: nn.Conv2d = _uninitialised(nn.Conv2d, 1, widths[0], **options)
        self.second: nn.Conv2d = _uninitialised(nn.Conv2d, *widths, **options)

    # b faces, c1 and c2 channels
    #   (b, 256) -> (b, 16, 16) -> (b, 8, 8, c1) -> (b, 8, 8, c2) -> (b, 4, 4, c2) -> (b, 16 c2)
    # Maps are channels-last in memory, which the convolution wants; torch counts their axes as (b, c, h, w).
    # Both the bias and LeakyReLU may come after the pooling, on a quarter of the values: a rising function of the
    # maximum is the maximum of the function.
    def forward(self, grids: Float[Tensor, "b 256"]) -> Float[Tensor, "b n_branch_outputs"]:
        grids = grids.view(-1, GRID_SIZE, GRID_SIZE)
        pooled = convolve_and_pool(grids, self.first.weight) + self.first.bias  # type: ignore[operator] # it has one
        maps = functional.leaky_relu(pooled, LEAKY_SLOPE).permute(0, 3, 1, 2)
        maps = functional.leaky_relu(functional.max_pool2d(self.second(maps), 2), LEAKY_SLOPE)
        return maps.permute(0, 2, 3, 1).flatten(1)


class PartNetwork(nn.Module):
    """Part logits of faces from their histograms.

    Parameters
    ----------
    spec : the network's shape.
    generator : draws the initial weights; torch's global generator is not touched. None leaves them uninitialised,
        to be loaded.

    Source: George et al. 2018. Differs: max-pool before the activation and the first bias, the same function.
    """

    def __init__(self, spec: NetworkSpec, generator: torch.Generator | None) -> None:
        super().__init__()
        self.spec = spec
        self.branches = nn.ModuleDict({name: Branch(spec.widths) for name in spec.branches})
        self.hidden = _uninitialised(nn.Linear, len(spec.branches) * spec.n_branch_outputs, spec.hidden)
        self.output = _uninitialised(nn.Linear, spec.hidden, spec.n_parts)
        if generator is not None:
            _initialise(self, generator)

    # b faces, f branches, k parts
    #   f × (b, 256) -> f × (b, 512) -> (b, 512 f) -> (b, 128) -> (b, k)
    def forward(self, grids: Sequence[Float[Tensor, "b 256"]]) -> Float[Tensor, "b k"]:
        """Logits; `grids` are in the order of `spec.branches`."""
        described = torch.cat([branch(g) for branch, g in zip(self.branches.values(), grids, strict=True)], dim=1)
        logits: Tensor = self.output(functional.leaky_relu(self.hidden(described), LEAKY_SLOPE))
        return logits


def _uninitialised(layer: type[nn.Module], *arguments: int, **options: int) -> Any:
    """A layer whose constructor draws nothing from torch's global generator."""
    return nn.utils.skip_init(layer, *arguments, **options)  # type: ignore[no-untyped-call] # torch leaves it untyped


def _initialise(network: PartNetwork, generator: torch.Generator) -> None:
    """He's uniform weights for LeakyReLU, Glorot's for the logits, no bias."""
    for module in network.modules():
        if not isinstance(module, nn.Conv2d | nn.Linear):
            continue
        if module is network.output:
            nn.init.xavier_uniform_(module.weight, generator=generator)
        else:
            nn.init.kaiming_uniform_(module.weight, a=LEAKY_SLOPE, nonlinearity="leaky_relu", generator=generator)
        if module.bias is not None:
            nn.init.zeros_(module.bias)
