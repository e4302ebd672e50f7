"""The network's first layer: 3×3 convolution of one channel and 2×2 max-pool, in one.

On one channel the convolution is all memory and no arithmetic: its maps, four times the size of what pooling leaves,
cost more to write, gather and scatter than to compute. So the four positions that compete in a pooling window are
computed as four matrix products of one 4×4 patch and compared elementwise: 0.85 of the time of a training step.
"""

from typing import Any

import torch
from jaxtyping import Float
from torch import Tensor
from torch.nn import functional

KERNEL = 3
PATCH = 4
_OFFSETS = ((0, 0), (0, 1), (1, 0), (1, 1))
_keep_where_positive = torch.ops.aten.threshold_backward


def convolve_and_pool(
    grids: Float[Tensor, "b h w"], kernels: Float[Tensor, "c 1 3 3"]
) -> Float[Tensor, "b half_h half_w c"]:
    """`max_pool2d(conv2d(grids, kernels, padding=1), 2)`, channels-last.

    Parameters
    ----------
    grids : (b, h, w), h and w even. They receive no gradient.
    kernels : (c, 1, 3, 3).

    Returns
    -------
    (b, h/2, w/2, c), contiguous. Of equal values in a window the first in reading order receives the gradient.
    """
    pooled: Tensor = _ConvolveAndPool.apply(grids, kernels)  # type: ignore[no-untyped-call] # torch leaves it untyped
    return pooled


class _ConvolveAndPool(torch.autograd.Function):
    # b faces, (h, w) grid, c channels, p = b · h/2 · w/2 windows
    #   patches (p, 16) @ four kernels (16, c) -> four candidates (p, c) -> their maximum (p, c)
    @staticmethod
    def forward(ctx: Any, grids: Tensor, kernels: Tensor) -> Tensor:
        b, h, w = grids.shape
        patches = _patches(grids)
        top_left, top_right, low_left, low_right = (patches @ _in_patch(kernels, *offset).T for offset in _OFFSETS)
        top, low = torch.maximum(top_left, top_right), torch.maximum(low_left, low_right)
        # The signs of the differences tell which candidate won.
        ctx.save_for_backward(patches, top_right.sub_(top_left), low_right.sub_(low_left), low - top)
        return torch.maximum(top, low).view(b, h // 2, w // 2, -1)

    @staticmethod
    def backward(ctx: Any, *gradients: Tensor) -> tuple[None, Tensor]:
        patches, top_difference, low_difference, difference = ctx.saved_tensors
        top, low = _split(gradients[0].reshape(difference.shape), difference)
        winners = (*_split(top, top_difference), *_split(low, low_difference))
        n_channels = difference.shape[1]
        kernels = patches.new_zeros(n_channels, KERNEL, KERNEL)
        for winner, (row, column) in zip(winners, _OFFSETS, strict=True):
            in_patch = (winner.T @ patches).view(n_channels, PATCH, PATCH)
            kernels += in_patch[:, row : row + KERNEL, column : column + KERNEL]
        return None, kernels[:, None]


def _patches(grids: Tensor) -> Tensor:
    """The 4×4 patch, with a border of zeros, that each 2×2 pooling window sees: (b · h/2 · w/2, 16)."""
    padded = functional.pad(grids, (1, 1, 1, 1))
    return padded.unfold(1, PATCH, 2).unfold(2, PATCH, 2).reshape(-1, PATCH * PATCH)


def _in_patch(kernels: Tensor, row: int, column: int) -> Tensor:
    """The kernels placed at an offset in a 4×4 patch of zeros: (c, 16)."""
    return functional.pad(kernels[:, 0], (column, 1 - column, row, 1 - row)).flatten(1)


def _split(gradient: Tensor, difference: Tensor) -> tuple[Tensor, Tensor]:
    """The gradient where the difference is at most 0, and where it is positive; 0 elsewhere."""
    second = _keep_where_positive(gradient, difference, 0)
    return gradient - second, second
